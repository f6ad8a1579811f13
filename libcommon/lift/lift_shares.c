#include "base/mem.h"
#include "lift/lift_private.h"
#include "lift/marks.h"

/* Keeps the share of a Gaussian that hardly any pixel shows near 0. */
static const double LEAST_WEIGHT = 0.01;

/* One thread's, of all Gaussians: 0 between objects. */
struct sums {
	double *inside;	 /* (N) votes times weights inside the masks */
	uint64_t *marks; /* what a mask shows */
};

size_t lift_row(const struct lift_view *v, size_t object)
{
	size_t k = 0;

	while (k < v->n && v->objects[k] < object)
		k++;
	return k < v->n && v->objects[k] == object ? k : v->n;
}

static void sum_inside(const struct lift_objects *l, size_t object, struct sums *s)
{
	for (size_t at = 0; at < l->view_count; at++) {
		const struct lift_view *v = &l->views[at];
		const size_t k = lift_row(v, object);
		for (size_t j = 0; k < v->n && j < v->rows[k].n; j++) {
			const size_t i = (size_t)v->rows[k].index[j];
			s->inside[i] += (double)v->vote[k] * (double)v->rows[k].share[j];
			marks_add(s->marks, i);
		}
	}
}

/* weight (n of index): votes times weights in the views that have a mask of the object. */
static void sum_weight(
	const struct lift_objects *l, size_t object, const int32_t *index, size_t n, double *weight)
{
	for (size_t at = 0; at < l->view_count; at++) {
		const struct lift_view *v = &l->views[at];
		const size_t k = lift_row(v, object);
		for (size_t j = 0; k < v->n && j < n; j++)
			weight[j] += (double)v->vote[k] * (double)v->weight[index[j]];
	}
}

/* The mean of an object's shares over its own weight, which they are divided by: masks that cover a part of
 * it, and Gaussians that reach over its edge, leave its shares below 1, which its inside should have. */
static double find_level(const struct shares *row, const double *weight)
{
	double sum = 0, squares = 0;

	for (size_t k = 0; k < row->n; k++) {
		const double a = (double)row->share[k], inside = a * weight[k];
		sum += inside;
		squares += inside * a;
	}
	return sum > 0 ? squares / sum : 1;
}

/* An object's shares, and its level. */
static int make_row(struct lift_objects *l, size_t object, struct sums *s, double *level, struct err *e)
{
	struct shares *row = &l->shares[object];

	shares_free(row);
	sum_inside(l, object, s);
	const size_t n = marks_count(s->marks, l->gaussians);
	SCOPED double *weight = mem_zalloc(n, sizeof *weight, "shares", e);
	*row = (struct shares){.index = mem_alloc(n, sizeof *row->index, "shares", e),
		.share = mem_alloc(n, sizeof *row->share, "shares", e)};
	if (!weight || !row->index || !row->share)
		return -1;
	row->n = marks_take(s->marks, l->gaussians, row->index);
	sum_weight(l, object, row->index, n, weight);
	for (size_t k = 0; k < n; k++) {
		double *inside = &s->inside[row->index[k]];
		row->share[k] = weight[k] > 0 ? (float)(*inside / (weight[k] + LEAST_WEIGHT)) : 0;
		*inside = 0;
	}
	*level = find_level(row, weight);
	return 0;
}

static int make_rows(struct lift_objects *l, double *levels, struct err *e)
{
	const size_t n = l->gaussians;
	int failed = 0;

#pragma omp parallel reduction(| : failed)
	{
		struct err mine;
		struct sums s = {mem_zalloc(n, sizeof *s.inside, "shares", &mine), marks_make(n, &mine)};
		failed = !s.inside || !s.marks;
#pragma omp for schedule(dynamic)
		for (size_t o = 0; o < l->objects; o++)
			failed = failed || make_row(l, o, &s, &levels[o], &mine);
		if (failed) {
#pragma omp critical
			*e = mine;
		}
		mem_free_all(s.inside, s.marks);
	}
	return failed ? -1 : 0;
}

/* The largest share of a Gaussian has it. */
static void claim(struct lift_objects *l)
{
	for (size_t i = 0; i < l->gaussians; i++)
		l->claims[i] = (struct lift_claim){LIFT_NOBODY, 0};
	for (size_t o = 0; o < l->objects; o++)
		for (size_t k = 0; k < l->shares[o].n; k++) {
			struct lift_claim *c = &l->claims[l->shares[o].index[k]];
			if (l->shares[o].share[k] > c->share)
				*c = (struct lift_claim){(int32_t)o, l->shares[o].share[k]};
		}
}

static float scale(float share, double level)
{
	const double scaled = (double)share / level;

	return scaled < 1 ? (float)scaled : 1;
}

/* Shares that are not their Gaussian's largest are reduced by how much they fall short of it. */
static void finish(struct lift_objects *l, const double *levels)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t o = 0; o < l->objects; o++)
		for (size_t k = 0; k < l->shares[o].n; k++) {
			const struct lift_claim c = l->claims[l->shares[o].index[k]];
			float *a = &l->shares[o].share[k];
			if (c.object != LIFT_NOBODY && c.object != (int32_t)o)
				*a *= *a / c.share;
			*a = scale(*a, levels[o]);
		}
}

int lift_shares(struct lift_objects *l, int is_last, struct err *e)
{
	SCOPED double *levels = mem_alloc(l->objects, sizeof *levels, "shares", e);
	const int bad = !levels || make_rows(l, levels, e);

	if (!bad)
		claim(l);
	if (!bad && is_last)
		finish(l, levels);
	for (size_t i = 0; i < l->gaussians && !bad && !is_last; i++)
		if (l->claims[i].object != LIFT_NOBODY)
			l->claims[i].share = scale(l->claims[i].share, levels[l->claims[i].object]);
	return bad ? -1 : 0;
}
