#include "lift/inside.h"

#include "base/mem.h"
#include "base/quantile.h"
#include "geom/neighbours.h"

#include <math.h>

/* So many times as large as the hull is where others are looked for that are nearer. */
static const double around = 1.5;
static const double golden_angle = 2.39996322972865332;

struct hull {
	double direction[INSIDE_DIRECTIONS][3], middle[INSIDE_DIRECTIONS];
	double length[INSIDE_DIRECTIONS]; /* from the middle */
};

static double along(const double d[3], const float *p)
{
	return d[0] * (double)p[0] + d[1] * (double)p[1] + d[2] * (double)p[2];
}

/* Both ways along the axes of the thing's box, its foot's among them, then on a spiral from pole to pole. */
static void choose_direction(double d[3], int k, const struct box *b)
{
	const int at = k - 6, spiral = INSIDE_DIRECTIONS - 6;

	for (int c = 0; c < 3 && at < 0; c++)
		d[c] = (k % 2 ? -1 : 1) * b->axes[k / 2][c];
	if (at < 0)
		return;
	d[2] = 1 - (2 * at + 1.0) / spiral;
	d[0] = sqrt(1 - d[2] * d[2]) * cos(at * golden_angle);
	d[1] = sqrt(1 - d[2] * d[2]) * sin(at * golden_angle);
}

/* items: room for all of x. */
static void make_hull(
	struct hull *h, const struct extent *x, const struct splats *s, struct quantile_item *items)
{
	const double *c = x->turned.centre;

	for (int k = 0; k < INSIDE_DIRECTIONS; k++) {
		double *d = h->direction[k];
		choose_direction(d, k, &x->turned);
		for (size_t i = 0; i < x->n; i++)
			items[i] = (struct quantile_item){along(d, s->means + 3 * (size_t)x->ids[i]), 1};
		h->middle[k] = d[0] * c[0] + d[1] * c[1] + d[2] * c[2];
		h->length[k] = fmax(quantile_weighted(items, x->n, 1 - INSIDE_TRIM) - h->middle[k], 0);
	}
}

/* Whether p is in the hull, so many times as large. */
static int has(const struct hull *h, const float *p, double times)
{
	for (int k = 0; k < INSIDE_DIRECTIONS; k++)
		if (along(h->direction[k], p) - h->middle[k] > times * h->length[k])
			return 0;
	return 1;
}

enum { OWN, OTHERS, UNSURE, SIDES };

/* Around the hull: the points of each side, and which Gaussians are unsure. */
struct near {
	size_t n[SIDES];
	float *points[SIDES]; /* (n,3) */
	size_t *unsure;
	float *own, *others; /* (unsure) how far the nearest are */
};

static int gather(struct near *r, const struct hull *h, const char *taken, const struct splats *s,
	const float *most, const char *others, struct err *e)
{
	SCOPED char *side = mem_alloc(s->n, 1, "object", e);
	int bad = !side;

	if (bad)
		return -1;
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < s->n; i++) {
		const int is_known = taken[i] || most[i] > INSIDE_SHOWN || (others && others[i]);
		const int is_in = has(h, s->means + 3 * i, is_known ? around : INSIDE_REACH);
		side[i] = (char)(!is_in ? SIDES : taken[i] ? OWN : is_known ? OTHERS : UNSURE);
	}
	for (size_t i = 0; i < s->n; i++)
		if (side[i] != SIDES)
			r->n[(int)side[i]]++;
	for (int k = 0; k < SIDES; k++) {
		bad |= !(r->points[k] = mem_alloc(r->n[k], 3 * sizeof(float), "object", e));
		bad |= k == UNSURE && !(r->unsure = mem_alloc(r->n[k], sizeof *r->unsure, "object", e));
		r->n[k] = 0;
	}
	for (size_t i = 0; i < s->n && !bad; i++) {
		if (side[i] == SIDES)
			continue;
		const size_t at = r->n[(int)side[i]]++;
		memcpy(r->points[(int)side[i]] + 3 * at, s->means + 3 * i, 3 * sizeof(float));
		if (side[i] == UNSURE)
			r->unsure[at] = i;
	}
	return bad ? -1 : 0;
}

static int vote(char *taken, struct near *r, struct err *e)
{
	const size_t n = r->n[UNSURE];

	r->own = mem_alloc(n, sizeof *r->own, "object", e);
	r->others = mem_alloc(n, sizeof *r->others, "object", e);
	if (!r->own || !r->others ||
		neighbours_of(r->points[OWN], r->n[OWN], r->points[UNSURE], n, INSIDE_VOTERS, r->own, e) ||
		neighbours_of(
			r->points[OTHERS], r->n[OTHERS], r->points[UNSURE], n, INSIDE_VOTERS, r->others, e))
		return -1;
	for (size_t i = 0; i < n; i++)
		if (r->own[i] < r->others[i])
			taken[r->unsure[i]] = 1;
	return 0;
}

int inside_take(char *taken, const struct extent *x, const struct splats *s, const float *most,
	const char *others, struct err *e)
{
	SCOPED struct quantile_item *items = NULL;
	struct near r = {0};
	struct hull h;

	if (!x->n)
		return 0;
	if (!(items = mem_alloc(x->n, sizeof *items, "object", e)))
		return -1;
	make_hull(&h, x, s, items);
	const int bad = gather(&r, &h, taken, s, most, others, e) || vote(taken, &r, e);
	for (int k = 0; k < SIDES; k++)
		free(r.points[k]);
	mem_free_all(r.unsure, r.own, r.others);
	return bad ? -1 : 0;
}
