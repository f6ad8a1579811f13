/* Cosine and relevancy: all Gaussians' features against all vectors, a block of Gaussians at a time. A block
 * is a whole number of words of the marks, so that no two threads write one. */
#include "cmd/feature/feature_query.h"

#include "base/file.h"
#include "base/mem.h"
#include "lift/marks.h"
#include "lift/query_rules.h"
#include "nn/linear.h"

#include <math.h>

enum { BLOCK = 1024 };

/* Makes the vectors: those of the sentences, then `more`. */
static int join(struct feature_query *q, const float *all, const struct query_vectors *more, size_t channels,
	struct err *e)
{
	const size_t n = q->count + more->n, bytes = channels * sizeof *q->vectors.values;

	q->vectors = (struct query_vectors){n, channels, mem_alloc(n, bytes, "vectors", e)};
	q->group = mem_alloc(n, sizeof *q->group, "vectors", e);
	if (!q->vectors.values || !q->group)
		return -1;
	for (size_t i = 0; i < q->count; i++)
		memcpy(q->vectors.values + i * channels, all + q->which[i] * channels, bytes);
	if (more->n)
		memcpy(q->vectors.values + q->count * channels, more->values, more->n * bytes);
	return 0;
}

/* Sentences of one object are a group, and all else is its own. */
static int find_groups(struct feature_query *q, struct err *e)
{
	SCOPED const char **names = mem_alloc(q->count, sizeof *names, "sentences", e);
	SCOPED_BY(names_free) struct names index = {0};

	for (size_t i = 0; i < q->count && names; i++)
		names[i] = text_object(&q->text, q->which[i]);
	const int bad = !names || names_make(&index, names, sizeof *names, 0, q->count, e);
	for (size_t i = 0; i < q->vectors.n && !bad; i++)
		q->group[i] = i < q->count && names[i] ? names_find(&index, names[i]) : i;
	return bad ? -1 : 0;
}

int query_read_vectors(struct feature_query *q, struct err *e)
{
	const struct feature_query_options *o = q->options;
	const size_t channels = q->features[0].channels;
	const char *more = o->rule == RULE_COSINE ? o->against : o->canonical;
	const char *path = o->vectors ? o->vectors : o->text;
	SCOPED_BY(query_vectors_free) struct query_vectors all = {0}, rivals = {0};

	return -((o->vectors ? query_vectors_read(&all, path, channels, e)
			     : query_vectors_of_text(&all, &q->text, path, channels, e)) ||
		 (all.n != q->text.n && err_set(e, ERR_FORMAT, "%s: has %zu vectors, %s has %zu sentences",
						file_name(path), all.n, file_name(o->text), q->text.n)) ||
		 (more && query_vectors_read(&rivals, more, channels, e)) ||
		 join(q, all.values, &rivals, channels, e) || find_groups(q, e));
}

/* What is done with a Gaussian's cosines (vectors.n). */
struct pass {
	struct feature_query *q;
	size_t level;
	void (*use)(struct pass *p, size_t block, size_t gaussian, const float *cosines, char *selected);
	float *least, *most;	 /* (blocks,count) of relevancies */
	const double *threshold; /* (count) */
};

static void use_block(struct pass *p, size_t block, float *features, float *cosines, char *selected)
{
	const struct feature_query *q = p->q;
	const struct features *f = &q->features[p->level];
	const size_t first = block * BLOCK, left = f->gaussians - first, n = left < BLOCK ? left : BLOCK;

	features_floats(f, first, n, features);
	query_unit(features, n, f->channels);
	linear_forward(cosines, features, q->vectors.values, NULL, n, f->channels, q->vectors.n);
	for (size_t i = 0; i < n; i++)
		if (f->weight[first + i] > 0)
			p->use(p, block, first + i, cosines + i * q->vectors.n, selected);
}

static size_t blocks_of(const struct feature_query *q)
{
	return (q->features[0].gaussians + BLOCK - 1) / BLOCK;
}

static int run(struct pass *p, struct err *e)
{
	const struct feature_query *q = p->q;
	const size_t blocks = blocks_of(q), channels = q->features[p->level].channels;
	int is_out = 0;

#pragma omp parallel reduction(| : is_out)
	{
		struct err own;
		SCOPED float *features = mem_alloc(BLOCK * channels, sizeof *features, "features", &own);
		SCOPED float *cosines = mem_alloc(BLOCK * q->vectors.n, sizeof *cosines, "cosines", &own);
		SCOPED char *selected = mem_alloc(q->count, 1, "selection", &own);
		is_out = !features || !cosines || !selected;
#pragma omp for schedule(dynamic)
		for (size_t b = 0; b < blocks; b++)
			if (features && cosines && selected)
				use_block(p, b, features, cosines, selected);
	}
	return is_out ? err_set(e, ERR_SYSTEM, "cosines: out of memory") : 0;
}

static void take_cosine(struct pass *p, size_t block, size_t gaussian, const float *cosines, char *selected)
{
	const struct feature_query *q = p->q;

	(void)block;
	if (!q->vectors.n)
		return;
	query_cosine(cosines, q->group, q->vectors.n, q->count, selected);
	for (size_t i = 0; i < q->count; i++)
		if (selected[i])
			marks_add(q->marks[i], gaussian);
}

static double relevancy(const struct feature_query *q, size_t i, const float *cosines)
{
	return query_relevancy(cosines[i], cosines + q->count, q->vectors.n - q->count);
}

static void take_range(struct pass *p, size_t block, size_t gaussian, const float *cosines, char *selected)
{
	const struct feature_query *q = p->q;
	float *least = p->least + block * q->count, *most = p->most + block * q->count;

	(void)gaussian, (void)selected;
	for (size_t i = 0; i < q->count; i++) {
		const float own = (float)relevancy(q, i, cosines);
		least[i] = fminf(least[i], own);
		most[i] = fmaxf(most[i], own);
	}
}

static void take_relevant(struct pass *p, size_t block, size_t gaussian, const float *cosines, char *selected)
{
	const struct feature_query *q = p->q;

	(void)block, (void)selected;
	for (size_t i = 0; i < q->count; i++)
		if (q->level[i] == p->level && relevancy(q, i, cosines) > p->threshold[i])
			marks_add(q->marks[i], gaussian);
}

/* Each sentence's level is the one with its largest relevancy; the threshold may be in the range there. */
static int choose_level(struct pass *p, double *threshold, double *best, struct err *e)
{
	struct feature_query *q = p->q;
	const size_t blocks = blocks_of(q), count = blocks * q->count;

	for (size_t k = 0; k < count; k++) {
		p->least[k] = 1;
		p->most[k] = 0;
	}
	p->use = take_range;
	if (run(p, e))
		return -1;
	for (size_t i = 0; i < q->count; i++) {
		double least = 1, most = 0;
		for (size_t b = 0; b < blocks; b++) {
			least = fmin(least, (double)p->least[b * q->count + i]);
			most = fmax(most, (double)p->most[b * q->count + i]);
		}
		if (p->level && most <= best[i])
			continue;
		best[i] = most;
		q->level[i] = p->level;
		threshold[i] = q->options->is_relative ? query_relative_threshold(q->threshold, least, most)
						       : q->threshold;
	}
	return 0;
}

static int by_relevancy(struct feature_query *q, struct err *e)
{
	size_t count;

	if (mem_size(blocks_of(q), q->count, &count))
		return err_set(e, ERR_SYSTEM, "relevancies do not fit in memory");
	SCOPED double *threshold = mem_alloc(q->count, sizeof *threshold, "relevancies", e);
	SCOPED double *best = mem_alloc(q->count, sizeof *best, "relevancies", e);
	SCOPED float *least = mem_alloc(count, sizeof *least, "relevancies", e);
	SCOPED float *most = mem_alloc(count, sizeof *most, "relevancies", e);
	struct pass p = {.q = q, .least = least, .most = most, .threshold = threshold};
	q->level = mem_zalloc(q->count, sizeof *q->level, "sentences", e);
	if (!threshold || !best || !least || !most || !q->level)
		return -1;
	for (p.level = 0; p.level < q->levels; p.level++)
		if (choose_level(&p, threshold, best, e))
			return -1;
	p.use = take_relevant;
	for (p.level = 0; p.level < q->levels; p.level++)
		if (run(&p, e))
			return -1;
	return 0;
}

int query_by_vectors(struct feature_query *q, struct err *e)
{
	struct pass p = {.q = q, .use = take_cosine};

	if (query_read_vectors(q, e))
		return -1;
	return q->options->rule == RULE_COSINE ? run(&p, e) : by_relevancy(q, e);
}
