#include "lift/lift_objects.h"

#include "base/mem.h"
#include "splat/backproject.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 4 * VIEW_GROUP }; /* objects whose images are there at a time: whole groups */

/* Keeps the share of a Gaussian that hardly any pixel shows near 0. */
static const float LEAST_WEIGHT = 0.01f;
/* So that the masks of an object that another one has taken over still vote, all alike. */
static const float LEAST_VOTE = 0.01f;
/* What rounds to nothing in a file, formats/lifted.md. */
static const float LEAST_SHARE = 0.5f / 255;

static size_t least(size_t a, size_t b)
{
	return a < b ? a : b;
}

static size_t field_size(const struct lift_objects *l)
{
	return backproject_groups(l->objects) * l->gaussians * VIEW_GROUP;
}

int lift_objects_init(struct lift_objects *l, size_t gaussians, size_t objects, struct err *e)
{
	const size_t channels = backproject_groups(objects) * VIEW_GROUP;

	*l = (struct lift_objects){.gaussians = gaussians, .objects = objects};
	l->sum = mem_zalloc(channels, gaussians * sizeof *l->sum, "shares", e);
	l->share = l->sum ? mem_zalloc(channels, gaussians * sizeof *l->share, "shares", e) : NULL;
	l->weight = l->share ? mem_zalloc(objects, gaussians * sizeof *l->weight, "shares", e) : NULL;
	l->agreement = l->weight ? mem_zalloc(objects, sizeof *l->agreement, "shares", e) : NULL;
	l->level = l->agreement ? mem_zalloc(objects, sizeof *l->level, "shares", e) : NULL;
	l->masks = l->level ? mem_zalloc(objects, sizeof *l->masks, "shares", e) : NULL;
	if (l->masks)
		return 0;
	lift_objects_free(l);
	return -1;
}

void lift_objects_free(struct lift_objects *l)
{
	free(l->sum);
	free(l->weight);
	free(l->share);
	free(l->agreement);
	free(l->level);
	free(l->masks);
	*l = (struct lift_objects){0};
}

/* Memory of one view. */
struct room {
	float *image;	 /* (BATCH,P) masks */
	float *rendered; /* (BATCH,P) what the round before lifted */
	float *total;	 /* (P) sum of a pixel's weights */
	double *weight;	 /* (N) of each Gaussian in the view */
	uint8_t *pixels; /* (P) */
	float *vote;	 /* (O); 0 where the view has no mask of the object */
};

static void room_free(struct room *r)
{
	free(r->image);
	free(r->rendered);
	free(r->total);
	free(r->weight);
	free(r->pixels);
	free(r->vote);
}

static int room_make(
	struct room *r, const struct lift_objects *l, const struct view_weights *w, struct err *e)
{
	*r = (struct room){.image = mem_alloc(w->pixels, BATCH * sizeof(float), "masks", e),
		.rendered = mem_alloc(w->pixels, BATCH * sizeof(float), "masks", e),
		.total = mem_alloc(w->pixels, sizeof(float), "masks", e),
		.weight = mem_zalloc(w->gaussians, sizeof(double), "masks", e),
		.pixels = mem_alloc(w->pixels, 1, "masks", e),
		.vote = mem_zalloc(l->objects, sizeof(float), "masks", e)};
	if (!r->image || !r->rendered || !r->total || !r->weight || !r->pixels || !r->vote)
		return -1;
	backproject_weight(w, r->weight);
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < w->pixels; p++) {
		double sum = 0;
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
			sum += (double)w->weight[k];
		r->total[p] = (float)sum;
	}
	return 0;
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
			image[p] += (float)pixels[p];
	}
	for (size_t p = 0; p < count && n > 1; p++)
		image[p] /= (float)n;
	return 0;
}

/* Soft intersection over union of a mask and what was lifted; two empty ones agree. */
static double agreement(const float *mask, const float *rendered, const float *total, size_t count)
{
	double both = 0, either = 0;

	for (size_t p = 0; p < count; p++) {
		float a = total[p] > 0 ? rendered[p] / total[p] : 0;
		both += (double)(a < mask[p] ? a : mask[p]);
		either += (double)(a > mask[p] ? a : mask[p]);
	}
	return either > 0 ? both / either : 1;
}

/* The votes of a batch's masks, and their images times the votes. */
static void vote(struct lift_objects *l, const struct view_weights *w, const struct room *r, size_t from,
	size_t now, const char *is_there)
{
	if (l->round)
		backproject_render(w, l->share + from * l->gaussians, now, r->rendered);
#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < now; k++) {
		const size_t o = from + k;
		float *image = r->image + k * w->pixels;
		if (!is_there[k])
			continue;
		r->vote[o] = 1;
		l->masks[o]++;
		if (!l->round)
			continue;
		const double a = agreement(image, r->rendered + k * w->pixels, r->total, w->pixels);
		l->agreement[o] += a;
		r->vote[o] = (float)(a * a) > LEAST_VOTE ? (float)(a * a) : LEAST_VOTE;
		for (size_t p = 0; p < w->pixels; p++)
			image[p] *= r->vote[o];
	}
}

static void add_weights(struct lift_objects *l, const struct room *r)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t o = 0; o < l->objects; o++) {
		float *to = l->weight + o * l->gaussians;
		for (size_t i = 0; i < l->gaussians && r->vote[o] > 0; i++)
			to[i] += (float)(r->vote[o] * r->weight[i]);
	}
}

int lift_objects_view(struct lift_objects *l, const struct view_weights *w, int height, int width,
	const struct lift_mask *masks, size_t n, struct err *e)
{
	struct room r;
	size_t at = 0;
	int bad = room_make(&r, l, w, e);

	for (size_t from = 0; from < l->objects && !bad; from += BATCH) {
		const size_t now = least(l->objects - from, BATCH);
		char is_there[BATCH] = {0};
		memset(r.image, 0, now * w->pixels * sizeof *r.image);
		while (at < n && masks[at].object < from + now && !bad) {
			const size_t o = masks[at].object, first = at;
			while (at < n && masks[at].object == o)
				at++;
			is_there[o - from] = 1;
			bad = fill_image(masks + first, at - first, height, width, r.pixels,
				r.image + (o - from) * w->pixels, e);
		}
		if (bad)
			break;
		vote(l, w, &r, from, now, is_there);
		backproject_add(w, r.image, now, l->sum + from * l->gaussians);
	}
	if (!bad)
		add_weights(l, &r);
	room_free(&r);
	return bad ? -1 : 0;
}

/* Shares of each Gaussian from the sums. */
static void divide(struct lift_objects *l)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t o = 0; o < l->objects; o++)
		for (size_t i = 0; i < l->gaussians; i++) {
			const size_t at = backproject_index(l->gaussians, o, i);
			const float weight = l->weight[o * l->gaussians + i];
			l->share[at] = weight > 0 ? l->sum[at] / (weight + LEAST_WEIGHT) : 0;
		}
}

/* The largest share of a Gaussian stays; others become 0 while votes are found, and at the end are reduced by
 * how much they fall short of it. */
static void compete(struct lift_objects *l, int is_last)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < l->gaussians; i++) {
		float most = 0;
		size_t winner = 0;
		for (size_t o = 0; o < l->objects; o++) {
			const float a = l->share[backproject_index(l->gaussians, o, i)];
			if (a > most) {
				most = a;
				winner = o;
			}
		}
		for (size_t o = 0; o < l->objects && most > 0; o++) {
			float *a = &l->share[backproject_index(l->gaussians, o, i)];
			if (o != winner)
				*a = is_last ? *a * (*a / most) : 0;
		}
	}
}

/* The mean of an object's shares over its own weight, which they are divided by: masks that cover a part of
 * it, and Gaussians that reach over its edge, leave all of its shares below 1, and 1 is what its inside
 * should have. */
static void find_levels(struct lift_objects *l)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t o = 0; o < l->objects; o++) {
		double sum = 0, squares = 0;
		for (size_t i = 0; i < l->gaussians; i++) {
			const double a = l->share[backproject_index(l->gaussians, o, i)];
			const double inside = a * l->weight[o * l->gaussians + i];
			sum += inside;
			squares += inside * a;
		}
		l->level[o] = sum > 0 ? squares / sum : 1;
	}
}

static void scale(struct lift_objects *l)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t o = 0; o < l->objects; o++)
		for (size_t i = 0; i < l->gaussians; i++) {
			float *a = &l->share[backproject_index(l->gaussians, o, i)];
			const double scaled = *a / l->level[o];
			*a = scaled < 1 ? (float)scaled : 1;
		}
}

void lift_objects_settle(struct lift_objects *l)
{
	const int is_last = ++l->round == LIFT_ROUNDS;

	divide(l);
	find_levels(l);
	compete(l, is_last);
	scale(l);
	if (is_last) {
		for (size_t o = 0; o < l->objects; o++)
			l->agreement[o] = l->masks[o] ? l->agreement[o] / (double)l->masks[o] : 0;
		return;
	}
	memset(l->sum, 0, field_size(l) * sizeof *l->sum);
	memset(l->weight, 0, l->objects * l->gaussians * sizeof *l->weight);
	memset(l->agreement, 0, l->objects * sizeof *l->agreement);
	memset(l->masks, 0, l->objects * sizeof *l->masks);
}

int lift_objects_finish(const struct lift_objects *l, struct lifted *to, struct err *e)
{
	size_t count = 0, at = 0;

	for (size_t o = 0; o < l->objects; o++)
		for (size_t i = 0; i < l->gaussians; i++)
			count += l->share[backproject_index(l->gaussians, o, i)] > LEAST_SHARE;
	to->gaussians = l->gaussians;
	to->objects = l->objects;
	to->confidence = mem_alloc(l->objects, sizeof *to->confidence, "shares", e);
	to->indptr = mem_zalloc(l->objects + 1, sizeof *to->indptr, "shares", e);
	to->index = mem_alloc(count, sizeof *to->index, "shares", e);
	to->share = mem_alloc(count, sizeof *to->share, "shares", e);
	if (!to->confidence || !to->indptr || !to->index || !to->share)
		return -1;
	for (size_t o = 0; o < l->objects; o++) {
		to->confidence[o] = (float)l->agreement[o];
		for (size_t i = 0; i < l->gaussians; i++) {
			const float a = l->share[backproject_index(l->gaussians, o, i)];
			if (a > LEAST_SHARE) {
				to->index[at] = (int32_t)i;
				to->share[at++] = a;
			}
		}
		to->indptr[o + 1] = (int64_t)at;
	}
	return 0;
}
