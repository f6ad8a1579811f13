#include "lift/regions.h"

#include "base/mem.h"
#include "splat/backproject.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = 16 }; /* masks that are images at a time */

/* A candidate on its way to its place. */
struct item {
	const struct mask *mask;
	size_t view, object, sentence;
};

static int order_sizes(size_t a, size_t b)
{
	return (a > b) - (a < b);
}

/* Of masks of one array: as they came. */
static int order_masks(const struct item *p, const struct item *q)
{
	return (p->mask > q->mask) - (p->mask < q->mask);
}

static int order_sentences(const struct item *p, const struct item *q)
{
	int order = order_sizes(p->object, q->object);

	if (order || !p->mask->ref || !q->mask->ref)
		return order ? order : !!p->mask->ref - !!q->mask->ref;
	return strcmp(p->mask->ref, q->mask->ref);
}

static int by_sentence(const void *a, const void *b)
{
	const struct item *p = a, *q = b;
	int order = order_sentences(p, q);

	return order ? order : order_masks(p, q);
}

static int by_view(const void *a, const void *b)
{
	const struct item *p = a, *q = b;
	int order = order_sizes(p->view, q->view);

	if (!order)
		order = order_sizes(p->object, q->object);
	return order ? order : order_masks(p, q);
}

static int by_size(const void *a, const void *b)
{
	return order_sizes(*(const size_t *)a, *(const size_t *)b);
}

/* Objects in the order in which they came. */
static void number_objects(struct regions *r, const struct pool *p)
{
	size_t n = 0;

	for (size_t i = 0; i < p->group_count; i++)
		r->objects[n++] = p->groups[i].object;
	if (n)
		qsort(r->objects, n, sizeof *r->objects, by_size);
	for (size_t i = 0; i < n; i++)
		if (!i || r->objects[i] != r->objects[i - 1])
			r->objects[r->object_count++] = r->objects[i];
}

static size_t find_object(const struct regions *r, size_t first)
{
	const size_t *at = bsearch(&first, r->objects, r->object_count, sizeof *at, by_size);

	return (size_t)(at - r->objects);
}

static void fill_candidates(struct regions *r, struct item *items)
{
	if (r->count)
		qsort(items, r->count, sizeof *items, by_sentence);
	for (size_t i = 0; i < r->count; i++) {
		if (!i || order_sentences(&items[i], &items[i - 1]))
			r->sentence_objects[r->sentence_count++] = items[i].object;
		items[i].sentence = r->sentence_count - 1;
	}
	if (r->count)
		qsort(items, r->count, sizeof *items, by_view);
	for (size_t i = 0; i < r->count; i++)
		r->candidates[i] = (struct regions_candidate){.mask = items[i].mask,
			.view = items[i].view,
			.object = items[i].object,
			.sentence = items[i].sentence};
}

int regions_init(struct regions *r, const struct pool *p, const size_t *places, size_t views,
	size_t gaussians, double min_score, struct err *e)
{
	*r = (struct regions){.views = views, .gaussians = gaussians};
	struct item *items = mem_alloc(p->n, sizeof *items, "candidates", e);
	r->candidates = mem_alloc(p->n, sizeof *r->candidates, "candidates", e);
	r->objects = mem_alloc(p->n, sizeof *r->objects, "candidates", e);
	r->sentence_objects = mem_alloc(p->n, sizeof *r->sentence_objects, "candidates", e);
	r->weight = mem_zalloc(views, gaussians * sizeof *r->weight, "views", e);
	if (!items || !r->candidates || !r->objects || !r->sentence_objects || !r->weight) {
		free(items);
		regions_free(r);
		return -1;
	}
	number_objects(r, p);
	for (size_t g = 0; g < p->group_count; g++) {
		const struct pool_group *group = &p->groups[g];
		const size_t object = find_object(r, group->object);
		for (size_t k = group->begin; k < group->begin + group->n; k++) {
			const size_t at = p->index.keys[k].at;
			const struct mask *mask = &p->candidates[at];
			if (mask_confidence(mask) > min_score)
				items[r->count++] = (struct item){mask, places[at], object, 0};
		}
	}
	fill_candidates(r, items);
	free(items);
	return 0;
}

void regions_free(struct regions *r)
{
	for (size_t i = 0; i < r->region_count; i++) {
		free(r->regions[i].members);
		free(r->regions[i].agreement);
		free(r->regions[i].chosen);
	}
	for (size_t c = 0; c < r->count; c++)
		shares_free(&r->candidates[c].shares);
	free(r->candidates);
	free(r->objects);
	free(r->sentence_objects);
	free(r->weight);
	free(r->regions);
	free(r->served);
	free(r->field);
	*r = (struct regions){0};
}

/* Images (now,P) of 0 and 1 at the view's size. */
static int fill_images(const struct regions_candidate *c, size_t now, int height, int width, uint8_t *pixels,
	float *image, struct err *e)
{
	const size_t count = (size_t)height * (size_t)width;
	int failed = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t k = 0; k < now; k++) {
		struct err mine;
		if (rle_decode_at(&c[k].mask->rle, height, width, pixels + k * count, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
			continue;
		}
		for (size_t p = 0; p < count; p++)
			image[k * count + p] = pixels[k * count + p];
	}
	return failed ? -1 : 0;
}

static int lift_candidates(struct regions_candidate *c, size_t now, const struct view_weights *w,
	const float *image, struct err *e)
{
	struct shares rows[BATCH];

	if (shares_make(rows, w, image, now, e))
		return -1;
	for (size_t k = 0; k < now; k++) {
		c[k].shares = rows[k];
		for (size_t i = 0; i < rows[k].n; i++)
			c[k].mass += (double)rows[k].share[i];
	}
	return 0;
}

int regions_lift(
	struct regions *r, size_t view, const struct view_weights *w, int height, int width, struct err *e)
{
	double *weight = mem_zalloc(r->gaussians, sizeof *weight, "masks", e);
	float *image = mem_alloc(w->pixels, BATCH * sizeof *image, "masks", e);
	uint8_t *pixels = mem_alloc(w->pixels, BATCH, "masks", e);
	int bad = !weight || !image || !pixels;
	size_t begin = 0, end;

	if (!bad) {
		backproject_weight(w, weight);
		for (size_t i = 0; i < r->gaussians; i++)
			r->weight[view * r->gaussians + i] = (float)weight[i];
	}
	while (begin < r->count && r->candidates[begin].view < view)
		begin++;
	for (end = begin; end < r->count && r->candidates[end].view == view;)
		end++;
	for (size_t from = begin; from < end && !bad; from += BATCH) {
		const size_t now = end - from < BATCH ? end - from : BATCH;
		bad = fill_images(&r->candidates[from], now, height, width, pixels, image, e) ||
		      lift_candidates(&r->candidates[from], now, w, image, e);
	}
	free(weight);
	free(image);
	free(pixels);
	return bad ? -1 : 0;
}
