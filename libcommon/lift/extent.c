#include "lift/extent.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/quantile.h"
#include "geom/rotation.h"
#include "geom/vector.h"

#include <float.h>
#include <math.h>

enum {
	TURNS = 45,	  /* of two degrees: the foot of a box is the same after ninety */
	LOOKED_AT = 4096, /* Gaussians at most while turns are compared */
	CELL_BITS = 21,	  /* of a cell's place along an axis */
	NEIGHBOURS = 13	  /* of 26: the others have this cell as theirs */
};

/* The object's Gaussians, and room for what is made of them. */
struct cloud {
	size_t n;
	double *means;	/* (n,3) */
	double *spread; /* (n,3,3) rows: the Gaussian's axes, as long as its standard deviations */
	double *weight;
	struct quantile_item *items; /* (3 n) */
};

/* Where a box begins whose far end is at the other tail. */
static double dense_end(struct quantile_item *items, struct quantile_item *other, size_t n)
{
	double total = 0, out = 0, beyond = 0, most = -INFINITY, end = 0;
	size_t far = n;

	quantile_order(items, other, n);
	for (size_t i = 0; i < n; i++)
		total += items[i].weight;
	while (far && beyond <= EXTENT_TAIL * total)
		beyond += items[--far].weight;
	for (size_t i = 0; i < n && out <= EXTENT_TAIL * total; out += items[i++].weight) {
		if (out + items[i].weight <= EXTENT_TRIM * total)
			continue;
		const double length = fmax(items[far].at - items[i].at, DBL_MIN);
		const double dense = log(1 - out / total) - EXTENT_THIN * log(length);
		if (dense > most) {
			most = dense;
			end = items[i].at;
		}
	}
	return end;
}

/* Both ends of the cloud in direction d: where it gets thin. */
static void reach(const struct cloud *c, const double d[3], double *low, double *high)
{
	struct quantile_item *up = c->items, *down = up + c->n, *other = down + c->n;

	for (size_t i = 0; i < c->n; i++) {
		const double *m = c->means + 3 * i, *s = c->spread + 9 * i;
		double variance = 0;
		for (int k = 0; k < 3; k++) {
			double along = s[3 * k] * d[0] + s[3 * k + 1] * d[1] + s[3 * k + 2] * d[2];
			variance += along * along;
		}
		const double middle = m[0] * d[0] + m[1] * d[1] + m[2] * d[2],
			     long_as = EXTENT_SIGMAS * sqrt(variance);
		up[i] = (struct quantile_item){-(middle + long_as), c->weight[i]};
		down[i] = (struct quantile_item){-(-middle + long_as), c->weight[i]};
	}
	*high = -dense_end(up, other, c->n);
	*low = dense_end(down, other, c->n);
}

/* The box along these axes. */
static struct box box_along(const struct cloud *c, const double axes[3][3])
{
	struct box b = {0};

	memcpy(b.axes, axes, sizeof b.axes);
	for (int k = 0; k < 3; k++) {
		double low, high;
		reach(c, axes[k], &low, &high);
		b.half[k] = fmax(high - low, 0) / 2;
		for (int d = 0; d < 3; d++)
			b.centre[d] += (high + low) / 2 * axes[k][d];
	}
	return b;
}

/* Axes with the third up and the first turned by `angle` from the world's axis that is the most level. */
static void axes_at(const double up[3], double angle, double axes[3][3])
{
	double level[3] = {0}, other[3];
	int k = fabs(up[1]) < fabs(up[0]) - 1e-9 ? 1 : 0;

	k = fabs(up[2]) < fabs(up[k]) - 1e-9 ? 2 : k;
	for (int d = 0; d < 3; d++)
		level[d] = (d == k) - up[k] * up[d];
	vector_normalise(level);
	vector_cross(up, level, other);
	for (int d = 0; d < 3; d++) {
		axes[0][d] = cos(angle) * level[d] + sin(angle) * other[d];
		axes[1][d] = cos(angle) * other[d] - sin(angle) * level[d];
		axes[2][d] = up[d];
	}
}

/* Of every so many Gaussians: what turns are compared by. */
struct sample {
	size_t n;
	double at[12][LOOKED_AT]; /* mean, and the rows of spread */
	double weight[LOOKED_AT], trimmed;
	double middle[LOOKED_AT], long_as[LOOKED_AT]; /* along a direction */
	struct quantile_item items[LOOKED_AT];
};

static void take_sample(struct sample *s, const struct cloud *c)
{
	const size_t step = 1 + (c->n - 1) / LOOKED_AT;

	s->trimmed = 0;
	for (size_t i = s->n = 0; i < c->n; i += step, s->n++) {
		for (size_t k = 0; k < 12; k++)
			s->at[k][s->n] = k < 3 ? c->means[3 * i + k] : c->spread[9 * i + k - 3];
		s->weight[s->n] = c->weight[i];
		s->trimmed += EXTENT_TRIM * c->weight[i];
	}
}

#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
measure(struct sample *s, double x, double y, double z)
{
	for (size_t i = 0; i < s->n; i++) {
		double variance = 0;
		for (int k = 3; k < 12; k += 3) {
			const double along = s->at[k][i] * x + s->at[k + 1][i] * y + s->at[k + 2][i] * z;
			variance += along * along;
		}
		s->middle[i] = s->at[0][i] * x + s->at[1][i] * y + s->at[2][i] * z;
		s->long_as[i] = EXTENT_SIGMAS * sqrt(variance);
	}
}

/* The greatest along the direction, or against it, that is not trimmed, turned round. It is looked for up to
 * somewhat above that of a direction near this one, `near`; where that is too little, farther up. */
static double end_along(struct sample *s, double sign, double near, double slack)
{
	for (;; slack = slack > 0 ? 4 * slack : INFINITY) {
		double sum = 0;
		size_t n = 0;
		for (size_t i = 0; i < s->n; i++) {
			const double at = -(sign * s->middle[i] + s->long_as[i]);
			if (at > near + slack)
				continue;
			sum += s->weight[i];
			s->items[n++] = (struct quantile_item){at, s->weight[i]};
		}
		if (sum > s->trimmed || n == s->n)
			return quantile_passed(s->items, n, s->trimmed);
	}
}

/* Half the length along d; `ends` are of a direction near this one, and then of this. */
static double half_along(struct sample *s, const double d[3], double ends[2])
{
	const double slack = (-ends[0] - ends[1]) / TURNS;

	measure(s, d[0], d[1], d[2]);
	for (int side = 0; side < 2; side++)
		ends[side] = end_along(s, side ? -1 : 1, ends[side], slack);
	return fmax(-ends[0] - ends[1], 0) / 2;
}

static struct box turned_box(const struct cloud *c, struct sample *s, const double up[3])
{
	double axes[3][3], ends[2][2] = {{INFINITY, INFINITY}, {INFINITY, INFINITY}};
	double least = INFINITY, level = 0, angle = 0;

	take_sample(s, c);
	for (int i = 0; i < TURNS; i++) {
		axes_at(up, i * PI / 2 / TURNS, axes);
		const double foot = half_along(s, axes[0], ends[0]) * half_along(s, axes[1], ends[1]);
		if (!i)
			level = foot;
		if (foot < least) {
			least = foot;
			angle = i * PI / 2 / TURNS;
		}
	}
	axes_at(up, least < (1 - EXTENT_GAIN) * level ? angle : 0, axes);
	return box_along(c, axes);
}

struct cell {
	uint64_t key;
	size_t gaussian; /* in the cloud */
};

static int by_key(const void *a, const void *b)
{
	const struct cell *x = a, *y = b;

	return x->key != y->key ? COMPARE(x->key, y->key) : COMPARE(x->gaussian, y->gaussian);
}

static size_t root(size_t *parent, size_t i)
{
	while (parent[i] != i) {
		parent[i] = parent[parent[i]];
		i = parent[i];
	}
	return i;
}

/* The side of a cell: 0 where all Gaussians are in one place. */
static double cell_side(const struct cloud *c, double low[3])
{
	double square = 0, even = 1.8; /* from the middle half, which strays do not stretch, to nine tenths */

	for (int k = 0; k < 3; k++) {
		for (size_t i = 0; i < c->n; i++)
			c->items[i] = (struct quantile_item){c->means[3 * i + (size_t)k], c->weight[i]};
		const double from = quantile_weighted(c->items, c->n, 0.25),
			     to = quantile_weighted(c->items, c->n, 0.75);
		square += even * even * (to - from) * (to - from);
		low[k] = from;
	}
	return EXTENT_SPACING * sqrt(square / (double)c->n);
}

/* Cells, sorted, with places along the axes that leave room for neighbours. */
static void make_cells(const struct cloud *c, struct cell *cells, double side, const double low[3])
{
	const double most = (double)((uint64_t)1 << CELL_BITS) - 2, middle = floor(most / 2);

	for (size_t i = 0; i < c->n; i++) {
		cells[i] = (struct cell){0, i};
		for (int k = 0; k < 3; k++) {
			double at = floor((c->means[3 * i + (size_t)k] - low[k]) / side) + middle;
			cells[i].key = cells[i].key << CELL_BITS | (uint64_t)fmin(fmax(at, 1), most);
		}
	}
	qsort(cells, c->n, sizeof *cells, by_key);
}

/* The first of the cells with that key, or n. */
static size_t find_cell(const struct cell *cells, size_t n, uint64_t key)
{
	size_t low = 0, high = n;

	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (cells[middle].key < key)
			low = middle + 1;
		else
			high = middle;
	}
	return low < n && cells[low].key == key ? low : n;
}

/* Joins each cell's Gaussians, and those of cells that touch. parent (n) is by place in `cells`. */
static void join_cells(const struct cell *cells, size_t n, size_t *parent)
{
	uint64_t steps[NEIGHBOURS];
	int count = 0;

	for (int x = -1; x <= 1; x++)
		for (int y = -1; y <= 1; y++)
			for (int z = -1; z <= 1; z++) {
				const int64_t step = ((int64_t)x * ((int64_t)1 << CELL_BITS) + y) *
							     ((int64_t)1 << CELL_BITS) +
						     z;
				if (step > 0)
					steps[count++] = (uint64_t)step;
			}
	for (size_t i = 0; i < n; i++)
		parent[i] = i && cells[i].key == cells[i - 1].key ? parent[i - 1] : i;
	for (size_t i = 0; i < n; i++) {
		if (i && cells[i].key == cells[i - 1].key)
			continue;
		for (int k = 0; k < count; k++) {
			const size_t j = find_cell(cells, n, cells[i].key + steps[k]);
			if (j == n)
				continue;
			const size_t a = root(parent, i), b = root(parent, j);
			parent[a > b ? a : b] = a > b ? b : a;
		}
	}
}

/* kept (n) gets 1 for what is no stray. */
static int find_strays(const struct cloud *c, char *kept, struct err *e)
{
	double low[3], best = 0;
	const double side = cell_side(c, low);

	memset(kept, 1, c->n);
	if (!(side > 0))
		return 0;
	SCOPED struct cell *cells = mem_alloc(c->n, sizeof *cells, "cells", e);
	SCOPED size_t *parent = mem_alloc(c->n, sizeof *parent, "cells", e);
	SCOPED double *sums = mem_zalloc(c->n, sizeof *sums, "cells", e);
	int bad = !cells || !parent || !sums ? -1 : 0;
	if (!bad) {
		make_cells(c, cells, side, low);
		join_cells(cells, c->n, parent);
		for (size_t i = 0; i < c->n; i++) {
			double *sum = &sums[root(parent, i)];
			*sum += c->weight[cells[i].gaussian];
			best = fmax(best, *sum);
		}
		for (size_t i = 0; i < c->n; i++)
			kept[cells[i].gaussian] = sums[root(parent, i)] >= EXTENT_PART * best;
	}
	return bad;
}

/* Leaves out what is not kept, of the cloud and of the ids. */
static void keep(struct cloud *c, int32_t *ids, const char *kept)
{
	size_t n = 0;

	for (size_t i = 0; i < c->n; i++) {
		if (!kept[i])
			continue;
		memmove(c->means + 3 * n, c->means + 3 * i, 3 * sizeof *c->means);
		memmove(c->spread + 9 * n, c->spread + 9 * i, 9 * sizeof *c->spread);
		c->weight[n] = c->weight[i];
		ids[n++] = ids[i];
	}
	c->n = n;
}

static void fill(struct cloud *c, const struct splats *s, const int32_t *ids, const float *responses)
{
	for (size_t i = 0; i < c->n; i++) {
		const size_t g = (size_t)ids[i];
		double q[4], m[3][3];
		for (int k = 0; k < 4; k++)
			q[k] = s->quats[4 * g + (size_t)k];
		rotation_of_quat(q, m);
		for (int k = 0; k < 3; k++) {
			c->means[3 * i + (size_t)k] = s->means[3 * g + (size_t)k];
			for (int d = 0; d < 3; d++)
				c->spread[9 * i + (size_t)(3 * k + d)] =
					m[d][k] * (double)s->scales[3 * g + (size_t)k];
		}
		c->items[i] = (struct quantile_item){responses[i], 1};
	}
	const double median = quantile_weighted(c->items, c->n, 0.5);
	for (size_t i = 0; i < c->n; i++)
		c->weight[i] = pow(fmin(responses[i] / median, 1), 4);
}

int extent_find(struct extent *x, const struct splats *s, const int32_t *ids, const float *responses,
	size_t n, const double up[3], struct err *e)
{
	static const double world[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
	const size_t room = n + 1; /* so that none has room too */
	struct cloud c = {n, mem_alloc(room, 3 * sizeof(double), "object", e),
		mem_alloc(room, 9 * sizeof(double), "object", e),
		mem_alloc(room, sizeof(double), "object", e),
		mem_alloc(room, 3 * sizeof(struct quantile_item), "object", e)};
	SCOPED char *kept = mem_alloc(room, 1, "object", e);
	SCOPED struct sample *sample = mem_alloc(1, sizeof *sample, "object", e);

	*x = (struct extent){.ids = mem_alloc(room, sizeof *ids, "object", e), .weight = c.weight};
	int bad = !c.means || !c.spread || !c.weight || !c.items || !kept || !sample || !x->ids ? -1 : 0;
	if (!bad && n) {
		memcpy(x->ids, ids, n * sizeof *ids);
		fill(&c, s, ids, responses);
		bad = find_strays(&c, kept, e);
	}
	if (!bad && n) {
		keep(&c, x->ids, kept);
		x->n = c.n;
		x->aligned = box_along(&c, world);
		x->turned = turned_box(&c, sample, up);
	}
	mem_free_all(c.means, c.spread, c.items);
	if (bad)
		extent_free(x);
	return bad;
}

double extent_part(const struct splats *s, size_t gaussian)
{
	const float *r = s->scales + 3 * gaussian;
	const double area = (double)r[0] * r[1] + (double)r[1] * r[2] + (double)r[2] * r[0];

	return isfinite(area) ? area * s->opacities[gaussian] : 0;
}

void extent_free(struct extent *x)
{
	mem_free_all(x->ids, x->weight);
	*x = (struct extent){0};
}
