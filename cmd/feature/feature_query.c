#include "cmd/feature/feature_query.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "formats/arrays/npz.h"
#include "formats/arrays/safetensors.h"
#include "formats/scene/selection.h"
#include "lift/marks.h"
#include "lift/query_rules.h"

#include <math.h>

static int take_shape(
	struct query_vectors *v, size_t n, size_t found, size_t channels, const char *path, struct err *e)
{
	if (found != channels)
		return err_set(e, ERR_FORMAT, "%s: vectors of %zu channels, the features have %zu", path,
			found, channels);
	*v = (struct query_vectors){n, channels, mem_alloc(n, channels * sizeof *v->values, "vectors", e)};
	return v->values ? 0 : -1;
}

static int read_array(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	static const char *const names[2] = {"vectors", "arr_0"};
	SCOPED_BY(npy_close) struct npy a = {0};
	SCOPED char *called = NULL;

	if (path_ends(path, ".npy") ? npy_open(&a, path, e) : npz_open_main(path, names, &a, &called, e))
		return -1;
	const char *name = called ? called : path;
	if (a.dims != 2)
		return err_set(
			e, ERR_FORMAT, "%s: has %d dimensions, not 2: texts and channels", name, a.dims);
	if (take_shape(v, a.shape[0], a.shape[1], channels, name, e))
		return -1;
	npy_floats(&a, 0, a.count, v->values);
	return 0;
}

/* The tensor that has the vectors; NULL with *e. */
static const struct st_tensor *find_tensor(const struct safetensors *st, struct err *e)
{
	const char *format = safetensors_meta(st, "format");
	const struct st_tensor *found = NULL;
	size_t count = 0;

	if (format && !strcmp(format, "refer.text"))
		return safetensors_need(st, "sentences", ST_F32, 2, (int64_t[]){-1, -1}, e);
	for (size_t i = 0; i < st->n; i++)
		if (st->tensors[i].dims == 2) {
			found = &st->tensors[i];
			count++;
		}
	if (count == 1)
		return found;
	err_set(e, ERR_FORMAT, "%s: has %zu tensors of two dimensions, not 1", st->path, count);
	return NULL;
}

static int read_safetensors(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	const struct st_tensor *t = find_tensor(&st, e);
	int bad = !t || take_shape(v, (size_t)t->shape[0], (size_t)t->shape[1], channels, st.path, e);
	if (!bad && safetensors_to_float(t, v->values, v->n * channels, e))
		bad = err_prefix(e, st.path);
	return bad ? -1 : 0;
}

/* Checks and scales what was read. */
static int finish(struct query_vectors *v, int bad, const char *path, struct err *e)
{
	for (size_t i = 0; !bad && i < v->n * v->channels; i++)
		if (!isfinite(v->values[i]))
			bad = err_set(e, ERR_FORMAT, "%s: vector %zu is not finite", file_name(path),
				i / v->channels);
	if (!bad)
		query_unit(v->values, v->n, v->channels);
	return bad ? -1 : 0;
}

int query_vectors_read(struct query_vectors *v, const char *path, size_t channels, struct err *e)
{
	*v = (struct query_vectors){0};
	const int is_array = path_ends(path, ".npy") || path_ends(path, ".npz");
	const int bad = (is_array ? read_array : read_safetensors)(v, path, channels, e);

	return finish(v, bad, path, e);
}

int query_vectors_of_text(
	struct query_vectors *v, const struct text *text, const char *path, size_t channels, struct err *e)
{
	*v = (struct query_vectors){0};
	const int bad = take_shape(v, text->n, (size_t)text->width, channels, file_name(path), e);
	if (!bad)
		memcpy(v->values, text->sentences, text->n * channels * sizeof *v->values);
	return finish(v, bad, path, e);
}

void query_vectors_free(struct query_vectors *v)
{
	free(v->values);
	*v = (struct query_vectors){0};
}

static int is_by_vectors(const struct feature_query *q)
{
	return q->options->rule == RULE_COSINE || q->options->rule == RULE_RELEVANCY;
}

/* Labels where groups are asked for, else features; all of one scene and of one width. */
static int check_level(const struct feature_query *q, size_t level, struct err *e)
{
	const struct features *f = &q->features[level], *first = &q->features[0];
	const char *path = f->file.path, *other = first->file.path;
	const int wants_labels = q->options->rule == RULE_IDENTITY;

	if (wants_labels != (f->labels != NULL))
		return err_set(e, ERR_FORMAT, "%s: has %s, the rule needs %s", path,
			f->labels ? "labels" : "features", f->labels ? "features" : "labels");
	if (f->gaussians != first->gaussians)
		return err_set(e, ERR_FORMAT, "%s: is of a scene of %zu Gaussians, %s has %zu", path,
			f->gaussians, other, first->gaussians);
	if (f->channels != first->channels)
		return err_set(e, ERR_FORMAT, "%s: has %zu channels, %s has %zu", path, f->channels, other,
			first->channels);
	return fingerprint_check("scene", path, &f->scene, other, &first->scene, e);
}

static int read_features(struct feature_query *q, struct err *e)
{
	while (q->levels < q->options->levels) {
		const char *path = q->options->features[q->levels];
		if (features_open(&q->features[q->levels++], path, e))
			return -1;
	}
	for (size_t k = 0; k < q->levels; k++)
		if (check_level(q, k, e))
			return -1;
	return 0;
}

static int choose_sentences(struct feature_query *q, struct err *e)
{
	const size_t n = q->text.n, gaussians = q->features[0].gaussians;

	q->which = mem_alloc(n, sizeof *q->which, "sentences", e);
	q->marks = mem_zalloc(n, sizeof *q->marks, "sentences", e);
	if (!q->which || !q->marks)
		return -1;
	for (size_t i = 0; i < n; i++)
		if (q->options->sentences == QUERY_ALL || (int)q->text.splits[i] == q->options->sentences)
			q->which[q->count++] = i;
	for (size_t i = 0; i < q->count; i++)
		if (!(q->marks[i] = marks_make(gaussians, e)))
			return -1;
	return 0;
}

static double published(const struct feature_query_options *o)
{
	if (o->rule == RULE_IDENTITY)
		return QUERY_INSIDE;
	return o->is_relative ? QUERY_RELEVANT_RELATIVE : QUERY_RELEVANT;
}

int feature_query_make(struct feature_query *q, const struct feature_query_options *options,
	const struct report *to, struct err *e)
{
	q->options = options;
	q->threshold = isnan(options->threshold) ? published(options) : options->threshold;
	if (text_read(&q->text, options->text, e) || read_features(q, e) || choose_sentences(q, e))
		return -1;
	if (!q->count)
		report_warn(to, "%s: no sentence in this split", file_name(options->text));
	if (options->pixels)
		return query_by_pixels(q, to, e);
	return is_by_vectors(q) ? query_by_vectors(q, e) : query_by_examples(q, to, e);
}

static void print_options(const struct feature_query *q, char *to, size_t size)
{
	static const char *const rules[] = {"cosine", "relevancy", "hyperplane", "identity"};
	const struct feature_query_options *o = q->options;
	const int used = snprintf(to, size, "--rule %s", rules[o->rule]);

	if (o->rule == RULE_RELEVANCY || o->rule == RULE_IDENTITY)
		snprintf(to + used, size - (size_t)used, " --threshold %.15g%s", q->threshold,
			o->is_relative ? " --relative" : "");
}

static int write_selection(const struct feature_query *q, const char *path, struct err *e)
{
	const size_t n = q->features[0].gaussians;
	char options[96];
	size_t items = 0;

	for (size_t i = 0; i < q->count; i++)
		items += marks_count(q->marks[i], n);
	SCOPED char **refs = mem_alloc(q->count, sizeof *refs, "sentences", e);
	SCOPED int64_t *indptr = mem_zalloc(q->count + 1, sizeof *indptr, "selection", e);
	SCOPED int32_t *index = mem_alloc(items, sizeof *index, "selection", e);
	if (!refs || !indptr || !index)
		return -1;
	for (size_t i = 0; i < q->count; i++) {
		refs[i] = q->text.refs[q->which[i]];
		indptr[i + 1] = indptr[i] + (int64_t)marks_take(q->marks[i], n, index + indptr[i]);
	}
	const struct selection s = {.gaussians = n,
		.n = q->count,
		.refs = refs,
		.indptr = indptr,
		.index = index,
		.scene = q->features[0].scene};
	print_options(q, options, sizeof options);
	return selection_write(&s, path, options, e);
}

int feature_query_write(const struct feature_query *q, const char *path, struct err *e)
{
	struct file_out out;

	if (!q->options->pixels)
		return write_selection(q, path, e);
	return file_out_end(&out, file_out_open(&out, path, e) || query_put_masks(out.stream, q, e), e);
}

void feature_query_free(struct feature_query *q)
{
	for (size_t k = 0; k < q->levels; k++)
		features_close(&q->features[k]);
	for (size_t i = 0; q->marks && i < q->count; i++)
		free(q->marks[i]);
	text_free(&q->text);
	query_vectors_free(&q->vectors);
	lifted_free(&q->lifted);
	mem_free_all(q->which, q->marks, q->group, q->level, q->object);
	for (size_t k = 0; q->shown && k < q->view_count * q->count; k++)
		mask_free(&q->shown[k]);
	scene_free(&q->scene);
	mem_free_all(q->shown, q->views);
}
