#include "lift/propagate.h"

#include "base/compare.h"
#include "base/mem.h"
#include "splat/backproject.h"

#include <stdint.h>

enum { BATCH = 4 * VIEW_GROUP }; /* channels that are images at a time: whole groups */

static size_t least(size_t a, size_t b)
{
	return a < b ? a : b;
}

struct place {
	size_t view, index;
};

static int order_places(const void *a, const void *b)
{
	const struct place *p = a, *q = b;

	return p->view != q->view ? COMPARE(p->view, q->view) : COMPARE(p->index, q->index);
}

/* Where each object begins: one start for each that begins anywhere. */
static void find_starts(
	struct propagation *c, const struct pool *p, const size_t *views, const struct cameras *cameras)
{
	for (size_t i = 0; i < p->n; i++)
		c->starts[i].view = cameras->n;
	for (size_t i = 0; i < p->group_count; i++) {
		const struct pool_group *g = &p->groups[i];
		struct propagate_start *s = &c->starts[g->object];
		const size_t view = views[g->first];
		if (g->winner >= 0 && cameras->views[view].split == SPLIT_TRAIN && view < s->view)
			*s = (struct propagate_start){view, &p->candidates[g->winner], g->vote};
	}
	for (size_t i = 0; i < p->n; i++)
		if (c->starts[i].view < cameras->n)
			c->starts[c->count++] = c->starts[i];
}

int propagate_init(struct propagation *c, const struct pool *p, const size_t *views,
	const struct cameras *cameras, struct err *e)
{
	*c = (struct propagation){0};
	c->starts = mem_alloc(p->n, sizeof *c->starts, "masks", e);
	c->order = mem_alloc(p->n, sizeof *c->order, "masks", e);
	c->sources = mem_alloc(p->n, sizeof *c->sources, "masks", e);
	SCOPED struct place *places = mem_alloc(p->n, sizeof *places, "masks", e);
	if (!c->starts || !c->order || !c->sources || !places) {
		propagate_free(c);
		return -1;
	}
	find_starts(c, p, views, cameras);
	for (size_t i = 0; i < c->count; i++)
		places[i] = (struct place){c->starts[i].view, i};
	if (c->count)
		qsort(places, c->count, sizeof *places, order_places);
	for (size_t i = 0; i < c->count; i++) {
		c->order[i] = places[i].index;
		if (!i || places[i].view != places[i - 1].view)
			c->sources[c->source_count++] =
				(struct propagate_source){.view = places[i].view, .begin = i};
		c->sources[c->source_count - 1].count++;
	}
	return 0;
}

void propagate_free(struct propagation *c)
{
	for (size_t s = 0; s < c->source_count; s++)
		free(c->sources[s].field);
	mem_free_all(c->starts, c->order, c->sources);
	*c = (struct propagation){0};
}

/* An image of 0 and 1 at the view's size; pixels (P) is scratch. */
static int fill_image(
	const struct rle *mask, int height, int width, uint8_t *pixels, float *image, struct err *e)
{
	if (rle_decode_at(mask, height, width, pixels, e))
		return -1;
	for (size_t p = 0; p < (size_t)width * (size_t)height; p++)
		image[p] = pixels[p];
	return 0;
}

/* What a source's field has, from the sums over the masks' pixels. */
static void make_shares(float *field, size_t channels, size_t n, const double *weight)
{
#pragma omp parallel for schedule(static)
	for (size_t k = 0; k < channels; k++)
		for (size_t i = 0; i < n; i++) {
			float *at = &field[backproject_index(n, k, i)];
			if (weight[i] > 0)
				*at = k ? (float)((double)*at / weight[i] - 0.5) : 0.5f;
			else
				*at = k ? 0 : -0.5f;
		}
}

int propagate_lift(struct propagation *c, size_t source, const struct view_weights *w, int height, int width,
	struct err *e)
{
	struct propagate_source *s = &c->sources[source];
	const size_t n = w->gaussians, channels = s->count + 1;

	s->field = mem_zalloc(backproject_groups(channels) * VIEW_GROUP, n * sizeof *s->field, "masks", e);
	SCOPED double *weight = mem_zalloc(n, sizeof *weight, "masks", e);
	SCOPED float *image = mem_alloc(w->pixels, BATCH * sizeof *image, "masks", e);
	SCOPED uint8_t *pixels = mem_alloc(w->pixels, 1, "masks", e);
	if (!s->field || !weight || !image || !pixels)
		return -1;
	backproject_weight(w, weight);
	for (size_t from = 0; from < channels; from += BATCH) {
		const size_t now = least(channels - from, BATCH);
		memset(image, 0, now * w->pixels * sizeof *image);
		for (size_t k = from ? 0 : 1; k < now; k++)
			if (fill_image(&c->starts[c->order[s->begin + from + k - 1]].mask->rle, height, width,
				    pixels, image + k * w->pixels, e))
				return -1;
		backproject_add(w, image, now, s->field + from * n);
	}
	make_shares(s->field, channels, n, weight);
	return 0;
}

/* Memory that a view's sources share. */
struct room {
	float *image;	   /* (BATCH,P) */
	uint8_t *pixels;   /* (BATCH,P) */
	uint8_t *is_known; /* (P) */
};

/* Cuts the images of a source's channels [from,from+now). */
static int cut(const struct propagation *c, const struct propagate_source *s, const struct room *room,
	size_t from, size_t now, int height, int width, struct rle *masks, struct err *e)
{
	const size_t count = (size_t)height * (size_t)width;
	int failed = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t k = from ? 0 : 1; k < now; k++) {
		const float *image = room->image + k * count;
		uint8_t *pixels = room->pixels + k * count;
		struct err mine;
		for (size_t p = 0; p < count; p++)
			pixels[p] = room->is_known[p] && image[p] > 0;
		if (rle_encode(&masks[c->order[s->begin + from + k - 1]], pixels, height, width, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

static int render_source(const struct propagation *c, const struct propagate_source *s,
	const struct room *room, const struct view_weights *w, int height, int width, struct rle *masks,
	struct err *e)
{
	const size_t channels = s->count + 1;

	for (size_t from = 0; from < channels; from += BATCH) {
		const size_t now = least(channels - from, BATCH);
		backproject_render(w, s->field + from * w->gaussians, now, room->image);
		for (size_t p = 0; p < w->pixels && !from; p++)
			room->is_known[p] = room->image[p] >= 0;
		if (cut(c, s, room, from, now, height, width, masks, e))
			return -1;
	}
	return 0;
}

int propagate_render(const struct propagation *c, size_t view, const struct view_weights *w, int height,
	int width, struct rle *masks, struct err *e)
{
	struct room room = {mem_alloc(w->pixels, BATCH * sizeof *room.image, "masks", e),
		mem_alloc(w->pixels, BATCH, "masks", e), mem_alloc(w->pixels, 1, "masks", e)};
	int bad = !room.image || !room.pixels || !room.is_known;

	for (size_t i = 0; i < c->count; i++)
		masks[i] = (struct rle){0};
	for (size_t i = 0; i < c->source_count && !bad; i++) {
		const struct propagate_source *s = &c->sources[i];
		if (s->view != view)
			bad = render_source(c, s, &room, w, height, width, masks, e);
		for (size_t k = 0; k < s->count && !bad && s->view == view; k++) {
			const size_t at = c->order[s->begin + k];
			bad = rle_resize(&masks[at], &c->starts[at].mask->rle, height, width, e);
		}
	}
	for (size_t i = 0; i < c->count && bad; i++)
		rle_free(&masks[i]);
	mem_free_all(room.image, room.pixels, room.is_known);
	return bad ? -1 : 0;
}
