#include "formats/encoders/merges.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/utf8.h"
#include "formats/encoders/vocab.h"
#include "formats/records/json.h"

#include <stdio.h>
#include <zlib.h>

#define OPEN_CLIP_LIST "bpe_simple_vocab_16e6.txt.gz"
enum { MOST_TEXT = 64 << 20 /* bytes of a list of merges */ };

struct pair {
	char *left, *right;
};

/* Merges in their order, and what a message calls the i-th: PATH:(first + i) or PATH: merge i. */
struct list {
	const char *path;
	char *text; /* that the pairs point into, or NULL */
	size_t n, capacity, first;
	struct pair *pairs;
	int is_of_lines;
};

static void list_free(struct list *l)
{
	mem_free_all(l->text, l->pairs);
}

static int fail(const struct list *l, size_t i, const char *reason, struct err *e)
{
	if (l->is_of_lines)
		return err_set(e, ERR_FORMAT, "%s:%zu: %s", l->path, l->first + i, reason);
	return err_file(e, l->path, "merge %zu: %s", i, reason);
}

/* Cuts "left right" in two. */
static int list_add(struct list *l, char *merge, struct err *e)
{
	char *blank = strchr(merge, ' ');

	if (utf8_check(merge, strlen(merge)) < strlen(merge))
		return fail(l, l->n, "not UTF-8", e);
	if (!blank || blank == merge || !blank[1] || strchr(blank + 1, ' '))
		return fail(l, l->n, "not two symbols with a space between", e);
	if (mem_grow((void **)&l->pairs, &l->capacity, l->n + 1, sizeof *l->pairs, l->path, e))
		return -1;
	*blank = 0;
	l->pairs[l->n++] = (struct pair){merge, blank + 1};
	return 0;
}

/* One merge a line, after a line with "#version", if there is one; no more than `most`. */
static int list_lines(struct list *l, size_t len, size_t most, struct err *e)
{
	int bad = 0;

	if (strlen(l->text) < len)
		return err_file(e, l->path, "a NUL byte at offset %zu", strlen(l->text));
	l->is_of_lines = l->first = 1;
	for (char *at = l->text, *next; *at && l->n < most && !bad; at = next) {
		const size_t size = strcspn(at, "\n");
		next = at + size + (at[size] == '\n');
		at[size] = 0;
		if (size && at[size - 1] == '\r')
			at[size - 1] = 0;
		if (at == l->text && strstr(at, "#version"))
			l->first++;
		else
			bad = list_add(l, at, e);
	}
	return bad;
}

static int read_file(struct list *l, size_t most, struct err *e)
{
	size_t len;

	return -(file_read(l->path, &l->text, &len, e) || list_lines(l, len, most, e));
}

/* All that an open gzip stream has, and a NUL after it; *len of it. */
static int inflate_text(struct list *l, gzFile in, size_t *len, struct err *e)
{
	enum { STEP = 1 << 16 };
	size_t capacity = 0;
	int got;

	do {
		if (*len >= MOST_TEXT)
			return err_file(e, l->path, "more than %d bytes of merges", MOST_TEXT);
		if (mem_grow((void **)&l->text, &capacity, *len + STEP + 1, 1, l->path, e))
			return -1;
		got = gzread(in, l->text + *len, STEP);
		*len += got > 0 ? (size_t)got : 0;
	} while (got > 0);
	l->text[*len] = 0;
	return got < 0 ? err_file(e, l->path, "the gzip stream is damaged") : 0;
}

static int read_gzip(struct list *l, size_t most, struct err *e)
{
	gzFile in = gzopen(l->path, "rb");
	size_t len = 0;

	if (!in)
		return err_errno(e, "%s", l->path);
	const int bad = inflate_text(l, in, &len, e);
	if (gzclose(in) == Z_BUF_ERROR && !bad)
		return err_file(e, l->path, "the gzip stream is damaged");
	return -(bad || list_lines(l, len, most, e));
}

/* "left right" or ["left","right"]: cJSON's own strings, cut in two. */
static int list_item(struct list *l, const cJSON *item, struct err *e)
{
	const cJSON *left = cJSON_GetArrayItem(item, 0), *right = cJSON_GetArrayItem(item, 1);

	if (cJSON_IsString(item))
		return list_add(l, item->valuestring, e);
	if (cJSON_GetArraySize(item) != 2 || !cJSON_IsString(left) || !cJSON_IsString(right))
		return fail(l, l->n, "not two symbols with a space between", e);
	if (mem_grow((void **)&l->pairs, &l->capacity, l->n + 1, sizeof *l->pairs, l->path, e))
		return -1;
	l->pairs[l->n++] = (struct pair){left->valuestring, right->valuestring};
	return 0;
}

static int add_merges(struct bpe *b, const struct list *l, struct err *e)
{
	for (size_t i = 0; i < l->n; i++) {
		const struct pair *p = &l->pairs[i];
		const int added = bpe_add_merge(b, p->left, p->right, e);
		char reason[256];
		if (added < 0)
			return -1;
		snprintf(reason, sizeof reason,
			added == 1 ? "the merge '%.60s %.60s' appears twice"
				   : "the vocabulary lacks '%.60s', '%.60s' or the two in one",
			p->left, p->right);
		if (added)
			return fail(l, i, reason, e);
	}
	return 0;
}

static int finish(struct bpe *b, const char *vocabulary, const struct list *l, struct err *e)
{
	char missing[BPE_MISSING];

	if (bpe_finish(b, missing))
		return err_file(e, vocabulary, "token '%s' is missing", missing);
	return add_merges(b, l, e);
}

/* vocab.json, and merges.txt beside it. */
static int read_two(struct bpe *b, const char *vocabulary, const char *merges, struct err *e)
{
	SCOPED_BY(list_free) struct list l = {.path = merges};
	SCOPED_BY(json_release) cJSON *root = json_read(vocabulary, e);

	if (!root)
		return -1;
	if (!cJSON_IsObject(root))
		return err_file(e, vocabulary, "not a JSON object");
	return -(vocab_add_all(&b->vocab, root, vocabulary, e) || read_file(&l, SIZE_MAX, e) ||
		 finish(b, vocabulary, &l, e));
}

static int is_lowercase(const cJSON *normalizer)
{
	const cJSON *one;
	int is = json_is(json_get(normalizer, "type"), "Lowercase");

	cJSON_ArrayForEach(one, json_get(normalizer, "normalizers")) is |=
		json_is(json_get(one, "type"), "Lowercase");
	return is;
}

/* A member of the model that must be this string; `may_miss`: or absent, or null. */
static int need_string(const cJSON *model, const char *key, const char *wanted, int may_miss,
	const char *path, struct err *e)
{
	const cJSON *item = json_get(model, key);

	if ((may_miss && (!item || cJSON_IsNull(item))) || json_is(item, wanted))
		return 0;
	return err_file(e, path, "model: '%s' is not \"%s\": only CLIP's tokenizers are read", key, wanted);
}

static int check_kind(const cJSON *root, const char *path, struct err *e)
{
	const cJSON *model = json_get(root, "model");

	if (need_string(model, "type", "BPE", 1, path, e) ||
		need_string(model, "end_of_word_suffix", BPE_LAST, 0, path, e) ||
		need_string(model, "continuing_subword_prefix", "", 1, path, e))
		return -1;
	if (!is_lowercase(json_get(root, "normalizer")))
		return err_file(e, path, "normalizer: no 'Lowercase': only CLIP's tokenizers are read");
	if (!cJSON_IsObject(json_get(model, "vocab")))
		return err_file(e, path, "model: 'vocab' is not an object");
	if (!cJSON_IsArray(json_get(model, "merges")))
		return err_file(e, path, "model: 'merges' is not a list");
	return 0;
}

static int read_tokenizer(struct bpe *b, const char *path, struct err *e)
{
	SCOPED_BY(list_free) struct list l = {.path = path};
	SCOPED_BY(json_release) cJSON *root = json_read(path, e);
	const cJSON *model = json_get(root, "model"), *merge;

	if (!root || check_kind(root, path, e) || vocab_add_all(&b->vocab, json_get(model, "vocab"), path, e))
		return -1;
	cJSON_ArrayForEach(merge, json_get(model, "merges"))
	{
		if (list_item(&l, merge, e))
			return -1;
	}
	return finish(b, path, &l, e) ? -1 : 0;
}

static int add_next(struct bpe *b, const char *first, const char *second, struct err *e)
{
	char token[512];
	const int n = snprintf(token, sizeof token, "%s%s", first, second);

	if (n >= (int)sizeof token)
		return err_set(e, ERR_FORMAT, "a symbol of %d bytes", n);
	const int added = vocab_add(&b->vocab, token, (int32_t)b->vocab.n, e);
	return added > 0 ? err_set(e, ERR_FORMAT, "token '%.100s' appears twice", token) : added;
}

/* As OpenCLIP numbers tokens: all bytes, all bytes at the end of a word, merges, start and end. */
static int make_vocabulary(struct bpe *b, const struct list *l, struct err *e)
{
	char letter[BPE_LETTER_MAX];
	unsigned char byte;
	int bad = 0;

	for (size_t i = 0; i < 2 * BPE_BYTES && !bad; i++) {
		bpe_letter(i % BPE_BYTES, &byte, letter);
		bad = add_next(b, letter, i < BPE_BYTES ? "" : BPE_LAST, e);
	}
	for (size_t i = 0; i < l->n && !bad; i++)
		if ((bad = add_next(b, l->pairs[i].left, l->pairs[i].right, e)) && e->code == ERR_FORMAT) {
			const struct err reason = *e;
			fail(l, i, reason.message, e);
		}
	return -(bad || add_next(b, BPE_START, "", e) || add_next(b, BPE_END, "", e));
}

/* Merges alone. */
static int read_list(struct bpe *b, const char *path, int words, int is_gzip, struct err *e)
{
	enum { OTHERS = 2 * BPE_BYTES + 2 };
	SCOPED_BY(list_free) struct list l = {.path = path};
	const size_t most = words > OTHERS ? (size_t)(words - OTHERS) : 0;
	return -((is_gzip ? read_gzip(&l, most, e) : read_file(&l, most, e)) || make_vocabulary(b, &l, e) ||
		 finish(b, path, &l, e));
}

/* Paths in the folder. */
struct parts {
	char *vocabulary, *merges, *tokenizer, *list;
};

static int read_any(struct bpe *b, const struct parts *p, const char *dir, int words, struct err *e)
{
	if (file_exists(p->vocabulary) && file_exists(p->merges))
		return read_two(b, p->vocabulary, p->merges, e);
	if (file_exists(p->tokenizer))
		return read_tokenizer(b, p->tokenizer, e);
	if (file_exists(p->vocabulary))
		return err_file(e, dir, "has vocab.json, but no merges.txt");
	if (file_exists(p->merges))
		return read_list(b, p->merges, words, 0, e);
	if (file_exists(p->list))
		return read_list(b, p->list, words, 1, e);
	return err_set(e, ERR_SYSTEM, "%s: has no merges.txt, tokenizer.json or " OPEN_CLIP_LIST, dir);
}

int merges_read(struct bpe *b, const char *dir, int words, struct err *e)
{
	struct parts p = {file_join(dir, "vocab.json", "", e), file_join(dir, "merges.txt", "", e),
		file_join(dir, "tokenizer.json", "", e), file_join(dir, OPEN_CLIP_LIST, "", e)};

	*b = (struct bpe){0};
	const int bad =
		!p.vocabulary || !p.merges || !p.tokenizer || !p.list || read_any(b, &p, dir, words, e);
	mem_free_all(p.vocabulary, p.merges, p.tokenizer, p.list);
	return bad ? -1 : 0;
}

char *merges_print(const struct bpe *b, const int32_t *ids, size_t n, struct err *e)
{
	char *text = NULL;
	size_t length;
	FILE *stream = open_memstream(&text, &length);
	int bad = 0;

	for (size_t i = 0; i < n && stream && !bad; i++) {
		SCOPED char *piece = bpe_read(b, ids[i], i ? ids[i - 1] : -1, e);
		bad = !piece;
		if (piece)
			fprintf(stream, "%s%s", i ? " " : "", piece);
	}
	return mem_text_end(stream, &text, bad, "pieces", e);
}
