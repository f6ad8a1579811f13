#include "base/mem.h"
#include "lift/regions.h"
#include "lift/regions_private.h"
#include "nn/assignment.h"
#include "splat/backproject.h"

#include <math.h>

#define CHANCE 0.02 /* share of a sentence's candidates that is found by accident */
/* The confidence that each sentence has in nothing, so that one candidate tells less than many. */
#define DOUBT 1.0

/* The region that a candidate shows, or REGIONS_NONE. */
static size_t find_region(const struct regions *r, size_t candidate)
{
	size_t best = REGIONS_NONE;

	for (size_t i = 0; i < r->region_count; i++) {
		const float agreement = r->regions[i].agreement[candidate];
		if ((double)agreement > REGIONS_PEER * r->regions[i].typical &&
			(best == REGIONS_NONE || agreement > r->regions[best].agreement[candidate]))
			best = i;
	}
	return best;
}

/* share (sentences,regions): of each sentence's candidates, by confidence, in each region. */
static int find_shares(const struct regions *r, double *share, struct err *e)
{
	SCOPED double *total = mem_zalloc(r->sentence_count, sizeof *total, "regions", e);

	if (!total)
		return -1;
	for (size_t i = 0; i < r->witness_count; i++) {
		const struct regions_witness *at = &r->witnesses[i];
		if (at->candidate == REGIONS_NONE || !r->candidates[at->candidate].shares.n)
			continue;
		const double score = mask_confidence(at->mask);
		const size_t best = find_region(r, at->candidate);
		total[at->sentence] += score;
		if (best != REGIONS_NONE)
			share[at->sentence * r->region_count + best] += score;
	}
	for (size_t s = 0; s < r->sentence_count; s++)
		for (size_t i = 0; i < r->region_count; i++)
			share[s * r->region_count + i] /= total[s] + DOUBT;
	return 0;
}

/* value (objects, regions and then one column for each object: no region) and which of them have support. */
static void find_values(
	const struct regions *r, const double *share, size_t columns, double *value, uint8_t *has_support)
{
	for (size_t s = 0; s < r->sentence_count; s++) {
		const size_t row = r->sentence_objects[s] * columns;
		for (size_t i = 0; i < columns; i++) {
			const double q = i < r->region_count ? share[s * r->region_count + i] : 0;
			value[row + i] += log(q + CHANCE);
			has_support[row + i] |= q > 0;
		}
	}
}

/* What an assigned region is made of, as a channel. */
static void fill_field(
	const struct regions *r, size_t object, const struct region *region, struct regions_sums *sums)
{
	regions_sum(sums, r, region->chosen);
	for (size_t i = 0; i < r->gaussians; i++)
		r->field[backproject_index(r->gaussians, object, i)] = -0.5f;
	for (size_t k = 0; k < sums->n; k++)
		if (sums->all[k] > 0)
			r->field[backproject_index(r->gaussians, object, (size_t)sums->index[k])] =
				sums->sum[k] / sums->all[k] - 0.5f;
}

int regions_assign(struct regions *r, struct err *e)
{
	const size_t columns = r->region_count + r->object_count, n = r->gaussians;
	SCOPED double *share = mem_zalloc(r->sentence_count, r->region_count * sizeof *share, "regions", e);
	SCOPED double *value = mem_zalloc(r->object_count, columns * sizeof *value, "regions", e);
	SCOPED uint8_t *has_support = mem_zalloc(r->object_count, columns, "regions", e);
	SCOPED_BY(regions_sums_free) struct regions_sums sums = {0};
	r->served = mem_alloc(r->object_count, sizeof *r->served, "regions", e);
	r->field = mem_zalloc(
		backproject_groups(r->object_count) * VIEW_GROUP, n * sizeof *r->field, "regions", e);
	int bad = regions_sums_make(&sums, n, e) || !share || !value || !has_support || !r->served ||
		  !r->field || find_shares(r, share, e);

	if (!bad) {
		find_values(r, share, columns, value, has_support);
		bad = assignment_best(value, r->object_count, columns, r->served, e);
	}
	for (size_t o = 0; o < r->object_count && !bad; o++)
		if (!has_support[o * columns + r->served[o]])
			r->served[o] = REGIONS_NONE;
		else
			fill_field(r, o, &r->regions[r->served[o]], &sums);
	return bad || regions_find_spare(r, share, e) ? -1 : 0;
}

/* Those of a small thing agree less in all views, so that only a comparison with the others tells. */
size_t regions_find_candidate(const struct regions *r, const struct region *region, size_t view)
{
	size_t best = REGIONS_NONE;

	for (size_t c = r->ranges[view].begin; c < r->ranges[view].end; c++)
		if ((double)region->agreement[c] > REGIONS_PEER * region->typical &&
			(best == REGIONS_NONE || region->agreement[c] > region->agreement[best]))
			best = c;
	return best;
}

int regions_need_weights(const struct regions *r, size_t view)
{
	for (size_t o = 0; o < r->object_count; o++)
		if (r->served[o] != REGIONS_NONE &&
			regions_find_candidate(r, &r->regions[r->served[o]], view) == REGIONS_NONE)
			return 1;
	return 0;
}

/* Memory to render the objects of a view: a group of them at a time. */
struct painter {
	const struct regions *r;
	const struct view_matrix *w;
	const struct rle *like; /* whose size the masks get, or NULL */
	float *image;		/* (VIEW_GROUP,P) */
	uint8_t *pixels;	/* (P) */
	size_t group;		/* the one that the image has */
};

static int painter_make(struct painter *t, const struct view_matrix *w, struct err *e)
{
	t->w = w;
	t->group = REGIONS_NONE;
	t->image = mem_alloc(w->rows.pixels, VIEW_GROUP * sizeof *t->image, "masks", e);
	t->pixels = mem_alloc(w->rows.pixels, 1, "masks", e);
	return t->image && t->pixels ? 0 : -1;
}

static void render_group(const struct painter *t, size_t group)
{
	const float *field = t->r->field + group * VIEW_GROUP * t->r->gaussians;

	if (t->w->tiles)
		view_tiles_blend_group(t->w->tiles, field, t->image);
	else
		backproject_render(&t->w->rows, field, VIEW_GROUP, t->image);
}

static int paint(struct painter *t, size_t object, struct rle *mask, struct err *e)
{
	const size_t group = object / VIEW_GROUP, pixels = t->w->rows.pixels;
	const float *image = t->image + object % VIEW_GROUP * pixels;
	struct rle small;

	if (group != t->group)
		render_group(t, group);
	t->group = group;
	for (size_t p = 0; p < pixels; p++)
		t->pixels[p] = image[p] > 0;
	if (rle_encode(&small, t->pixels, t->w->height, t->w->width, e))
		return -1;
	if (!t->like || rle_same_size(t->like, &small)) {
		*mask = small;
		return 0;
	}
	int bad = rle_resize(mask, &small, t->like->height, t->like->width, e);
	rle_free(&small);
	return bad;
}

static int put_mask(struct painter *t, size_t object, size_t view, struct rle *mask, double *score,
	size_t *rendered, struct err *e)
{
	const struct regions *r = t->r;

	if (r->served[object] == REGIONS_NONE)
		return 0;
	const struct region *region = &r->regions[r->served[object]];
	const size_t c = regions_find_candidate(r, region, view);
	if (c != REGIONS_NONE) {
		const struct rle *chosen = &r->candidates[c].mask->rle;
		*score = (double)region->agreement[c];
		return rle_from_runs(mask, chosen->runs, chosen->n, chosen->height, chosen->width, e);
	}
	*score = region->typical;
	if (paint(t, object, mask, e))
		return -1;
	*rendered += rle_area(mask) > 0;
	return 0;
}

int regions_render(const struct regions *r, size_t view, const struct view_matrix *w, struct rle *masks,
	double *scores, size_t *rendered, struct err *e)
{
	const struct regions_range range = r->ranges[view];
	struct painter t = {
		.r = r, .like = range.end > range.begin ? &r->candidates[range.begin].mask->rle : NULL};
	int bad = w && painter_make(&t, w, e);

	for (size_t o = 0; o < r->object_count; o++) {
		masks[o] = (struct rle){0};
		scores[o] = 0;
	}
	for (size_t o = 0; o < r->object_count && !bad; o++)
		bad = put_mask(&t, o, view, &masks[o], &scores[o], rendered, e);
	for (size_t o = 0; o < r->object_count && bad; o++)
		rle_free(&masks[o]);
	mem_free_all(t.image, t.pixels);
	return bad ? -1 : 0;
}
