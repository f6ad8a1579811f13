#include "formats/text.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "formats/safetensors.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void text_free(struct text *t)
{
	char **lists[4] = {t->refs, t->objects, t->texts, t->pieces};

	for (int k = 0; k < 4; k++) {
		for (size_t i = 0; lists[k] && i < t->n; i++)
			free(lists[k][i]);
		free(lists[k]);
	}
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

int text_mark(const struct text *t, const char *list, char *chosen, struct list_name *unknown)
{
	while (list_next(&list, unknown)) {
		size_t i = 0;
		while (i < t->n && !list_name_is(unknown, t->refs[i]))
			i++;
		if (i == t->n)
			return -1;
		chosen[i] = 1;
	}
	return 0;
}

/* The metadata value `key` as a JSON list of n strings. */
static char **read_strings(const struct safetensors *st, const char *key, size_t n, struct err *e)
{
	const char *value = safetensors_meta(st, key);
	cJSON *list = value ? cJSON_Parse(value) : NULL;
	char **strings = NULL;
	size_t used = 0;

	if (!list || !cJSON_IsArray(list)) {
		err_set(e, ERR_FORMAT, "%s: metadata '%s' is not a JSON list", st->path, key);
		goto fail;
	}
	if ((size_t)cJSON_GetArraySize(list) != n) {
		err_set(e, ERR_FORMAT, "%s: metadata '%s' has %d entries for %zu sentences", st->path, key,
			cJSON_GetArraySize(list), n);
		goto fail;
	}
	strings = mem_zalloc(n, sizeof *strings, st->path, e);
	if (!strings)
		goto fail;
	for (const cJSON *item = list->child; item; item = item->next, used++) {
		const char *s = item->valuestring;
		if (!cJSON_IsString(item) || utf8_check(s, strlen(s)) < strlen(s)) {
			err_set(e, ERR_FORMAT, "%s: metadata '%s': entry %zu is not a UTF-8 string", st->path,
				key, used);
			goto fail;
		}
		strings[used] = mem_strdup(s, e);
		if (!strings[used])
			goto fail;
	}
	cJSON_Delete(list);
	return strings;
fail:
	for (size_t i = 0; i < used; i++)
		free(strings[i]);
	free(strings);
	cJSON_Delete(list);
	return NULL;
}

static int read_splits(struct text *t, const struct safetensors *st, struct err *e)
{
	char **names = read_strings(st, "splits", t->n, e);
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

static int by_name(const void *a, const void *b)
{
	return strcmp(*(char *const *)a, *(char *const *)b);
}

static int check_unique(const struct text *t, const char *path, struct err *e)
{
	char **sorted = mem_alloc(t->n, sizeof *sorted, path, e);
	int bad = 0;

	if (!sorted)
		return -1;
	for (size_t i = 0; i < t->n; i++)
		sorted[i] = t->refs[i];
	if (t->n)
		qsort(sorted, t->n, sizeof *sorted, by_name);
	for (size_t i = 1; i < t->n && !bad; i++)
		if (!strcmp(sorted[i - 1], sorted[i]))
			bad = err_set(
				e, ERR_FORMAT, "%s: metadata 'refs': '%s' appears twice", path, sorted[i]);
	free(sorted);
	return bad;
}

static int check_offsets(const struct text *t, int64_t word_count, const char *path, struct err *e)
{
	if (t->offsets[0] != 0)
		return err_set(e, ERR_FORMAT, "%s: tensor 'offsets': begins with %lld, expected 0", path,
			(long long)t->offsets[0]);
	for (size_t i = 0; i < t->n; i++)
		if (t->offsets[i + 1] < t->offsets[i])
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'offsets': falls from %lld to %lld at entry %zu", path,
				(long long)t->offsets[i], (long long)t->offsets[i + 1], i + 1);
	if (t->offsets[t->n] != word_count)
		return err_set(e, ERR_FORMAT,
			"%s: tensor 'offsets': ends with %lld, but there are %lld words", path,
			(long long)t->offsets[t->n], (long long)word_count);
	return 0;
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
	return t->sentences ? check_offsets(t, words->shape[0], st->path, e) : -1;
}

/* As many pieces as the sentence has words. */
static int check_pieces(const struct text *t, const char *path, struct err *e)
{
	for (size_t i = 0; i < t->n; i++) {
		int64_t count = 0, words = t->offsets[i + 1] - t->offsets[i];
		for (const char *c = t->pieces[i]; *c; c++)
			count += *c != ' ' && (c[1] == ' ' || !c[1]);
		if (count != words)
			return err_set(e, ERR_FORMAT,
				"%s: metadata 'pieces': entry %zu has %lld pieces for %lld words", path, i,
				(long long)count, (long long)words);
	}
	return 0;
}

static int read_names(struct text *t, const struct safetensors *st, struct err *e)
{
	t->refs = read_strings(st, "refs", t->n, e);
	t->objects = t->refs ? read_strings(st, "objects", t->n, e) : NULL;
	t->texts = t->objects ? read_strings(st, "texts", t->n, e) : NULL;
	if (!t->texts || read_splits(t, st, e))
		return -1;
	if (safetensors_meta(st, "pieces") &&
		(!(t->pieces = read_strings(st, "pieces", t->n, e)) || check_pieces(t, st->path, e)))
		return -1;
	return check_unique(t, st->path, e);
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

/* n strings as a JSON list; NULL when memory is out. */
static char *print_strings(char *const *strings, size_t n)
{
	cJSON *list = cJSON_CreateArray();
	char *text = NULL;

	for (size_t i = 0; list && i < n; i++) {
		cJSON *item = cJSON_CreateString(strings[i]);
		if (!item || !cJSON_AddItemToArray(list, item)) {
			cJSON_Delete(item);
			goto done;
		}
	}
	if (list)
		text = cJSON_PrintUnformatted(list);
done:
	cJSON_Delete(list);
	return text;
}

static char *print_splits(const struct text *t, struct err *e)
{
	static char train[] = "train", test[] = "test";
	char **names = mem_alloc(t->n, sizeof *names, "splits", e), *text;

	if (!names)
		return NULL;
	for (size_t i = 0; i < t->n; i++)
		names[i] = t->splits[i] == SPLIT_TEST ? test : train;
	text = print_strings(names, t->n);
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
	char *refs = print_strings(t->refs, t->n), *objects = print_strings(t->objects, t->n);
	char *texts = print_strings(t->texts, t->n), *splits = print_splits(t, e);
	char *pieces = t->pieces ? print_strings(t->pieces, t->n) : NULL;
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
