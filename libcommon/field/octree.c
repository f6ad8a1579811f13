#include "field/octree.h"

#include "base/mem.h"

#include <math.h>

enum { CELLS = 1 << OCTREE_LEVELS };

/* A Gaussian's place in the order of space, at the finest level. */
struct entry {
	uint64_t code;
	int32_t gaussian;
};

/* 20 bits, each followed by two zeros. */
static uint64_t spread_bits(uint64_t x)
{
	x = (x | x << 32) & 0x1f00000000ffffu;
	x = (x | x << 16) & 0x1f0000ff0000ffu;
	x = (x | x << 8) & 0x100f00f00f00f00fu;
	x = (x | x << 4) & 0x10c30c30c30c30c3u;
	return (x | x << 2) & 0x1249249249249249u;
}

/* The finest cube that holds a point; points outside the root belong to the cubes along its sides. */
static uint64_t finest_code(const struct octree *t, const float *mean)
{
	uint64_t code = 0;

	for (int k = 0; k < 3; k++) {
		double at = ((double)mean[k] - t->low[k]) / t->edge * CELLS;
		uint64_t cell = !(at > 0) ? 0 : at >= CELLS - 1 ? CELLS - 1 : (uint64_t)at;
		code |= spread_bits(cell) << k;
	}
	return code;
}

static int by_code(const void *a, const void *b)
{
	const struct entry *x = a, *y = b;

	return x->code != y->code ? (x->code > y->code) - (x->code < y->code)
				  : (x->gaussian > y->gaussian) - (x->gaussian < y->gaussian);
}

/* Weighted moments of signatures. */
struct moments {
	double weight, squares, sum[OCTREE_SIGNATURE];
};

static struct moments moments_of(const struct octree_points *p, const struct entry *entries, size_t n)
{
	struct moments m = {0};

	for (size_t i = 0; i < n; i++) {
		const double w = p->weight[entries[i].gaussian];
		const float *s = p->signature + (size_t)entries[i].gaussian * OCTREE_SIGNATURE;
		m.weight += w;
		for (int k = 0; k < OCTREE_SIGNATURE; k++) {
			m.sum[k] += w * (double)s[k];
			m.squares += w * (double)s[k] * (double)s[k];
		}
	}
	return m;
}

static void moments_add(struct moments *m, const struct moments *other)
{
	m->weight += other->weight;
	m->squares += other->squares;
	for (int k = 0; k < OCTREE_SIGNATURE; k++)
		m->sum[k] += other->sum[k];
}

/* The weighted squares that are left about the mean. */
static double moments_error(const struct moments *m)
{
	double mean = 0;

	if (!(m->weight > 0))
		return 0;
	for (int k = 0; k < OCTREE_SIGNATURE; k++)
		mean += m->sum[k] / m->weight * m->sum[k];
	return fmax(0, m->squares - mean);
}

struct builder {
	struct octree *tree;
	size_t capacity;
	const struct octree_points *points;
	double price;
	struct err *err;
};

static int add_leaf(struct builder *b, int level, uint64_t code)
{
	if (mem_grow((void **)&b->tree->codes, &b->capacity, b->tree->n + 1, sizeof *b->tree->codes, "octree",
		    b->err))
		return -1;
	b->tree->codes[b->tree->n++] = (int64_t)((uint64_t)1 << 3 * level | code);
	return 0;
}

static int is_finest(const struct builder *b, const struct entry *entries, size_t n, int level)
{
	float finest = INFINITY;

	for (size_t i = 0; i < n; i++)
		finest = fminf(finest, b->points->finest[entries[i].gaussian]);
	return n == 1 || level == OCTREE_LEVELS || ldexp(b->tree->edge, -level) <= (double)finest;
}

/* Appends the leaves of the cube of this code and level, whose points are entries: those of its parts, unless
 * one leaf is cheaper. Gives the moments of all, and the error of the leaves. */
static int add_cube(struct builder *b, const struct entry *entries, size_t n, int level, uint64_t code,
	struct moments *all, double *error)
{
	const size_t before = b->tree->n;

	if (is_finest(b, entries, n, level)) {
		*all = moments_of(b->points, entries, n);
		*error = moments_error(all);
		return add_leaf(b, level, code);
	}
	*all = (struct moments){0};
	*error = 0;
	const int shift = 3 * (OCTREE_LEVELS - level - 1);
	for (size_t begin = 0, end; begin < n; begin = end) {
		const uint64_t part = entries[begin].code >> shift;
		struct moments own;
		double own_error;
		for (end = begin + 1; end < n && entries[end].code >> shift == part; end++)
			;
		if (add_cube(b, entries + begin, end - begin, level + 1, part, &own, &own_error))
			return -1;
		moments_add(all, &own);
		*error += own_error;
	}
	const double merged = moments_error(all);
	if (merged > *error + b->price * (double)(b->tree->n - before - 1))
		return 0;
	b->tree->n = before;
	*error = merged;
	return add_leaf(b, level, code);
}

int octree_build(struct octree *t, const struct octree_points *p, double price, struct err *e)
{
	double high[3] = {-INFINITY, -INFINITY, -INFINITY};

	*t = (struct octree){.low = {INFINITY, INFINITY, INFINITY}};
	for (size_t i = 0; i < p->n; i++)
		for (int k = 0; k < 3; k++) {
			const double x = (double)p->means[3 * (size_t)p->ids[i] + (size_t)k];
			t->low[k] = fmin(t->low[k], x);
			high[k] = fmax(high[k], x);
		}
	for (int k = 0; k < 3; k++)
		t->edge = fmax(t->edge, high[k] - t->low[k]);
	if (!(t->edge > 0))
		t->edge = 1;
	SCOPED struct entry *entries = mem_alloc(p->n, sizeof *entries, "octree", e);
	if (!entries)
		return -1;
	for (size_t i = 0; i < p->n; i++)
		entries[i] = (struct entry){finest_code(t, p->means + 3 * (size_t)p->ids[i]), p->ids[i]};
	qsort(entries, p->n, sizeof *entries, by_code);
	struct builder b = {t, 0, p, price, e};
	struct moments all;
	double error;
	return p->n ? add_cube(&b, entries, p->n, 0, 0, &all, &error) : 0;
}

void octree_free(struct octree *t)
{
	free(t->codes);
	*t = (struct octree){0};
}

/* A leaf's level, and the finest cubes that it spans: first to first + count - 1. */
static int leaf_level(int64_t code)
{
	return (63 - __builtin_clzll((uint64_t)code)) / 3;
}

static uint64_t leaf_first(int64_t code)
{
	const int level = leaf_level(code);

	return ((uint64_t)code & (((uint64_t)1 << 3 * level) - 1)) << 3 * (OCTREE_LEVELS - level);
}

static uint64_t leaf_count(int64_t code)
{
	return (uint64_t)1 << 3 * (OCTREE_LEVELS - leaf_level(code));
}

int octree_check(const struct octree *t, size_t *bad)
{
	uint64_t next = 0;

	for (size_t i = 0; i < t->n; i++) {
		const int64_t code = t->codes[i];
		*bad = i;
		if (code < 1 || (63 - __builtin_clzll((uint64_t)code)) % 3 || leaf_first(code) < next)
			return -1;
		next = leaf_first(code) + leaf_count(code);
	}
	return 0;
}

int octree_find(const struct octree *t, const float *means, size_t count, int32_t *leaf, struct err *e)
{
	SCOPED uint64_t *first = mem_alloc(t->n, sizeof *first, "octree", e);

	if (!first)
		return -1;
	for (size_t i = 0; i < t->n; i++)
		first[i] = leaf_first(t->codes[i]);
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < count; i++) {
		const uint64_t code = finest_code(t, means + 3 * i);
		size_t from = 0, to = t->n; /* first[from-1] <= code < first[to] */
		while (from < to) {
			const size_t middle = from + (to - from) / 2;
			if (first[middle] <= code)
				from = middle + 1;
			else
				to = middle;
		}
		leaf[i] = from && code - first[from - 1] < leaf_count(t->codes[from - 1])
				  ? (int32_t)(from - 1)
				  : -1;
	}
	return 0;
}
