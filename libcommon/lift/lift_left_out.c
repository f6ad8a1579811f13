/* Whether masks of different views show one scene: each mask is compared with what the other views' masks
 * lifted of its object. With its own among them it would agree with itself. No picture is drawn: a mask is
 * what it shows of each Gaussian. */
#include "lift/lift_private.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/quantile.h"

#include <math.h>

/* A Gaussian is compared where other views show it with this share of the weight that the mask's view gives
 * it, and this more. */
static const double known_share = 0.05, known_least = 0.01;

struct room {
	int32_t *who; /* (count) Gaussians that any mask of the object shows, in the order in which they come
		       */
	int64_t *place;	  /* (N) where in who, or -1 */
	double *in, *all; /* (N), first count: weight within the masks, and in all of their views, by votes */
	float *own;	  /* (N), first count: of the view that is looked at */
	size_t count;
};

static const struct shares *row_of(const struct lift_view *v, size_t object, double *vote)
{
	for (size_t k = 0; k < v->n; k++)
		if (v->objects[k] == object) {
			*vote = (double)v->vote[k];
			return &v->rows[k];
		}
	return NULL;
}

static void gather(const struct lift_objects *l, size_t object, struct room *r)
{
	double vote;

	for (size_t v = 0; v < l->view_count; v++) {
		const struct shares *row = row_of(&l->views[v], object, &vote);
		for (size_t j = 0; row && j < row->n; j++) {
			int64_t *at = &r->place[row->index[j]];
			if (*at < 0) {
				*at = (int64_t)r->count;
				r->who[r->count] = row->index[j];
				r->in[r->count] = r->all[r->count] = 0;
				r->count++;
			}
			r->in[*at] += vote * (double)row->share[j];
		}
	}
	for (size_t v = 0; v < l->view_count; v++)
		if (row_of(&l->views[v], object, &vote))
			for (size_t i = 0; i < r->count; i++)
				r->all[i] += vote * (double)l->views[v].weight[r->who[i]];
}

/* The share that a Gaussian wholly of the object has, as masks are ragged. */
static double level_of(const struct room *r)
{
	double squares = 0, sum = 0;

	for (size_t i = 0; i < r->count; i++) {
		sum += r->in[i];
		squares += r->in[i] * r->in[i] / (r->all[i] + known_least);
	}
	return squares > 0 ? squares / sum : 1;
}

/* The soft intersection over union of a view's masks with what the others lifted; negative where others show
 * none of it. */
static double compare(
	const struct lift_view *v, const struct shares *row, double vote, double level, struct room *r)
{
	double both = 0, either = 0;

	memset(r->own, 0, r->count * sizeof *r->own);
	for (size_t j = 0; j < row->n; j++)
		r->own[r->place[row->index[j]]] = row->share[j];
	for (size_t i = 0; i < r->count; i++) {
		const double own = (double)r->own[i], weight = (double)v->weight[r->who[i]],
			     all = r->all[i] - vote * weight, in = r->in[i] - vote * own;
		if (!(weight > 0) || all < known_share * vote * weight + known_least)
			continue;
		const double share = in > 0 ? in / (all + known_least) / level : 0,
			     lifted = weight * (share < 1 ? share : 1);
		both += own < lifted ? own : lifted;
		either += own < lifted ? lifted : own;
	}
	return either > 0 ? both / either : -1;
}

/* Compares the masks of an object, each of which then votes by the square of how well it fits: found gets how
 * well. Returns of how many masks that is known. */
static size_t compare_all(struct lift_objects *l, size_t object, struct room *r, double *found)
{
	size_t n = 0;
	double vote;

	gather(l, object, r);
	const double level = level_of(r);
	for (size_t v = 0; v < l->view_count; v++) {
		const struct lift_view *at = &l->views[v];
		const struct shares *row = row_of(at, object, &vote);
		const double one = row ? compare(at, row, vote, level, r) : -1;
		if (one >= 0)
			at->agreement[row - at->rows] = found[n++] = one;
	}
	while (r->count)
		r->place[r->who[--r->count]] = -1;
	return n;
}

static void revote(struct lift_objects *l, size_t object)
{
	double vote;

	for (size_t v = 0; v < l->view_count; v++) {
		const struct lift_view *at = &l->views[v];
		const struct shares *row = row_of(at, object, &vote);
		if (row)
			at->vote[row - at->rows] = lift_vote(at->agreement[row - at->rows]);
	}
}

static void room_free(struct room *r)
{
	mem_free_all(r->who, r->place, r->in, r->all, r->own);
}

static int room_make(struct room *r, size_t gaussians, struct err *e)
{
	*r = (struct room){.who = mem_alloc(gaussians, sizeof *r->who, "shares", e),
		.place = mem_alloc(gaussians, sizeof *r->place, "shares", e),
		.in = mem_alloc(gaussians, sizeof *r->in, "shares", e),
		.all = mem_alloc(gaussians, sizeof *r->all, "shares", e),
		.own = mem_alloc(gaussians, sizeof *r->own, "shares", e)};
	if (!r->who || !r->place || !r->in || !r->all || !r->own)
		return -1;
	for (size_t i = 0; i < gaussians; i++)
		r->place[i] = -1;
	return 0;
}

/* found (views): of how many masks of the object it is known how well they fit is returned. */
static size_t compare_object(struct lift_objects *l, size_t object, struct room *r, double *found)
{
	for (int round = l->round; round < LIFT_ROUNDS; round++) {
		compare_all(l, object, r, found);
		revote(l, object);
	}
	return compare_all(l, object, r, found);
}

int lift_left_out(struct lift_objects *l, size_t named, double *agreement, size_t *masks, struct err *e)
{
	SCOPED double *found = mem_alloc(named, l->view_count * sizeof *found, "shares", e);
	SCOPED size_t *counts = mem_zalloc(named, sizeof *counts, "shares", e);
	size_t n = 0;
	int failed = 0;

#pragma omp parallel reduction(| : failed)
	{
		SCOPED_BY(room_free) struct room r = {0};
		struct err mine;
		failed = !found || !counts || room_make(&r, l->gaussians, &mine);
#pragma omp for schedule(dynamic)
		for (size_t o = 0; o < named; o++)
			if (!failed)
				counts[o] = compare_object(l, o, &r, found + o * l->view_count);
		if (failed && found && counts) {
#pragma omp critical
			*e = mine;
		}
	}
	for (size_t o = 0; o < named && !failed; o++) {
		memmove(found + n, found + o * l->view_count, counts[o] * sizeof *found);
		n += counts[o];
	}
	if (n)
		qsort(found, n, sizeof *found, compare_double);
	*masks = n;
	*agreement = n >= LIFT_LEFT_OUT_MASKS ? quantile_sorted(found, n, 0.5) : NAN;
	return failed ? -1 : 0;
}
