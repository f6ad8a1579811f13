#include "cmd/feature/feature_query.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/scene/selection.h"
#include "lift/marks.h"

#include <math.h>
#include <stdlib.h>

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
	for (; q->levels < q->options->levels; q->levels++)
		if (features_open(&q->features[q->levels], q->options->features[q->levels], e))
			return -1;
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
	struct selection s = {.gaussians = n, .n = q->count, .scene = q->features[0].scene};
	char options[96];
	size_t items = 0;

	for (size_t i = 0; i < q->count; i++)
		items += marks_count(q->marks[i], n);
	s.refs = mem_alloc(q->count, sizeof *s.refs, "sentences", e);
	s.indptr = mem_zalloc(q->count + 1, sizeof *s.indptr, "selection", e);
	s.index = mem_alloc(items, sizeof *s.index, "selection", e);
	int bad = !s.refs || !s.indptr || !s.index;
	for (size_t i = 0; i < q->count && !bad; i++) {
		s.refs[i] = q->text.refs[q->which[i]];
		s.indptr[i + 1] = s.indptr[i] + (int64_t)marks_take(q->marks[i], n, s.index + s.indptr[i]);
	}
	print_options(q, options, sizeof options);
	bad = bad || selection_write(&s, path, options, e);
	free(s.refs);
	free(s.indptr);
	free(s.index);
	return bad ? -1 : 0;
}

int feature_query_write(const struct feature_query *q, const char *path, struct err *e)
{
	return q->options->pixels ? file_out_put(path, query_put_masks, q, e) : write_selection(q, path, e);
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
	free(q->which);
	free(q->marks);
	free(q->group);
	free(q->level);
	free(q->object);
	for (size_t k = 0; q->shown && k < q->view_count * q->count; k++)
		mask_free(&q->shown[k]);
	free(q->shown);
	free(q->views);
	scene_free(&q->scene);
}
