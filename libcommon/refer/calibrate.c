#include "refer/calibrate.h"

#include "base/mem.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int by_value(const void *a, const void *b)
{
	float x = *(const float *)a, y = *(const float *)b;

	return (x < y) - (x > y);
}

/* The views looked at; returns how many. */
static int choose_views(const struct cameras *cameras, struct camera chosen[CALIBRATE_VIEWS])
{
	size_t counts[2] = {0}, at = 0;
	int n = 0;

	for (size_t i = 0; i < cameras->n; i++)
		counts[cameras->views[i].split == SPLIT_TEST]++;
	const int split = counts[0] ? SPLIT_TRAIN : SPLIT_TEST;
	const size_t all = counts[split == SPLIT_TEST], take = all < CALIBRATE_VIEWS ? all : CALIBRATE_VIEWS;
	for (size_t i = 0; i < cameras->n; i++) {
		const struct camera *c = &cameras->views[i];
		if ((int)c->split != split)
			continue;
		if (at++ != (size_t)n * all / take || n == (int)take)
			continue;
		const double scale =
			fmin(1, (double)CALIBRATE_SIDE / (c->width > c->height ? c->width : c->height));
		int width, height;
		camera_scaled_size(c, scale, &width, &height);
		chosen[n++] = camera_resize(c, width, height);
	}
	return n;
}

/* Renders the views: image (count,pixels), a sentence's views side by side. */
static int render_all(const struct splats *s, const struct camera *views, int n, const float *responses,
	size_t count, float *images, size_t pixels, struct err *e)
{
	size_t at = 0;

	for (int i = 0; i < n; i++) {
		const size_t own = (size_t)views[i].width * (size_t)views[i].height;
		struct render_view *v = render_prepare(s, &views[i], e);
		float *own_images = v ? mem_alloc(count, own * sizeof *own_images, "images", e) : NULL;
		const int bad = !own_images || render_values(v, responses, (int)count, own_images, NULL, e);
		for (size_t r = 0; r < count && !bad; r++)
			memcpy(images + r * pixels + at, own_images + r * own, own * sizeof *images);
		free(own_images);
		render_free(v);
		if (bad)
			return -1;
		at += own;
	}
	return 0;
}

int calibrate(const struct splats *s, const struct cameras *cameras, const struct rows *rows,
	float *responses, size_t count, double *lifts, struct err *e)
{
	struct camera views[CALIBRATE_VIEWS];
	const int view_count = choose_views(cameras, views);
	size_t pixels = 0;

	for (int i = 0; i < view_count; i++)
		pixels += (size_t)views[i].width * (size_t)views[i].height;
	float *images = mem_alloc(count, pixels * sizeof *images, "images", e);
	int bad = images ? render_all(s, views, view_count, responses, count, images, pixels, e) : -1;
	for (size_t r = 0; r < count && !bad; r++) {
		float *image = images + r * pixels;
		lifts[r] = 0;
		qsort(image, pixels, sizeof *image, by_value);
		if (!pixels || (image[0] == 0 && image[pixels - 1] == 0))
			continue; /* nothing seen, or a sentence without words: no answer to lift */
		lifts[r] =
			fmax(0, CALIBRATE_PEAK - (double)image[(size_t)(CALIBRATE_SHARE * (double)pixels)]);
		for (size_t i = 0; i < s->n; i++)
			if (rows->of[i] >= 0)
				responses[r * s->n + i] += (float)lifts[r];
	}
	free(images);
	return bad;
}
