#include "nn/wordpiece.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "nn/unicode.h"

static const char *const special_tokens[WORDPIECE_SPECIALS] = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"};

/* FNV-1a, 64 bits. `hash` is the state so far. */
static uint64_t hash_bytes(uint64_t hash, const char *bytes, size_t len)
{
	for (size_t i = 0; i < len; i++)
		hash = (hash ^ (unsigned char)bytes[i]) * 0x100000001b3;
	return hash;
}

/* The slot of a token, or the free one where it belongs. */
static size_t find_slot(const struct vocab *v, const char *token, size_t len)
{
	uint64_t hash = hash_bytes(0xcbf29ce484222325, token, len);
	size_t slot = (size_t)(hash ^ hash >> 32) & (v->slots - 1);

	for (; v->table[slot]; slot = (slot + 1) & (v->slots - 1)) {
		const char *there = v->entries[v->table[slot] - 1].token;
		if (!strncmp(there, token, len) && !there[len])
			break;
	}
	return slot;
}

int32_t vocab_find(const struct vocab *v, const char *token, size_t len)
{
	uint32_t found = v->slots ? v->table[find_slot(v, token, len)] : 0;

	return found ? v->entries[found - 1].id : -1;
}

/* Every entry in its place; the table has room for them, and is empty. */
static void fill_table(struct vocab *v)
{
	for (size_t i = 0; i < v->n; i++)
		v->table[find_slot(v, v->entries[i].token, strlen(v->entries[i].token))] = (uint32_t)i + 1;
}

/* Twice the slots (at least 1024), everything in its new place. */
static int grow_table(struct vocab *v, struct err *e)
{
	size_t slots = v->slots ? v->slots * 2 : 1024;
	uint32_t *table = mem_zalloc(slots, sizeof *table, "vocabulary", e);

	if (!table)
		return -1;
	free(v->table);
	v->table = table;
	v->slots = slots;
	fill_table(v);
	return 0;
}

int vocab_add(struct vocab *v, const char *token, int32_t id, struct err *e)
{
	if (v->n >= INT32_MAX)
		return err_set(e, ERR_SYSTEM, "vocabulary: too many tokens");
	if (v->n * 2 >= v->slots && grow_table(v, e))
		return -1;
	size_t slot = find_slot(v, token, strlen(token));
	if (v->table[slot])
		return 1;
	if (mem_grow((void **)&v->entries, &v->capacity, v->n + 1, sizeof *v->entries, "vocabulary", e))
		return -1;
	char *copy = mem_strdup(token, e);
	if (!copy)
		return -1;
	v->entries[v->n++] = (struct vocab_entry){copy, id};
	v->table[slot] = (uint32_t)v->n;
	return 0;
}

static int by_id(const void *a, const void *b)
{
	const struct vocab_entry *x = a, *y = b;
	int order = (x->id > y->id) - (x->id < y->id);

	return order ? order : strcmp(x->token, y->token);
}

const char *vocab_token(const struct vocab *v, int32_t id)
{
	size_t low = 0, high = v->n - 1;

	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (v->entries[middle].id < id)
			low = middle + 1;
		else
			high = middle;
	}
	return v->entries[low].token;
}

void vocab_sort(struct vocab *v)
{
	if (v->n) {
		qsort(v->entries, v->n, sizeof *v->entries, by_id);
		memset(v->table, 0, v->slots * sizeof *v->table);
		fill_table(v);
	}
}

const char *vocab_finish(struct vocab *v)
{
	vocab_sort(v);
	for (int i = 0; i < WORDPIECE_SPECIALS; i++) {
		v->special[i] = vocab_find(v, special_tokens[i], strlen(special_tokens[i]));
		if (v->special[i] < 0 && i >= WORDPIECE_UNK && i <= WORDPIECE_SEP)
			return special_tokens[i];
	}
	return NULL;
}

void vocab_free(struct vocab *v)
{
	for (size_t i = 0; i < v->n; i++)
		free(v->entries[i].token);
	mem_free_all(v->entries, v->table);
	*v = (struct vocab){0};
}

/* The word being gathered. Two bytes of "##" stand before it, so that a piece within it needs no copy to be
 * looked up: the two bytes before its start are lent for the purpose. */
struct word {
	size_t characters;			/* all of them, also those that no longer fit */
	size_t len;				/* bytes kept */
	char bytes[2 + 4 * WORDPIECE_LONGEST];	/* from index 2 on */
	unsigned char sizes[WORDPIECE_LONGEST]; /* bytes of each character */
};

/* The longest piece at `start`: its length in bytes, 0 for none. */
static size_t longest_piece(
	const struct vocab *v, struct word *w, size_t start, size_t character, int32_t *id)
{
	char *piece = w->bytes + 2 + start, lent[2];
	size_t prefix = start ? 2 : 0, len = w->len - start;

	memcpy(lent, piece - 2, 2);
	if (prefix)
		piece[-2] = piece[-1] = '#';
	for (size_t last = w->characters; len; len -= w->sizes[--last]) {
		*id = vocab_find(v, piece - prefix, len + prefix);
		if (*id >= 0 || last == character + 1)
			break;
	}
	memcpy(piece - 2, lent, 2);
	return *id >= 0 ? len : 0;
}

int wordpieces_push(struct wordpieces *out, int32_t id, struct err *e)
{
	if (mem_grow((void **)&out->ids, &out->capacity, out->n + 1, sizeof *out->ids, "word pieces", e))
		return -1;
	out->ids[out->n++] = id;
	return 0;
}

/* Cuts the word up and empties it. */
static int end_word(const struct vocab *v, struct word *w, struct wordpieces *out, struct err *e)
{
	size_t first = out->n, at = 0, character = 0;
	int bad = 0, is_known = w->characters <= WORDPIECE_LONGEST;

	while (is_known && at < w->len && !bad) {
		int32_t id = -1;
		size_t len = longest_piece(v, w, at, character, &id);
		if (!len) {
			is_known = 0;
			break;
		}
		bad = wordpieces_push(out, id, e);
		for (size_t end = at + len; at < end; at += w->sizes[character++])
			continue;
	}
	if (!is_known) {
		out->n = first;
		bad = wordpieces_push(out, v->special[WORDPIECE_UNK], e);
	}
	w->characters = w->len = 0;
	return bad;
}

static void add_to_word(struct word *w, uint32_t c)
{
	if (w->characters < WORDPIECE_LONGEST) {
		size_t size = utf8_put(w->bytes + 2 + w->len, c);
		w->sizes[w->characters] = (unsigned char)size;
		w->len += size;
	}
	w->characters++;
}

/* One character of the text, after those that are dropped. */
static int add_character(
	const struct vocab *v, struct word *w, uint32_t c, struct wordpieces *out, struct err *e)
{
	uint32_t folded[UNICODE_FOLD_MAX];
	int is_ideograph = unicode_is_ideograph(c);

	if (unicode_is_space(c) || is_ideograph)
		if (end_word(v, w, out, e))
			return -1;
	if (unicode_is_space(c))
		return 0;
	size_t n = unicode_fold(c, folded);
	for (size_t i = 0; i < n; i++) {
		int is_punctuation = unicode_is_punctuation(folded[i]);
		if (is_punctuation && end_word(v, w, out, e))
			return -1;
		add_to_word(w, folded[i]);
		if (is_punctuation && end_word(v, w, out, e))
			return -1;
	}
	return is_ideograph ? end_word(v, w, out, e) : 0;
}

/* The special token written out at text, or -1. */
static int special_at(const struct vocab *v, const char *text)
{
	for (int i = 0; *text == '[' && i < WORDPIECE_SPECIALS; i++)
		if (v->special[i] >= 0 && !strncmp(text, special_tokens[i], strlen(special_tokens[i])))
			return i;
	return -1;
}

int wordpiece_encode(const struct vocab *v, const char *text, struct wordpieces *out, struct err *e)
{
	struct word w = {0};
	size_t len = strlen(text), at = 0;

	while (at < len) {
		int special = special_at(v, text + at);
		if (special >= 0) {
			if (end_word(v, &w, out, e) || wordpieces_push(out, v->special[special], e))
				return -1;
			at += strlen(special_tokens[special]);
			continue;
		}
		uint32_t c = utf8_next(text, len, &at);
		if (!unicode_is_dropped(c) && add_character(v, &w, c, out, e))
			return -1;
	}
	return end_word(v, &w, out, e);
}
