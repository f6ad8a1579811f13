#include "base/mem.h"
#include "base/compare.h"
#include "lift/regions.h"
#include "lift/regions_private.h"

/* Chosen on one real and three synthetic scenes, and not searched over. */
#define SEEN 0.05		    /* pixels of weight from which a view says what a Gaussian is */
#define EXPLAINED 0.6		    /* agreement from which a candidate is of a region that there is */
#define SAME 0.75		    /* overlap from which two regions are one */
enum { STEPS = 3, SEED_VIEWS = 4 }; /* of each object, spread over how much they show */

/* A region in the making. */
struct growth {
	uint8_t *is_in; /* (N) */
	struct regions_shown shown;
	struct regions_sums sums;
	double *both;	   /* (count) what candidates have of the region */
	double *area;	   /* (views) the region's */
	size_t *before;	   /* (views) */
	uint8_t *is_tried; /* (count) candidates that regions grew from */
	/* of the view that the last seed is of, or REGIONS_NONE */
	size_t seen_view;
	double *seen_mass; /* (count) of candidates, over the Gaussians that the view sees; -1 where it was
			      not asked for */
	struct region region;
};

static void growth_free(struct growth *g)
{
	free(g->is_in);
	regions_shown_free(&g->shown);
	regions_sums_free(&g->sums);
	mem_free_all(g->both, g->area, g->before, g->is_tried, g->seen_mass, g->region.members,
		g->region.agreement, g->region.chosen);
}

static int growth_make(struct growth *g, const struct regions *r, struct err *e)
{
	const size_t n = r->gaussians;

	*g = (struct growth){.is_in = mem_zalloc(n, 1, "regions", e),
		.both = mem_alloc(r->count, sizeof *g->both, "regions", e),
		.area = mem_alloc(r->views, sizeof *g->area, "regions", e),
		.before = mem_alloc(r->views, sizeof *g->before, "regions", e),
		.is_tried = mem_zalloc(r->count, 1, "regions", e),
		.seen_view = REGIONS_NONE,
		.seen_mass = mem_alloc(r->count, sizeof *g->seen_mass, "regions", e),
		.region = {.members = mem_alloc(n, sizeof *g->region.members, "regions", e),
			.agreement = mem_alloc(r->count, sizeof *g->region.agreement, "regions", e),
			.chosen = mem_alloc(r->views, sizeof *g->region.chosen, "regions", e)}};
	if (g->is_in && g->both && g->area && g->before && g->is_tried && g->seen_mass && g->region.members &&
		g->region.agreement && g->region.chosen && !regions_sums_make(&g->sums, n, e) &&
		!regions_shown_make(&g->shown, r, e))
		return 0;
	growth_free(g);
	return -1;
}

static void clear(struct growth *g)
{
	for (size_t k = 0; k < g->region.n; k++)
		g->is_in[g->region.members[k]] = 0;
	g->region.n = 0;
}

static void add(struct growth *g, int32_t gaussian)
{
	g->is_in[gaussian] = 1;
	g->region.members[g->region.n++] = gaussian;
}

/* Of a candidate, what a view sees. */
static double seen_mass(const struct regions *r, size_t view, const struct shares *s)
{
	const struct seen *seen = &r->seen[view];
	double mass = 0;

	for (size_t k = 0; k < s->n; k++)
		mass += seen_weight(seen, (size_t)s->index[k]) > (float)SEEN ? (double)s->share[k] : 0;
	return mass;
}

static void look_from(struct growth *g, const struct regions *r, size_t view)
{
	for (size_t c = 0; c < r->count && g->seen_view != view; c++)
		g->seen_mass[c] = -1;
	g->seen_view = view;
}

/* Of a candidate with the region. Its part of the region alone may keep it below what matters. */
static float agree(const struct growth *g, const struct regions *r, size_t c, int is_partly_seen)
{
	const struct regions_candidate *at = &r->candidates[c];
	const double area = g->area[at->view], both = g->both[c];
	double mass = at->mass;

	if (!(both > 0) || both < REGIONS_MATTERS * area)
		return 0;
	if (is_partly_seen) {
		if (g->seen_mass[c] < 0)
			g->seen_mass[c] = seen_mass(r, g->seen_view, &at->shares);
		mass = g->seen_mass[c];
	}
	return mass >= at->mass / 2 ? (float)(both / (area + mass - both)) : 0;
}

/* Of the region with every candidate. By a view that has not seen all, only what it saw counts, and only
 * where that is at least half of the candidate. */
static void find_agreement(struct growth *g, const struct regions *r, int is_partly_seen)
{
#pragma omp parallel for schedule(static)
	for (size_t v = 0; v < r->views; v++) {
		const struct seen *seen = &r->seen[v];
		double area = 0;
		for (size_t k = 0; k < g->region.n && seen->marks; k++)
			area += (double)seen_weight(seen, (size_t)g->region.members[k]);
		g->area[v] = area;
	}
	regions_overlap(&g->shown, r->count, g->region.members, g->region.n, g->both);
#pragma omp parallel for schedule(dynamic, 64)
	for (size_t c = 0; c < r->count; c++)
		g->region.agreement[c] = agree(g, r, c, is_partly_seen);
}

static void choose(struct growth *g, const struct regions *r)
{
	const float *agreement = g->region.agreement;
	size_t *chosen = g->region.chosen;

	for (size_t v = 0; v < r->views; v++)
		chosen[v] = REGIONS_NONE;
	for (size_t c = 0; c < r->count; c++) {
		size_t *best = &chosen[r->candidates[c].view];
		if (agreement[c] > (float)REGIONS_JOINS &&
			(*best == REGIONS_NONE || agreement[c] > agreement[*best]))
			*best = c;
	}
}

/* What a view shows of a candidate, and the candidates that agree with it. */
static void begin(struct growth *g, const struct regions *r, size_t seed)
{
	const struct regions_candidate *c = &r->candidates[seed];
	const struct seen *seen = &r->seen[c->view];

	clear(g);
	for (size_t k = 0; k < c->shares.n; k++) {
		const int32_t i = c->shares.index[k];
		const float weight = seen_weight(seen, (size_t)i);
		if (weight > (float)SEEN && c->shares.share[k] > weight / 2)
			add(g, i);
	}
	look_from(g, r, c->view);
	find_agreement(g, r, 1);
	choose(g, r);
	g->region.chosen[c->view] = seed;
}

/* 1 where a region came of it. */
static int grow(struct growth *g, const struct regions *r, size_t seed)
{
	size_t n = 0;

	begin(g, r, seed);
	for (int step = 0; step < STEPS && g->region.n; step++) {
		memcpy(g->before, g->region.chosen, r->views * sizeof *g->before);
		regions_sum(&g->sums, r, g->region.chosen);
		clear(g);
		for (size_t k = 0; k < g->sums.n; k++)
			if (g->sums.sum[k] > g->sums.all[k] / 2)
				add(g, g->sums.index[k]);
		find_agreement(g, r, 0);
		choose(g, r);
		if (!memcmp(g->before, g->region.chosen, r->views * sizeof *g->before))
			break;
	}
	for (size_t v = 0; v < r->views && g->region.n; v++)
		if (g->region.chosen[v] != REGIONS_NONE)
			g->area[n++] = (double)g->region.agreement[g->region.chosen[v]];
	if (!n)
		return 0;
	qsort(g->area, n, sizeof *g->area, compare_double);
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

static int is_seed(const struct regions *r, size_t witness, size_t object)
{
	const struct regions_witness *w = &r->witnesses[witness];

	return w->object == object && w->candidate != REGIONS_NONE && r->candidates[w->candidate].shares.n;
}

/* An object's surest seed in a view. */
struct start {
	const struct regions_witness *first;
	double area; /* share of the picture */
};

static double picture_share(const struct rle *m)
{
	return (double)rle_area(m) / ((double)m->height * (double)m->width);
}

static int order_starts(const void *a, const void *b)
{
	const struct start *p = a, *q = b;
	const int order = mask_order(p->first->mask, q->first->mask);

	if (p->area != q->area)
		return p->area < q->area ? -1 : 1;
	return order ? order : (p->first > q->first) - (p->first < q->first);
}

/* Where an object's regions are grown from: views that show it small and large, whatever their names and
 * order are. Returns how many: the first of *starts (views). */
static size_t find_starts(const struct regions *r, size_t object, struct start *starts)
{
	size_t n = 0, found = 0;

	for (size_t i = 0; i < r->witness_count; i++)
		if (is_seed(r, i, object) && (!n || starts[n - 1].first->view != r->witnesses[i].view))
			starts[n++] =
				(struct start){&r->witnesses[i], picture_share(&r->witnesses[i].mask->rle)};
	if (n)
		qsort(starts, n, sizeof *starts, order_starts);
	for (size_t k = 0; k < SEED_VIEWS && n; k++) {
		const size_t at = k * (n - 1) / (SEED_VIEWS - 1);
		if (at >= found)
			starts[found++] = starts[at];
	}
	return found;
}

struct named {
	const char *name;
	size_t object;
};

static int order_names(const void *a, const void *b)
{
	return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

/* Objects by name, so that regions do not depend on the order in which these came. */
static void name_objects(const struct regions *r, struct named *named)
{
	for (size_t o = 0; o < r->object_count; o++)
		named[o] = (struct named){"", o};
	for (size_t i = 0; i < r->witness_count; i++)
		named[r->witnesses[i].object].name = mask_object(r->witnesses[i].mask);
	if (r->object_count)
		qsort(named, r->object_count, sizeof *named, order_names);
}

static int grow_object(struct regions *r, struct growth *g, size_t object, struct start *starts,
	float *explained, const double *total, struct err *e)
{
	const size_t n = find_starts(r, object, starts);

	for (size_t k = 0; k < n; k++)
		for (const struct regions_witness *w = starts[k].first;
			w < r->witnesses + r->witness_count && w->view == starts[k].first->view; w++) {
			if (!is_seed(r, (size_t)(w - r->witnesses), object) || g->is_tried[w->candidate] ||
				explained[w->candidate] >= (float)EXPLAINED)
				continue;
			g->is_tried[w->candidate] = 1;
			if (grow(g, r, w->candidate) && !is_known(g, r, total) &&
				keep(r, &g->region, explained, e))
				return -1;
		}
	return 0;
}

int regions_grow(struct regions *r, struct err *e)
{
	struct growth g;

	regions_settle(r);
	SCOPED float *explained = mem_zalloc(r->count, sizeof *explained, "regions", e);
	SCOPED double *total = mem_zalloc(r->gaussians, sizeof *total, "regions", e);
	SCOPED struct named *named = mem_alloc(r->object_count, sizeof *named, "regions", e);
	SCOPED struct start *starts = mem_alloc(r->views, sizeof *starts, "regions", e);
	int bad = !explained || !total || !named || !starts || growth_make(&g, r, e);

	for (size_t v = 0; v < r->views && !bad; v++)
		seen_add(&r->seen[v], r->gaussians, total);
	if (!bad) {
		name_objects(r, named);
		for (size_t i = 0; i < r->object_count && !bad; i++)
			bad = grow_object(r, &g, named[i].object, starts, explained, total, e);
		growth_free(&g);
	}
	return bad ? -1 : 0;
}
