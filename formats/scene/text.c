#include "formats/scene/text.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/arrays/arrays_in.h"
#include "formats/arrays/metalist.h"
#include "formats/arrays/safetensors.h"

void text_free(struct text *t)
{
	char **const lists[] = {
		t->refs, t->objects, t->texts, t->pieces, t->object_lists, t->views, t->kinds};

	for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
		mem_free_strings(lists[i], t->n);
	mem_free_all(t->offsets, t->words, t->middle, t->sentences, t->splits);
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

static void read_splits(struct text *t, struct arrays_in *in)
{
	char **names = arrays_in_list(in, "splits", t->n, "sentences");

	t->splits = names ? mem_alloc(t->n, sizeof *t->splits, in->st->path, in->e) : NULL;
	in->bad |= !t->splits;
	for (size_t i = 0; i < t->n && !in->bad; i++) {
		t->splits[i] = strcmp(names[i], "test") ? SPLIT_TRAIN : SPLIT_TEST;
		if (strcmp(names[i], "test") && strcmp(names[i], "train"))
			in->bad = err_file(in->e, in->st->path,
				"metadata 'splits': entry %zu is '%s', not 'train' or 'test'", i, names[i]);
	}
	mem_free_strings(names, t->n);
}

/* A list that may not be there: then it is NULL. */
static char **read_more(const struct text *t, struct arrays_in *in, const char *key)
{
	return safetensors_meta(in->st, key) ? arrays_in_list(in, key, t->n, "sentences") : NULL;
}

static void check_lists(const struct text *t, struct arrays_in *in)
{
	char reason[METALIST_REASON];

	for (size_t i = 0; t->object_lists && i < t->n && !in->bad; i++) {
		size_t n = 0;
		char **names = *t->object_lists[i] ? metalist_parse(t->object_lists[i], &n, reason) : NULL;
		if (!names && *t->object_lists[i])
			in->bad = err_file(in->e, in->st->path,
				"metadata 'object_lists': entry %zu is not a JSON list of names", i);
		mem_free_strings(names, n);
	}
}

static void read_names(struct text *t, struct arrays_in *in)
{
	t->refs = arrays_in_list(in, "refs", t->n, "sentences");
	t->objects = arrays_in_list(in, "objects", t->n, "sentences");
	t->texts = arrays_in_list(in, "texts", t->n, "sentences");
	arrays_in_check_names(in, t->refs, t->n, 0, "refs");
	read_splits(t, in);
	if ((t->pieces = read_more(t, in, "pieces")))
		arrays_in_check_pieces(in, t->pieces, t->offsets, t->n);
	t->object_lists = read_more(t, in, "object_lists");
	t->views = read_more(t, in, "views");
	t->kinds = read_more(t, in, "kinds");
	check_lists(t, in);
	arrays_in_check_names(in, t->objects, t->n, t->object_lists != NULL, "objects");
	arrays_in_check_unique(in, t->refs, t->n, "refs");
}

int text_read(struct text *t, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};
	struct arrays_in in;
	size_t words;

	*t = (struct text){0};
	if (safetensors_open(&st, path, e))
		return -1;
	arrays_in_begin(&in, &st, "refer.text", 1, e);
	t->offsets = arrays_in_offsets(&in, "offsets", "sentences", &t->n);
	t->width = arrays_in_width(&in, "words", ST_F32, &words);
	t->words = arrays_in_floats(&in, "words", words, t->width);
	t->sentences = arrays_in_floats(&in, "sentences", t->n, t->width);
	if (safetensors_find(&st, "middle"))
		t->middle = arrays_in_floats(&in, "middle", words, t->width);
	arrays_in_check_offsets(&in, "offsets", t->offsets, t->n, words, "words");
	read_names(t, &in);
	const int bad = in.bad || fingerprint_read(&t->encoder, &st, "encoder", e);
	return bad ? -1 : 0;
}

static void put_splits(struct arrays_out *out, const struct text *t)
{
	static char train[] = "train", test[] = "test";
	char **names = arrays_out_memory(out, t->n, sizeof *names);

	for (size_t i = 0; i < t->n && names; i++)
		names[i] = t->splits[i] == SPLIT_TEST ? test : train;
	arrays_out_list(out, "splits", names, t->n);
}

int text_write(const struct text *t, const char *path, const char *options, struct err *e)
{
	const int64_t n = (int64_t)t->n, words = t->offsets[n];
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.text", "1", "text-encode", options, 0, e);
	arrays_out_text(&out, "encoder", fingerprint_text(&t->encoder));
	arrays_out_list(&out, "refs", t->refs, t->n);
	arrays_out_list(&out, "objects", t->objects, t->n);
	arrays_out_list(&out, "texts", t->texts, t->n);
	put_splits(&out, t);
	arrays_out_list(&out, "pieces", t->pieces, t->n);
	arrays_out_list(&out, "object_lists", t->object_lists, t->n);
	arrays_out_list(&out, "views", t->views, t->n);
	arrays_out_list(&out, "kinds", t->kinds, t->n);
	arrays_out_put(&out, st_matrix("words", ST_F32, words, t->width, t->words));
	arrays_out_put(&out, st_vector("offsets", ST_I64, n + 1, t->offsets));
	arrays_out_put(&out, st_matrix("sentences", ST_F32, n, t->width, t->sentences));
	if (t->middle)
		arrays_out_put(&out, st_matrix("middle", ST_F32, words, t->width, t->middle));
	return arrays_out_end(&out);
}
