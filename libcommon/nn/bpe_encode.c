/* The encoder's side of nn/bpe.h: a text is cleaned, cut into words, and each word's symbols are merged. The
 * symbols are a linked list, and the merges that its neighbours allow are a heap by rank, then by place: each
 * merge takes log n steps and allows at most two new ones. A merge in the heap of which a symbol is gone by
 * its turn is skipped. */
#include "nn/bpe_private.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "nn/unicode.h"

#define NONE ((size_t)-1)

struct symbol {
	int32_t id; /* -1: merged into the one before */
	size_t before, next;
};

struct candidate {
	const struct bpe_merge *merge;
	size_t at; /* of its left symbol */
};

/* The word at work; its memory is used again for the next. */
struct word {
	struct symbol *symbols;
	struct candidate *heap;
	size_t symbol_capacity, heap_capacity, candidates;
};

static int comes_before(const struct candidate *a, const struct candidate *b)
{
	return a->merge->rank < b->merge->rank || (a->merge->rank == b->merge->rank && a->at < b->at);
}

static void swap(struct candidate *a, struct candidate *b)
{
	const struct candidate c = *a;

	*a = *b;
	*b = c;
}

/* There is room: a word of n symbols has at most n-1 pairs, and n-1 merges that each make two more. */
static void heap_put(struct word *w, struct candidate c)
{
	size_t i = w->candidates++;

	w->heap[i] = c;
	for (; i && comes_before(&w->heap[i], &w->heap[(i - 1) / 2]); i = (i - 1) / 2)
		swap(&w->heap[i], &w->heap[(i - 1) / 2]);
}

static struct candidate heap_take(struct word *w)
{
	const struct candidate first = w->heap[0];
	size_t i = 0, child;

	w->heap[0] = w->heap[--w->candidates];
	while ((child = 2 * i + 1) < w->candidates) {
		if (child + 1 < w->candidates && comes_before(&w->heap[child + 1], &w->heap[child]))
			child++;
		if (!comes_before(&w->heap[child], &w->heap[i]))
			break;
		swap(&w->heap[i], &w->heap[child]);
		i = child;
	}
	return first;
}

static void consider(const struct bpe *b, struct word *w, size_t at)
{
	const size_t next = at == NONE ? NONE : w->symbols[at].next;
	const struct bpe_merge *merge =
		next == NONE ? NULL : bpe_find(b, w->symbols[at].id, w->symbols[next].id);

	if (merge)
		heap_put(w, (struct candidate){merge, at});
}

static void merge_all(const struct bpe *b, struct word *w, size_t n)
{
	w->candidates = 0;
	for (size_t i = 0; i < n; i++)
		consider(b, w, i);
	while (w->candidates) {
		const struct candidate c = heap_take(w);
		struct symbol *left = &w->symbols[c.at];
		const size_t next = left->next;
		if (left->id != c.merge->left || next == NONE || w->symbols[next].id != c.merge->right)
			continue;
		left->id = c.merge->id;
		left->next = w->symbols[next].next;
		w->symbols[next].id = -1;
		if (left->next != NONE)
			w->symbols[left->next].before = c.at;
		consider(b, w, left->before);
		consider(b, w, c.at);
	}
}

static int encode_word(const struct bpe *b, struct word *w, const char *bytes, size_t n,
	struct wordpieces *out, struct err *e)
{
	if (mem_grow((void **)&w->symbols, &w->symbol_capacity, n, sizeof *w->symbols, "word", e) ||
		mem_grow((void **)&w->heap, &w->heap_capacity, 3 * n, sizeof *w->heap, "word", e))
		return -1;
	for (size_t i = 0; i < n; i++)
		w->symbols[i] = (struct symbol){b->bytes[i + 1 == n][(unsigned char)bytes[i]],
			i ? i - 1 : NONE, i + 1 < n ? i + 1 : NONE};
	merge_all(b, w, n);
	for (size_t i = 0; i < n; i++)
		if (w->symbols[i].id >= 0 && wordpieces_push(out, w->symbols[i].id, e))
			return -1;
	return 0;
}

/* The special token written out at text, or -1. */
static int32_t special_at(const struct bpe *b, const char *text)
{
	if (!strncmp(text, BPE_START, sizeof BPE_START - 1))
		return b->start;
	return strncmp(text, BPE_END, sizeof BPE_END - 1) ? -1 : b->end;
}

enum kind { SPACE, LETTER, NUMBER, OTHER };

/* Of the character at *at, which is stepped over. */
static enum kind kind_at(const char *text, size_t len, size_t *at)
{
	const uint32_t c = utf8_next(text, len, at);

	if (unicode_is_space(c))
		return SPACE;
	return unicode_is_letter(c) ? LETTER : unicode_is_number(c) ? NUMBER : OTHER;
}

static size_t clitic_at(const char *text)
{
	static const char *const clitics[] = {"'s", "'t", "'re", "'ve", "'m", "'ll", "'d"};

	for (size_t i = 0; i < sizeof clitics / sizeof *clitics; i++)
		if (!strncmp(text, clitics[i], strlen(clitics[i])))
			return strlen(clitics[i]);
	return 0;
}

/* Where the word that begins at `at` ends: it has no special token in it. */
static size_t word_end(const struct bpe *b, const char *text, size_t len, size_t at, enum kind kind)
{
	const size_t clitic = clitic_at(text + at);

	if (clitic)
		return at + clitic;
	kind_at(text, len, &at);
	for (size_t next = at; kind != NUMBER && at < len && special_at(b, text + at) < 0; at = next)
		if (kind_at(text, len, &next) != kind)
			break;
	return at;
}

/* Composed and in lower case; *length of it. */
static char *clean(const char *text, size_t *length, struct err *e)
{
	size_t len, n = 0;
	SCOPED char *composed = unicode_compose(text, &len, e);
	/* no character's lower case takes more than twice its bytes */
	char *out = composed ? mem_alloc(2 * len + 1, 1, "text", e) : NULL;

	for (size_t at = 0; out && at < len;) {
		uint32_t lower[2];
		const size_t count = unicode_lower(utf8_next(composed, len, &at), lower);
		for (size_t i = 0; i < count; i++)
			n += utf8_put(out + n, lower[i]);
	}
	if (out)
		out[n] = 0;
	*length = n;
	return out;
}

static int encode_clean(const struct bpe *b, struct word *w, const char *text, size_t len,
	struct wordpieces *out, struct err *e)
{
	for (size_t at = 0, end; at < len; at = end) {
		const int32_t special = special_at(b, text + at);
		end = at;
		const enum kind kind = kind_at(text, len, &end);
		if (special >= 0) {
			end = at + strlen(special == b->start ? BPE_START : BPE_END);
			if (wordpieces_push(out, special, e))
				return -1;
		} else if (kind != SPACE) {
			end = word_end(b, text, len, at, kind);
			if (encode_word(b, w, text + at, end - at, out, e))
				return -1;
		}
	}
	return 0;
}

int bpe_encode(const struct bpe *b, const char *text, struct wordpieces *out, struct err *e)
{
	struct word w = {0};
	size_t len;
	SCOPED char *cleaned = clean(text, &len, e);
	const int bad = !cleaned || encode_clean(b, &w, cleaned, len, out, e);

	mem_free_all(w.symbols, w.heap);
	return bad ? -1 : 0;
}
