#include "nn/bpe_private.h"

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
	SCOPED char *joined = malloc(first + second + 1);

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
