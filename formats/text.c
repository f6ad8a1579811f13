#include "formats/text.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/metalist.h"
#include "formats/safetensors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void text_free(struct text *t)
{
	metalist_free(t->refs, t->n);
	metalist_free(t->objects, t->n);
	metalist_free(t->texts, t->n);
	metalist_free(t->pieces, t->n);
	free(t->offsets);
	free(t->words);
	free(t->sentences);
	free(t->splits);
	*t = (struct text){0};
}

int text_take_means(struct text *t, struct err *e)
{
	const size_t width = (size_t)t->width;

	for (size_t r = 0; r < t->n; r++) {
		const size_t first = (size_t)t->offsets[r], end = (size_t)t->offsets[r + 1];
		for (size_t i = 0; i < width && end > first; i++) {
			double sum = 0;
			for (size_t w = first; w < end; w++)
				sum += t->words[w * width + i];
			t->sentences[r * width + i] = (float)(sum / (double)(end - first));
			if (!isfinite(t->sentences[r * width + i]))
				return err_set(e, ERR_FORMAT, "ref '%s': the encoder's output is not finite",
					t->refs[r]);
		}
	}
	return 0;
}

int text_mark(const struct text *t, const char *list, const char *option, char *chosen, struct err *e)
{
	return names_mark(t->refs, sizeof *t->refs, 0, t->n, list, option, "sentence", chosen, e);
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

/* A copy of a float tensor, all of it finite. */
static float *copy_floats(const struct safetensors *st, const struct st_tensor *tensor, struct err *e)
{
	size_t count = tensor->bytes / sizeof(float);
	float *out = mem_alloc(count, sizeof *out, st->path, e);

	if (!out || safetensors_to_float(tensor, out, count, e))
		goto fail;
	for (size_t i = 0; i < count; i++)
		if (!isfinite(out[i])) {
			err_set(e, ERR_FORMAT, "%s: tensor '%s': item %zu is not finite", st->path,
				tensor->name, i);
			goto fail;
		}
	return out;
fail:
	free(out);
	return NULL;
}

static int read_tensors(struct text *t, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *offsets = safetensors_need(st, "offsets", ST_I64, 1, (int64_t[]){-1}, e);
	const struct st_tensor *words, *sentences;

	if (!offsets || !(words = safetensors_need(st, "words", ST_F32, 2, (int64_t[]){-1, -1}, e)))
		return -1;
	if (offsets->shape[0] < 1 || offsets->shape[0] > INT32_MAX)
		return err_set(e, ERR_FORMAT,
			"%s: tensor 'offsets': has %lld entries, expected 1 more than sentences", st->path,
			(long long)offsets->shape[0]);
	if (words->shape[1] < 1 || words->shape[1] > 65536)
		return err_set(e, ERR_FORMAT, "%s: tensor 'words': width %lld is not in 1 to 65536", st->path,
			(long long)words->shape[1]);
	t->n = (size_t)offsets->shape[0] - 1;
	t->width = (int)words->shape[1];
	sentences = safetensors_need(st, "sentences", ST_F32, 2, (int64_t[]){(int64_t)t->n, t->width}, e);
	if (!sentences)
		return -1;
	t->offsets = mem_alloc(t->n + 1, sizeof *t->offsets, st->path, e);
	if (!t->offsets)
		return -1;
	memcpy(t->offsets, offsets->data, offsets->bytes);
	t->words = copy_floats(st, words, e);
	t->sentences = t->words ? copy_floats(st, sentences, e) : NULL;
	return t->sentences ? metalist_check_offsets(
				      "offsets", t->offsets, t->n, words->shape[0], "words", st->path, e)
			    : -1;
}

static int read_names(struct text *t, const struct safetensors *st, struct err *e)
{
	t->refs = metalist_read(st, "refs", t->n, "sentences", e);
	t->objects = t->refs ? metalist_read(st, "objects", t->n, "sentences", e) : NULL;
	t->texts = t->objects ? metalist_read(st, "texts", t->n, "sentences", e) : NULL;
	if (!t->texts || read_splits(t, st, e))
		return -1;
	if (safetensors_meta(st, "pieces") &&
		(!(t->pieces = metalist_read(st, "pieces", t->n, "sentences", e)) ||
			metalist_check_pieces(t->pieces, t->offsets, t->n, st->path, e)))
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
		  read_names(t, &st, e);
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
	const struct st_tensor tensors[] = {
		{.name = "words",
			.dtype = ST_F32,
			.dims = 2,
			.shape = {t->offsets[n], t->width},
			.data = t->words},
		{.name = "offsets", .dtype = ST_I64, .dims = 1, .shape = {n + 1}, .data = t->offsets},
		{.name = "sentences",
			.dtype = ST_F32,
			.dims = 2,
			.shape = {n, t->width},
			.data = t->sentences},
	};
	char *refs = metalist_print(t->refs, t->n), *objects = metalist_print(t->objects, t->n);
	char *texts = metalist_print(t->texts, t->n), *splits = print_splits(t, e);
	char *pieces = t->pieces ? metalist_print(t->pieces, t->n) : NULL;
	int bad;

	if (refs && objects && texts && splits && (pieces || !t->pieces)) {
		const struct st_meta meta[] = {{"format", "refer.text"}, {"version", "1"},
			{"tool", "text-encode"}, {"options", options}, {"seed", "0"}, {"refs", refs},
			{"objects", objects}, {"texts", texts}, {"splits", splits}, {"pieces", pieces}};
		bad = safetensors_write(path, tensors, 3, meta, sizeof meta / sizeof *meta - !pieces, e);
	} else {
		bad = err_set(e, ERR_SYSTEM, "%s: out of memory", path);
	}
	free(refs);
	free(objects);
	free(texts);
	free(splits);
	free(pieces);
	return bad;
}
