#include "base/mem.h"
#include "lift/regions.h"
#include "lift/regions_private.h"

#include <stdlib.h>
#include <string.h>

/* Chosen on one real and three synthetic scenes, and not searched over. */
#define JOINS 0.4		    /* agreement from which a candidate joins a region */
#define SEEN 0.05		    /* pixels of weight from which a view says what a Gaussian is */
#define EXPLAINED 0.6		    /* agreement from which a candidate is of a region that there is */
#define SAME 0.75		    /* overlap from which two regions are one */
enum { STEPS = 3, SEED_VIEWS = 4 }; /* of each object, spread over its views */

/* A region in the making. */
struct growth {
	uint8_t *is_in;	  /* (N) */
	uint8_t *is_seen; /* (N) */
	float *sum, *all; /* (N) of the weight in the masks that joined, and of all in their views */
	double *area;	  /* (views) the region's */
	size_t *before;	  /* (views) */
	struct region region;
};

static void growth_free(struct growth *g)
{
	free(g->is_in);
	free(g->is_seen);
	free(g->sum);
	free(g->all);
	free(g->area);
	free(g->before);
	free(g->region.members);
	free(g->region.agreement);
	free(g->region.chosen);
}

static int growth_make(struct growth *g, const struct regions *r, struct err *e)
{
	const size_t n = r->gaussians;

	*g = (struct growth){mem_alloc(n, 1, "regions", e), mem_alloc(n, 1, "regions", e),
		mem_alloc(n, sizeof *g->sum, "regions", e), mem_alloc(n, sizeof *g->all, "regions", e),
		mem_alloc(r->views, sizeof *g->area, "regions", e),
		mem_alloc(r->views, sizeof *g->before, "regions", e),
		{.members = mem_alloc(n, sizeof *g->region.members, "regions", e),
			.agreement = mem_alloc(r->count, sizeof *g->region.agreement, "regions", e),
			.chosen = mem_alloc(r->views, sizeof *g->region.chosen, "regions", e)}};
	if (g->is_in && g->is_seen && g->sum && g->all && g->area && g->before && g->region.members &&
		g->region.agreement && g->region.chosen)
		return 0;
	growth_free(g);
	return -1;
}

static void list_members(struct growth *g, const struct regions *r)
{
	g->region.n = 0;
	for (size_t i = 0; i < r->gaussians; i++)
		if (g->is_in[i])
			g->region.members[g->region.n++] = (int32_t)i;
}

/* Of the region with every candidate. By a view that has not seen all, only what it saw counts, and only
 * where that is at least half of the candidate. */
static void find_agreement(struct growth *g, const struct regions *r, const uint8_t *is_seen)
{
#pragma omp parallel for schedule(static)
	for (size_t v = 0; v < r->views; v++) {
		const float *weight = r->weight + v * r->gaussians;
		double area = 0;
		for (size_t k = 0; k < g->region.n; k++)
			area += (double)weight[g->region.members[k]];
		g->area[v] = area;
	}
#pragma omp parallel for schedule(static, 16)
	for (size_t c = 0; c < r->count; c++) {
		const struct regions_candidate *at = &r->candidates[c];
		double both = 0, mass = is_seen ? 0 : at->mass;
		for (size_t k = at->begin; k < at->end; k++)
			both += g->is_in[r->index[k]] ? (double)r->share[k] : 0;
		for (size_t k = at->begin; k < at->end && is_seen; k++)
			mass += is_seen[r->index[k]] ? (double)r->share[k] : 0;
		const int is_told = both > 0 && mass >= at->mass / 2;
		g->region.agreement[c] = is_told ? (float)(both / (g->area[at->view] + mass - both)) : 0;
	}
}

static void choose(struct growth *g, const struct regions *r)
{
	const float *agreement = g->region.agreement;
	size_t *chosen = g->region.chosen;

	for (size_t v = 0; v < r->views; v++)
		chosen[v] = REGIONS_NONE;
	for (size_t c = 0; c < r->count; c++) {
		size_t *best = &chosen[r->candidates[c].view];
		if (agreement[c] > (float)JOINS && (*best == REGIONS_NONE || agreement[c] > agreement[*best]))
			*best = c;
	}
}

void regions_sum(const struct regions *r, const size_t *chosen, float *sum, float *all)
{
	memset(sum, 0, r->gaussians * sizeof *sum);
	memset(all, 0, r->gaussians * sizeof *all);
	for (size_t v = 0; v < r->views; v++) {
		const float *weight = r->weight + v * r->gaussians;
		if (chosen[v] == REGIONS_NONE)
			continue;
		const struct regions_candidate *c = &r->candidates[chosen[v]];
		for (size_t k = c->begin; k < c->end; k++)
			sum[r->index[k]] += r->share[k];
#pragma omp parallel for schedule(static)
		for (size_t i = 0; i < r->gaussians; i++)
			all[i] += weight[i];
	}
}

/* What a view shows of a candidate, and the candidates that agree with it. */
static void begin(struct growth *g, const struct regions *r, size_t seed)
{
	const struct regions_candidate *c = &r->candidates[seed];
	const float *weight = r->weight + c->view * r->gaussians;

	memset(g->is_in, 0, r->gaussians);
	for (size_t i = 0; i < r->gaussians; i++)
		g->is_seen[i] = weight[i] > (float)SEEN;
	for (size_t k = c->begin; k < c->end; k++) {
		const int32_t i = r->index[k];
		g->is_in[i] = g->is_seen[i] && r->share[k] > weight[i] / 2;
	}
	list_members(g, r);
	find_agreement(g, r, g->is_seen);
	choose(g, r);
	g->region.chosen[c->view] = seed;
}

static int order_reals(const void *a, const void *b)
{
	const double p = *(const double *)a, q = *(const double *)b;

	return (p > q) - (p < q);
}

/* 1 where a region came of it. */
static int grow(struct growth *g, const struct regions *r, size_t seed)
{
	size_t n = 0;

	begin(g, r, seed);
	for (int step = 0; step < STEPS && g->region.n; step++) {
		memcpy(g->before, g->region.chosen, r->views * sizeof *g->before);
		regions_sum(r, g->region.chosen, g->sum, g->all);
		for (size_t i = 0; i < r->gaussians; i++)
			g->is_in[i] = g->sum[i] > g->all[i] / 2;
		list_members(g, r);
		find_agreement(g, r, NULL);
		choose(g, r);
		if (!memcmp(g->before, g->region.chosen, r->views * sizeof *g->before))
			break;
	}
	for (size_t v = 0; v < r->views && g->region.n; v++)
		if (g->region.chosen[v] != REGIONS_NONE)
			g->area[n++] = (double)g->region.agreement[g->region.chosen[v]];
	if (!n)
		return 0;
	qsort(g->area, n, sizeof *g->area, order_reals);
	g->region.typical = g->area[n / 2];
	return 1;
}

/* Whether the region is another's, by the weight that its Gaussians have in all views: total (N). */
static int is_known(const struct growth *g, const struct regions *r, const double *total)
{
	double mine = 0;

	for (size_t k = 0; k < g->region.n; k++)
		mine += total[g->region.members[k]];
	for (size_t i = 0; i < r->region_count; i++) {
		const struct region *other = &r->regions[i];
		double theirs = 0, both = 0;
		for (size_t k = 0; k < other->n; k++) {
			const int32_t at = other->members[k];
			theirs += total[at];
			both += g->is_in[at] ? total[at] : 0;
		}
		if (both > SAME * (mine + theirs - both))
			return 1;
	}
	return 0;
}

static void *copy(const void *from, size_t n, size_t size, struct err *e)
{
	void *to = mem_alloc(n, size, "regions", e);

	if (to)
		memcpy(to, from, n * size);
	return to;
}

static int keep(struct regions *r, const struct region *from, float *explained, struct err *e)
{
	if (mem_grow((void **)&r->regions, &r->region_capacity, r->region_count + 1, sizeof *r->regions,
		    "regions", e))
		return -1;
	struct region *to = &r->regions[r->region_count++];
	*to = *from;
	to->members = copy(from->members, from->n, sizeof *to->members, e);
	to->agreement = copy(from->agreement, r->count, sizeof *to->agreement, e);
	to->chosen = copy(from->chosen, r->views, sizeof *to->chosen, e);
	for (size_t c = 0; c < r->count; c++)
		if (from->agreement[c] > explained[c])
			explained[c] = from->agreement[c];
	return to->members && to->agreement && to->chosen ? 0 : -1;
}

/* Views of an object that its regions are grown from: is_seed (count) gets 1 for its candidates there. */
static void mark_seeds(const struct regions *r, size_t object, size_t *views, uint8_t *is_seed)
{
	size_t n = 0;

	for (size_t c = 0; c < r->count; c++) {
		const struct regions_candidate *at = &r->candidates[c];
		if (at->object == object && at->end > at->begin && (!n || views[n - 1] != at->view))
			views[n++] = at->view;
	}
	for (size_t k = 0; k < SEED_VIEWS && n; k++) {
		const size_t view = views[k * (n - 1) / (SEED_VIEWS - 1)];
		for (size_t c = 0; c < r->count; c++)
			if (r->candidates[c].object == object && r->candidates[c].view == view &&
				r->candidates[c].end > r->candidates[c].begin)
				is_seed[c] = 1;
	}
}

static int grow_all(struct regions *r, struct growth *g, float *explained, uint8_t *is_seed,
	const double *total, struct err *e)
{
	for (size_t object = 0; object < r->object_count; object++) {
		memset(is_seed, 0, r->count);
		mark_seeds(r, object, g->before, is_seed);
		for (size_t c = 0; c < r->count; c++)
			if (is_seed[c] && explained[c] < (float)EXPLAINED && grow(g, r, c) &&
				!is_known(g, r, total) && keep(r, &g->region, explained, e))
				return -1;
	}
	return 0;
}

int regions_grow(struct regions *r, struct err *e)
{
	struct growth g;
	float *explained = mem_zalloc(r->count, sizeof *explained, "regions", e);
	uint8_t *is_seed = mem_alloc(r->count, 1, "regions", e);
	double *total = mem_zalloc(r->gaussians, sizeof *total, "regions", e);
	int bad = !explained || !is_seed || !total || growth_make(&g, r, e);

	for (size_t v = 0; v < r->views && !bad; v++)
		for (size_t i = 0; i < r->gaussians; i++)
			total[i] += (double)r->weight[v * r->gaussians + i];
	if (!bad) {
		bad = grow_all(r, &g, explained, is_seed, total, e);
		growth_free(&g);
	}
	free(explained);
	free(is_seed);
	free(total);
	return bad ? -1 : 0;
}
