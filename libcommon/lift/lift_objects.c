#include "lift/lift_objects.h"

#include "base/mem.h"
#include "base/threads.h"
#include "lift/lift_private.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* So that the masks of an object that another one has taken over still vote, all alike. */
static const float LEAST_VOTE = 0.01f;
/* What rounds to nothing in a file, formats/lifted.md. */
static const float LEAST_SHARE = 0.5f / 255;

int lift_objects_init(struct lift_objects *l, size_t gaussians, size_t objects, size_t views, struct err *e)
{
	*l = (struct lift_objects){.gaussians = gaussians, .objects = objects};
	l->views = mem_zalloc(views, sizeof *l->views, "views", e);
	l->view_count = l->views ? views : 0;
	l->shares = mem_zalloc(objects, sizeof *l->shares, "shares", e);
	l->claims = mem_alloc(gaussians, sizeof *l->claims, "shares", e);
	l->agreement = mem_zalloc(objects, sizeof *l->agreement, "shares", e);
	l->masks = mem_zalloc(objects, sizeof *l->masks, "shares", e);
	if (l->views && l->shares && l->claims && l->agreement && l->masks)
		return 0;
	lift_objects_free(l);
	return -1;
}

static void view_free(struct lift_view *v)
{
	for (size_t k = 0; k < v->n && v->rows; k++)
		shares_free(&v->rows[k]);
	free(v->objects);
	free(v->rows);
	free(v->vote);
	free(v->agreement);
	free(v->weight);
}

void lift_objects_free(struct lift_objects *l)
{
	for (size_t v = 0; v < l->view_count; v++)
		view_free(&l->views[v]);
	for (size_t o = 0; o < l->objects && l->shares; o++)
		shares_free(&l->shares[o]);
	free(l->views);
	free(l->shares);
	free(l->claims);
	free(l->agreement);
	free(l->masks);
	*l = (struct lift_objects){0};
}

void lift_scratch_free(struct lift_scratch *s)
{
	free(s->images);
	free(s->pixels);
	free(s->rendered);
	free(s->total);
	*s = (struct lift_scratch){0};
}

int lift_room(void **block, size_t *room, size_t a, size_t b, size_t size, struct err *e)
{
	size_t n;

	if (mem_size(a, b, &n))
		return err_set(e, ERR_SYSTEM, "masks: out of memory");
	return mem_room(block, room, n, size, "masks", e);
}

/* The mean of an object's masks, as an image. */
static int fill_image(const struct lift_mask *masks, size_t n, int height, int width, uint8_t *pixels,
	float *image, struct err *e)
{
	const size_t count = (size_t)height * (size_t)width;

	for (size_t k = 0; k < n; k++) {
		if (rle_decode_at(&masks[k].mask->rle, height, width, pixels, e))
			return -1;
		for (size_t p = 0; p < count; p++)
			image[p] = k ? image[p] + (float)pixels[p] : (float)pixels[p];
	}
	for (size_t p = 0; p < count && n > 1; p++)
		image[p] /= (float)n;
	return 0;
}

/* A view's masks by object: those of the k-th are masks[starts[k]] to masks[starts[k + 1] - 1]. */
struct groups {
	const struct lift_mask *masks;
	size_t n, *starts; /* (n+1) */
};

static int groups_make(struct groups *g, const struct lift_mask *masks, size_t n, struct err *e)
{
	*g = (struct groups){masks, 0, mem_alloc(n + 1, sizeof *g->starts, "masks", e)};
	if (!g->starts)
		return -1;
	for (size_t k = 0; k < n; k++)
		if (!k || masks[k].object != masks[k - 1].object)
			g->starts[g->n++] = k;
	g->starts[g->n] = n;
	return 0;
}

static int fill_images(struct lift_scratch *s, const struct groups *g, int height, int width, struct err *e)
{
	const size_t count = (size_t)height * (size_t)width;
	const int threads = threads_available();
	int failed = 0;

	if (lift_room((void **)&s->images, &s->image_room, g->n, count, sizeof *s->images, e) ||
		lift_room((void **)&s->pixels, &s->pixel_room, (size_t)threads, count, 1, e))
		return -1;
#pragma omp parallel for schedule(dynamic) reduction(| : failed) num_threads(threads)
	for (size_t k = 0; k < g->n; k++) {
		struct err mine;
		if (fill_image(g->masks + g->starts[k], g->starts[k + 1] - g->starts[k], height, width,
			    s->pixels + (size_t)omp_get_thread_num() * count, s->images + k * count, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

/* The first round: what the view's masks show. */
static int add_view(struct lift_view *v, const struct view_weights *w, const struct groups *g,
	const float *images, struct err *e)
{
	*v = (struct lift_view){.n = g->n};
	v->objects = mem_alloc(v->n, sizeof *v->objects, "views", e);
	v->rows = mem_zalloc(v->n, sizeof *v->rows, "views", e);
	v->vote = mem_alloc(v->n, sizeof *v->vote, "views", e);
	v->agreement = mem_zalloc(v->n, sizeof *v->agreement, "views", e);
	v->weight = mem_alloc(w->gaussians, sizeof *v->weight, "views", e);
	if (!v->objects || !v->rows || !v->vote || !v->agreement || !v->weight ||
		shares_of_view(v->weight, w, e) || shares_make(v->rows, w, images, v->n, e))
		return -1;
	for (size_t k = 0; k < v->n; k++) {
		v->objects[k] = g->masks[g->starts[k]].object;
		v->vote[k] = 1;
	}
	return 0;
}

/* Later rounds: the votes of a view's masks, by how well they agree with what was lifted. */
static int vote(const struct lift_objects *l, struct lift_view *v, const struct lift_weights *w,
	struct lift_scratch *s, struct err *e)
{
	if (lift_agreement(l, v, w, s, v->agreement, e))
		return -1;
	for (size_t k = 0; k < v->n; k++) {
		const float squared = (float)(v->agreement[k] * v->agreement[k]);
		v->vote[k] = squared > LEAST_VOTE ? squared : LEAST_VOTE;
	}
	return 0;
}

static int take_view(struct lift_objects *l, struct lift_scratch *s, size_t at, const struct lift_weights *w,
	const struct lift_mask *masks, size_t n, struct err *e)
{
	struct lift_view *v = &l->views[at];
	struct groups g;
	const int bad = groups_make(&g, masks, n, e) || fill_images(s, &g, w->height, w->width, e) ||
			(l->round ? vote(l, v, w, s, e) : add_view(v, w->rows, &g, s->images, e));

	free(g.starts);
	return bad ? -1 : 0;
}

int lift_objects_view(struct lift_objects *l, struct lift_scratch *s, size_t at, const struct view_weights *w,
	int height, int width, const struct lift_mask *masks, size_t n, struct err *e)
{
	return take_view(l, s, at, &(struct lift_weights){w, NULL, height, width}, masks, n, e);
}

int lift_objects_again(struct lift_objects *l, struct lift_scratch *s, size_t at, const struct view_tiles *t,
	const struct lift_mask *masks, size_t n, struct err *e)
{
	return take_view(l, s, at, &(struct lift_weights){NULL, t, t->height, t->width}, masks, n, e);
}

/* The mean of the last round, over an object's views. */
static void average_agreement(struct lift_objects *l)
{
	for (size_t at = 0; at < l->view_count; at++)
		for (size_t k = 0; k < l->views[at].n; k++) {
			l->agreement[l->views[at].objects[k]] += l->views[at].agreement[k];
			l->masks[l->views[at].objects[k]]++;
		}
	for (size_t o = 0; o < l->objects; o++)
		if (l->masks[o])
			l->agreement[o] /= (double)l->masks[o];
}

int lift_objects_settle(struct lift_objects *l, struct err *e)
{
	const int is_last = ++l->round == LIFT_ROUNDS;

	if (lift_shares(l, is_last, e))
		return -1;
	if (is_last)
		average_agreement(l);
	return 0;
}

int lift_objects_finish(const struct lift_objects *l, struct lifted *to, struct err *e)
{
	size_t count = 0, at = 0;

	for (size_t o = 0; o < l->objects; o++)
		for (size_t k = 0; k < l->shares[o].n; k++)
			count += l->shares[o].share[k] > LEAST_SHARE;
	to->gaussians = l->gaussians;
	to->objects = l->objects;
	to->confidence = mem_alloc(l->objects, sizeof *to->confidence, "shares", e);
	to->indptr = mem_zalloc(l->objects + 1, sizeof *to->indptr, "shares", e);
	to->index = mem_alloc(count, sizeof *to->index, "shares", e);
	to->share = mem_alloc(count, sizeof *to->share, "shares", e);
	if (!to->confidence || !to->indptr || !to->index || !to->share)
		return -1;
	for (size_t o = 0; o < l->objects; o++) {
		const struct shares *row = &l->shares[o];
		to->confidence[o] = (float)l->agreement[o];
		for (size_t k = 0; k < row->n; k++)
			if (row->share[k] > LEAST_SHARE) {
				to->index[at] = row->index[k];
				to->share[at++] = row->share[k];
			}
		to->indptr[o + 1] = (int64_t)at;
	}
	return 0;
}
