#include "nn/bpe.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "nn/unicode.h"

#include <stdio.h>

/* Whether the byte is its own letter. */
static int shows(unsigned byte)
{
	return (byte >= '!' && byte <= '~') || (byte >= 0xa1 && byte != 0xad);
}

void bpe_letter(size_t i, unsigned char *byte, char letter[BPE_LETTER_MAX])
{
	size_t seen = 0, shown = 0;

	for (unsigned b = 0; b < BPE_BYTES; b++)
		shown += (size_t)shows(b);
	const int is_shown = i < shown;
	unsigned b = 0;
	for (;; b++)
		if (shows(b) == is_shown && seen++ == (is_shown ? i : i - shown))
			break;
	*byte = (unsigned char)b;
	letter[utf8_put(letter, is_shown ? b : (uint32_t)(BPE_BYTES + i - shown))] = 0;
}

static int find_token(const struct bpe *b, const char *token, int32_t *id, char *missing)
{
	*id = vocab_find(&b->vocab, token, strlen(token));
	if (*id < 0)
		snprintf(missing, BPE_MISSING, "%s", token);
	return *id < 0 ? -1 : 0;
}

int bpe_finish(struct bpe *b, char missing[BPE_MISSING])
{
	char letter[BPE_LETTER_MAX], token[BPE_LETTER_MAX + sizeof BPE_LAST];
	unsigned char byte;

	vocab_sort(&b->vocab);
	for (size_t i = 0; i < BPE_BYTES; i++) {
		bpe_letter(i, &byte, letter);
		snprintf(token, sizeof token, "%s" BPE_LAST, letter);
		if (find_token(b, letter, &b->bytes[0][byte], missing) ||
			find_token(b, token, &b->bytes[1][byte], missing))
			return -1;
	}
	return -(find_token(b, BPE_START, &b->start, missing) || find_token(b, BPE_END, &b->end, missing));
}

static size_t slot_of(const struct bpe *b, int32_t left, int32_t right)
{
	uint64_t hash = ((uint64_t)left << 32 | (uint32_t)right) * 0x9e3779b97f4a7c15;
	size_t slot = (size_t)(hash >> 32) & (b->slots - 1);

	while (b->table[slot].left >= 0 && (b->table[slot].left != left || b->table[slot].right != right))
		slot = (slot + 1) & (b->slots - 1);
	return slot;
}

/* Twice the slots (at least 1024), everything in its new place. */
static int grow_table(struct bpe *b, struct err *e)
{
	const struct bpe old = *b;

	b->slots = old.slots ? old.slots * 2 : 1024;
	b->table = mem_alloc(b->slots, sizeof *b->table, "merges", e);
	if (!b->table) {
		*b = old;
		return -1;
	}
	for (size_t i = 0; i < b->slots; i++)
		b->table[i].left = -1;
	for (size_t i = 0; i < old.slots; i++)
		if (old.table[i].left >= 0)
			b->table[slot_of(b, old.table[i].left, old.table[i].right)] = old.table[i];
	free(old.table);
	return 0;
}

/* The symbol that two together are, -1 where the vocabulary has none. */
static int32_t find_joined(const struct bpe *b, const char *left, const char *right)
{
	const size_t first = strlen(left), second = strlen(right);
	struct err e;
	SCOPED char *joined = mem_alloc(first + second + 1, 1, "merges", &e);

	if (!joined)
		return -2;
	memcpy(joined, left, first);
	memcpy(joined + first, right, second + 1);
	return vocab_find(&b->vocab, joined, first + second);
}

int bpe_add_merge(struct bpe *b, const char *left, const char *right, struct err *e)
{
	const int32_t l = vocab_find(&b->vocab, left, strlen(left)),
		      r = vocab_find(&b->vocab, right, strlen(right)), id = find_joined(b, left, right);

	if (id < -1)
		return err_set(e, ERR_SYSTEM, "merges: out of memory");
	if (l < 0 || r < 0 || id < 0)
		return 2;
	if (b->n * 2 >= b->slots && grow_table(b, e))
		return -1;
	struct bpe_merge *merge = &b->table[slot_of(b, l, r)];
	if (merge->left >= 0)
		return 1;
	*merge = (struct bpe_merge){l, r, id, (uint32_t)b->n++};
	return 0;
}

const struct bpe_merge *bpe_find(const struct bpe *b, int32_t left, int32_t right)
{
	const struct bpe_merge *merge = b->slots ? &b->table[slot_of(b, left, right)] : NULL;

	return merge && merge->left >= 0 ? merge : NULL;
}

void bpe_free(struct bpe *b)
{
	vocab_free(&b->vocab);
	free(b->table);
	*b = (struct bpe){0};
}

static int ends_word(const struct bpe *b, int32_t id)
{
	const char *token = vocab_token(&b->vocab, id);
	const size_t len = strlen(token), last = sizeof BPE_LAST - 1;

	return id == b->start || id == b->end || (len > last && !strcmp(token + len - last, BPE_LAST));
}

/* The byte of a letter, -1 where it is none. */
static int byte_of(uint32_t letter)
{
	if (letter < BPE_BYTES)
		return shows(letter) ? (int)letter : -1;
	uint32_t hidden = letter - BPE_BYTES;
	for (int b = 0; b < BPE_BYTES; b++)
		if (!shows((unsigned)b) && !hidden--)
			return b;
	return -1;
}

/* Bytes for the letters of a token; 0 where these are not whole characters that show. */
static size_t read_bytes(const char *token, size_t len, char *out)
{
	size_t n = 0;

	for (size_t at = 0; at < len;) {
		const int byte = byte_of(utf8_next(token, len, &at));
		if (byte < 0)
			return 0;
		out[n++] = (char)byte;
	}
	if (utf8_check(out, n) < n)
		return 0;
	for (size_t at = 0; at < n;) {
		const uint32_t c = utf8_next(out, n, &at);
		if (c <= ' ' || unicode_is_dropped(c) || unicode_is_space(c))
			return 0;
	}
	return n;
}

char *bpe_read(const struct bpe *b, int32_t id, int32_t before, struct err *e)
{
	const char *token = vocab_token(&b->vocab, id);
	const size_t last = sizeof BPE_LAST - 1, prefix = before >= 0 && !ends_word(b, before) ? 2 : 0;
	size_t len = strlen(token);
	char *out = mem_alloc(len + 3, 1, "pieces", e);

	if (!out)
		return NULL;
	const int is_special = id == b->start || id == b->end;
	if (!is_special && ends_word(b, id))
		len -= last;
	memcpy(out, "##", prefix);
	size_t n = is_special ? 0 : read_bytes(token, len, out + prefix);
	if (!n)
		memcpy(out + prefix, token, n = len);
	out[prefix + n] = 0;
	return out;
}

/* The encoder's side of nn/bpe.h: a text is cleaned, cut into words, and each word's symbols are merged. The
 * symbols are a linked list, and the merges that its neighbours allow are a heap by rank, then by place: each
 * merge takes log n steps and allows at most two new ones. A merge in the heap of which a symbol is gone by
 * its turn is skipped. */

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
