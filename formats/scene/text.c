#include "formats/scene/text.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/arrays/metalist.h"
#include "formats/arrays/safetensors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void text_free(struct text *t)
{
	metalist_free(t->refs, t->n);
	metalist_free(t->objects, t->n);
	metalist_free(t->texts, t->n);
	metalist_free(t->pieces, t->n);
	metalist_free(t->object_lists, t->n);
	metalist_free(t->views, t->n);
	metalist_free(t->kinds, t->n);
	free(t->offsets);
	free(t->words);
	free(t->middle);
	free(t->sentences);
	free(t->splits);
	*t = (struct text){0};
}

int text_mark(const struct text *t, const char *list, const char *option, char *chosen, struct err *e)
{
	return names_mark(t->refs, sizeof *t->refs, 0, t->n, list, option, "sentence", chosen, e);
}

const float *text_middle(const struct text *t, size_t sentence)
{
	return t->middle ? t->middle + (size_t)t->offsets[sentence] * (size_t)t->width : NULL;
}

const char *text_object(const struct text *t, size_t sentence)
{
	return *t->objects[sentence] ? t->objects[sentence] : NULL;
}

static int read_splits(struct text *t, const struct safetensors *st, struct err *e)
{
	char **names = metalist_read(st, "splits", t->n, "sentences", e);
	int bad = 0;

	if (!names)
		return -1;
	t->splits = mem_alloc(t->n, sizeof *t->splits, st->path, e);
	for (size_t i = 0; i < t->n; i++) {
		if (t->splits && !bad) {
			t->splits[i] = strcmp(names[i], "test") ? SPLIT_TRAIN : SPLIT_TEST;
			if (strcmp(names[i], "test") && strcmp(names[i], "train"))
				bad = err_set(e, ERR_FORMAT,
					"%s: metadata 'splits': entry %zu is '%s', not 'train' or 'test'",
					st->path, i, names[i]);
		}
		free(names[i]);
	}
	free(names);
	return t->splits ? bad : -1;
}

/* A copy of a matrix of words or sentences, all of it finite. */
static float *read_matrix(
	const struct safetensors *st, const char *name, size_t rows, int width, struct err *e)
{
	float *x = safetensors_copy(st, name, ST_F32, 2, (int64_t[]){(int64_t)rows, width}, NULL, e);

	if (x && safetensors_check_finite(st, name, x, rows * (size_t)width, e)) {
		free(x);
		return NULL;
	}
	return x;
}

static int read_tensors(struct text *t, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *words;

	if (!(t->offsets = metalist_offsets(st, "offsets", "sentences", &t->n, e)) ||
		!(words = safetensors_need(st, "words", ST_F32, 2, (int64_t[]){-1, -1}, e)))
		return -1;
	if (words->shape[1] < 1 || words->shape[1] > 65536)
		return err_set(e, ERR_FORMAT, "%s: tensor 'words': width %lld is not in 1 to 65536", st->path,
			(long long)words->shape[1]);
	const size_t rows = (size_t)words->shape[0];
	t->width = (int)words->shape[1];
	if (!(t->words = read_matrix(st, "words", rows, t->width, e)) ||
		!(t->sentences = read_matrix(st, "sentences", t->n, t->width, e)) ||
		(safetensors_find(st, "middle") &&
			!(t->middle = read_matrix(st, "middle", rows, t->width, e))))
		return -1;
	return metalist_check_offsets("offsets", t->offsets, t->n, words->shape[0], "words", st->path, e);
}

/* A list that may not be there: then *to stays NULL. */
static int read_more(
	char ***to, const struct text *t, const struct safetensors *st, const char *key, struct err *e)
{
	if (safetensors_meta(st, key) && !(*to = metalist_read(st, key, t->n, "sentences", e)))
		return -1;
	return 0;
}

static int check_lists(const struct text *t, const char *path, struct err *e)
{
	for (size_t i = 0; t->object_lists && i < t->n; i++) {
		size_t n;
		struct err own;
		char **names = *t->object_lists[i] ? metalist_parse(t->object_lists[i], &n, &own) : NULL;
		if (!names && *t->object_lists[i])
			return err_set(e, ERR_FORMAT,
				"%s: metadata 'object_lists': entry %zu is not a JSON list of names", path,
				i);
		if (names)
			metalist_free(names, n);
	}
	return 0;
}

static int read_names(struct text *t, const struct safetensors *st, struct err *e)
{
	t->refs = metalist_read(st, "refs", t->n, "sentences", e);
	t->objects = t->refs ? metalist_read(st, "objects", t->n, "sentences", e) : NULL;
	t->texts = t->objects ? metalist_read(st, "texts", t->n, "sentences", e) : NULL;
	if (!t->texts || metalist_check_names(t->refs, t->n, 0, "refs", st->path, e) || read_splits(t, st, e))
		return -1;
	if (safetensors_meta(st, "pieces") &&
		(!(t->pieces = metalist_read(st, "pieces", t->n, "sentences", e)) ||
			metalist_check_pieces(t->pieces, t->offsets, t->n, st->path, e)))
		return -1;
	if (read_more(&t->object_lists, t, st, "object_lists", e) ||
		read_more(&t->views, t, st, "views", e) || read_more(&t->kinds, t, st, "kinds", e) ||
		check_lists(t, st->path, e) ||
		metalist_check_names(t->objects, t->n, t->object_lists != NULL, "objects", st->path, e))
		return -1;
	return metalist_check_unique(t->refs, t->n, "refs", st->path, e);
}

int text_read(struct text *t, const char *path, struct err *e)
{
	struct safetensors st;

	*t = (struct text){0};
	if (safetensors_open(&st, path, e))
		return -1;
	int bad = safetensors_need_format(&st, "refer.text", 1, e) || read_tensors(t, &st, e) ||
		  read_names(t, &st, e) || fingerprint_read(&t->encoder, &st, "encoder", e);
	safetensors_close(&st);
	if (bad)
		text_free(t);
	return bad ? -1 : 0;
}

static char *print_splits(const struct text *t, struct err *e)
{
	static char train[] = "train", test[] = "test";
	char **names = mem_alloc(t->n, sizeof *names, "splits", e), *text;

	if (!names)
		return NULL;
	for (size_t i = 0; i < t->n; i++)
		names[i] = t->splits[i] == SPLIT_TEST ? test : train;
	text = metalist_print(names, t->n);
	free(names);
	return text;
}

int text_write(const struct text *t, const char *path, const char *options, struct err *e)
{
	int64_t n = (int64_t)t->n;
	const struct st_tensor tensors[] = {st_matrix("words", ST_F32, t->offsets[n], t->width, t->words),
		st_vector("offsets", ST_I64, n + 1, t->offsets),
		st_matrix("sentences", ST_F32, n, t->width, t->sentences),
		st_matrix("middle", ST_F32, t->offsets[n], t->width, t->middle)};
	/* In the order of formats/scene/text.md; those that are NULL are left out. */
	char **const lists[] = {
		t->refs, t->objects, t->texts, NULL, t->pieces, t->object_lists, t->views, t->kinds};
	static const char *const keys[] = {
		"refs", "objects", "texts", "splits", "pieces", "object_lists", "views", "kinds"};
	enum { LISTS = sizeof keys / sizeof *keys, SPLITS = 3, FIXED = 6 };
	struct st_meta meta[FIXED + LISTS] = {{"format", "refer.text"}, {"version", "1"},
		{"tool", "text-encode"}, {"options", options}, {"seed", "0"},
		{"encoder", fingerprint_text(&t->encoder)}};
	char *printed[LISTS] = {0};
	int used = FIXED, bad = 0;

	for (int i = 0; i < LISTS && !bad; i++) {
		if (i != SPLITS && !lists[i])
			continue;
		printed[i] = i == SPLITS ? print_splits(t, e) : metalist_print(lists[i], t->n);
		if (!printed[i])
			bad = err_set(e, ERR_SYSTEM, "%s: out of memory", path);
		meta[used++] = (struct st_meta){keys[i], printed[i]};
	}
	bad = bad || safetensors_write(path, tensors, t->middle ? 4 : 3, meta, (size_t)used, e);
	for (int i = 0; i < LISTS; i++)
		free(printed[i]);
	return bad ? -1 : 0;
}
