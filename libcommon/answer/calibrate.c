#include "answer/calibrate.h"

#include "base/mem.h"
#include "splat/render.h"

#include <math.h>

/* More than CALIBRATE_SHARE of all pixels. */
enum { MOST = CALIBRATE_VIEWS * CALIBRATE_SIDE * CALIBRATE_SIDE / 2000 + 1 };

/* Of the n values the one at place k < MOST in descending order; k < n. */
static float find_place(const float *x, size_t n, size_t k)
{
	float best[MOST];
	size_t found = 0;

	for (size_t i = 0; i < n; i++) {
		if (found > k && !(x[i] > best[k]))
			continue;
		size_t at = found > k ? k : found++;
		for (; at > 0 && x[i] > best[at - 1]; at--)
			best[at] = best[at - 1];
		best[at] = x[i];
	}
	return best[k];
}

static int is_zero(const float *x, size_t n)
{
	for (size_t i = 0; i < n; i++)
		if (x[i] != 0)
			return 0;
	return 1;
}

/* Renders the views: images (count,pixels), a sentence's views side by side. */
static int render_all(const struct splats *s, const struct camera *views, int n, const float *responses,
	size_t count, float *images, size_t pixels, struct err *e)
{
	SCOPED_BY(render_release) struct render_view *v = NULL;
	size_t at = 0;

	for (int i = 0; i < n; i++) {
		const size_t own = (size_t)views[i].width * (size_t)views[i].height;
		SCOPED float *own_images = mem_alloc(count, own * sizeof *own_images, "images", e);
		if (!own_images ||
			(v ? render_again(v, s, &views[i], e) : !(v = render_prepare(s, &views[i], e))))
			return -1;
		render_packed(v, responses, (int)count, own_images, NULL);
		for (size_t r = 0; r < count; r++)
			memcpy(images + r * pixels + at, own_images + r * own, own * sizeof *images);
		at += own;
	}
	return 0;
}

/* Adds each sentence's lift to the responses of the Gaussians with rows. */
static void lift_all(float *responses, size_t count, const struct rows *rows, const double *lifts)
{
	for (size_t first = 0; first < count; first += RENDER_GROUP) {
		const size_t now = count - first < RENDER_GROUP ? count - first : RENDER_GROUP;
#pragma omp parallel for schedule(static)
		for (size_t i = 0; i < rows->gaussians; i++) {
			float *own = responses + first * rows->gaussians + i * now;
			for (size_t r = 0; r < now && rows->of[i] >= 0; r++)
				own[r] += (float)lifts[first + r];
		}
	}
}

int calibrate(const struct splats *s, const struct cameras *cameras, const struct rows *rows,
	float *responses, size_t count, double *lifts, struct err *e)
{
	struct camera views[CALIBRATE_VIEWS];
	const int view_count = (int)cameras_spread(cameras, CALIBRATE_VIEWS, CALIBRATE_SIDE, views);
	size_t pixels = 0;

	for (int i = 0; i < view_count; i++)
		pixels += (size_t)views[i].width * (size_t)views[i].height;
	const size_t place = (size_t)(CALIBRATE_SHARE * (double)pixels);
	SCOPED float *images = mem_alloc(count, pixels * sizeof *images, "images", e);
	int bad = images ? render_all(s, views, view_count, responses, count, images, pixels, e) : -1;
	if (!bad) {
#pragma omp parallel for schedule(dynamic)
		for (size_t r = 0; r < count; r++) {
			const float *image = images + r * pixels;
			lifts[r] = 0;
			/* nothing seen, or a sentence without words: no answer to lift */
			if (!is_zero(image, pixels))
				lifts[r] = fmax(0, CALIBRATE_PEAK - (double)find_place(image, pixels, place));
		}
		lift_all(responses, count, rows, lifts);
	}
	return bad;
}
