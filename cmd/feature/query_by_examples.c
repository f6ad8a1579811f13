/* Hyperplane and identity: what a sentence means is shown by the Gaussians of an object that was lifted from
 * masks, the one of the training sentence whose vector is nearest to the sentence's. */
#include "cmd/feature/feature_query.h"

#include "base/dot.h"
#include "base/file.h"
#include "base/mem.h"
#include "lift/hyperplane.h"
#include "lift/marks.h"
#include "lift/query_rules.h"

#include <math.h>

static int check_lifted(const struct feature_query *q, const struct origin *origin, struct err *e)
{
	const struct features *f = &q->features[0];
	const char *path = file_name(q->options->positives), *text = file_name(q->options->text);

	if (q->lifted.gaussians != f->gaussians)
		return err_set(e, ERR_FORMAT, "%s: is of a scene of %zu Gaussians, %s has %zu", path,
			q->lifted.gaussians, f->file.path, f->gaussians);
	if (q->lifted.width != q->text.width)
		return err_set(e, ERR_FORMAT, "%s: is of sentences of width %d, %s has %d", path,
			q->lifted.width, text, q->text.width);
	return fingerprint_check("scene", path, &origin->scene, f->file.path, &f->scene, e) ||
	       fingerprint_check("encoder", text, &q->text.encoder, path, &origin->encoder, e);
}

/* The mean of a training sentence's words, of length 1. */
static void mean_words(const struct lifted *l, size_t sentence, float *mean)
{
	const size_t width = (size_t)l->width;

	memset(mean, 0, width * sizeof *mean);
	for (int64_t w = l->offsets[sentence]; w < l->offsets[sentence + 1]; w++)
		for (size_t c = 0; c < width; c++)
			mean[c] += l->words[(size_t)w * width + c];
	query_unit(mean, 1, width);
}

/* q->object: that of the nearest training sentence; of equally near ones the first. */
static int find_objects(struct feature_query *q, struct err *e)
{
	const struct lifted *l = &q->lifted;
	const size_t width = (size_t)l->width;
	SCOPED float *mean = mem_alloc(width, sizeof *mean, "sentences", e);
	SCOPED double *best = mem_alloc(q->count, sizeof *best, "sentences", e);

	q->object = mem_alloc(q->count, sizeof *q->object, "sentences", e);
	const int bad = !mean || !best || !q->object;
	for (size_t i = 0; i < q->count && !bad; i++) {
		best[i] = -INFINITY;
		q->object[i] = l->objects;
	}
	for (size_t r = 0; r < l->sentences && !bad; r++) {
		mean_words(l, r, mean);
		for (size_t i = 0; i < q->count; i++) {
			const double near = dot_float(mean, q->text.sentences + q->which[i] * width, width);
			if (!(near > best[i]))
				continue;
			best[i] = near;
			q->object[i] = (size_t)l->object[r];
		}
	}
	return bad ? -1 : 0;
}

/* inside (N): 1 for seen Gaussians that are more the object's than not. */
static void find_inside(const struct feature_query *q, size_t object, char *inside)
{
	const struct lifted *l = &q->lifted;

	memset(inside, 0, l->gaussians);
	for (int64_t k = l->indptr[object]; k < l->indptr[object + 1]; k++)
		inside[l->index[k]] =
			l->share[k] > lifted_cut_of(l, object) && q->features[0].weight[l->index[k]] > 0;
}

/* Gaussians that are inside or not, `most` at most, evenly taken of the `count`: their features. Returns how
 * many. */
static size_t take_examples(
	const struct features *f, const char *inside, int kind, size_t count, size_t most, float *examples)
{
	size_t taken = 0, seen = 0;

	for (size_t i = 0; i < f->gaussians; i++) {
		if (!(f->weight[i] > 0) || inside[i] != kind)
			continue;
		if (count <= most || seen * most / count == taken)
			features_floats(f, i, 1, examples + taken++ * f->channels);
		seen++;
	}
	return taken;
}

/* selected (N) gets the Gaussians on the object's side; none where there is nothing to tell apart. */
static int by_hyperplane(const struct feature_query *q, const char *inside, char *selected, struct err *e)
{
	const struct features *f = &q->features[0];
	const size_t channels = f->channels;
	size_t positive = 0, seen = 0;

	memset(selected, 0, f->gaussians);
	for (size_t i = 0; i < f->gaussians; i++) {
		seen += f->weight[i] > 0;
		positive += (size_t)inside[i];
	}
	if (!positive || positive == seen)
		return 0;
	SCOPED float *examples = mem_alloc(
		(size_t)QUERY_POSITIVES + QUERY_NEGATIVES, channels * sizeof *examples, "examples", e);
	SCOPED double *plane = mem_alloc(channels + 1, sizeof *plane, "hyperplane", e);
	int bad = !examples || !plane;
	if (!bad) {
		const size_t first = take_examples(f, inside, 1, positive, QUERY_POSITIVES, examples);
		const size_t rest = take_examples(
			f, inside, 0, seen - positive, QUERY_NEGATIVES, examples + first * channels);
		bad = hyperplane_fit(examples, first + rest, first, channels, plane, e);
	}
	for (size_t i = 0; i < f->gaussians && !bad; i++) {
		if (!(f->weight[i] > 0))
			continue;
		features_floats(f, i, 1, examples);
		selected[i] = hyperplane_side(plane, examples, channels) > 0;
	}
	return bad ? -1 : 0;
}

static int by_identity(const struct feature_query *q, const char *inside, char *selected, struct err *e)
{
	const struct features *f = &q->features[0];
	int32_t most = 0;

	for (size_t i = 0; i < f->gaussians; i++)
		most = f->labels[i] > most ? f->labels[i] : most;
	SCOPED double *sums = mem_alloc((size_t)most + 1, 2 * sizeof *sums, "labels", e);
	if (sums)
		query_identity(f->labels, f->weight, inside, f->gaussians, q->threshold, sums,
			(size_t)most + 1, selected);
	return sums ? 0 : -1;
}

/* An object, for all sentences that mean it. */
static int answer_object(struct feature_query *q, size_t object, struct err *e)
{
	const size_t n = q->features[0].gaussians;
	int is_meant = 0;

	for (size_t i = 0; i < q->count; i++)
		is_meant |= q->object[i] == object;
	if (!is_meant)
		return 0;
	SCOPED char *inside = mem_alloc(n, 1, "Gaussians", e);
	SCOPED char *selected = mem_alloc(n, 1, "Gaussians", e);
	if (!inside || !selected)
		return -1;
	find_inside(q, object, inside);
	if ((q->options->rule == RULE_HYPERPLANE ? by_hyperplane : by_identity)(q, inside, selected, e))
		return -1;
	for (size_t i = 0; i < q->count; i++)
		for (size_t k = 0; k < n && q->object[i] == object; k++)
			if (selected[k])
				marks_add(q->marks[i], k);
	return 0;
}

int query_by_examples(struct feature_query *q, const struct report *to, struct err *e)
{
	struct origin origin;
	size_t done = 0;
	int is_bad = 0;

	if (lifted_read(&q->lifted, &origin, q->options->positives, e) || check_lifted(q, &origin, e) ||
		find_objects(q, e))
		return -1;
	report_start(to, "objects", (double)q->lifted.objects);
#pragma omp parallel for schedule(dynamic) reduction(| : is_bad)
	for (size_t o = 0; o < q->lifted.objects; o++) {
		struct err own;
		is_bad |= answer_object(q, o, &own) != 0;
#pragma omp critical(query_objects)
		report_step(to, (double)++done, NULL);
	}
	report_end(to);
	return is_bad ? err_set(e, ERR_SYSTEM, "objects: out of memory") : 0;
}
