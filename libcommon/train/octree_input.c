#include "train/octree_input.h"

#include "base/mem.h"
#include "base/rng.h"
#include "splat/backproject.h"

#include <math.h>

enum { K = OCTREE_SIGNATURE, STREAM_SIGNATURE = 3 };

void octree_input_footprints(
	const float *means, size_t n, const struct camera *cameras, size_t count, float *footprint)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++) {
		double least = INFINITY;
		for (size_t v = 0; v < count; v++) {
			const struct camera *c = &cameras[v];
			const double mean[3] = {
				(double)means[3 * i], (double)means[3 * i + 1], (double)means[3 * i + 2]};
			double at[3];
			camera_transform(c, mean, at);
			if (!(at[2] > 0))
				continue;
			const double x = c->fx * at[0] / at[2] + c->cx, y = c->fy * at[1] / at[2] + c->cy;
			if (x >= 0 && x <= c->width && y >= 0 && y <= c->height)
				least = fmin(least, at[2] / fmax(c->fx, c->fy));
		}
		footprint[i] = (float)least;
	}
}

/* The direction of an object. */
static void direction(int object, float d[K])
{
	struct rng r;

	rng_seed(&r, (uint64_t)object, STREAM_SIGNATURE);
	for (int k = 0; k < K; k++)
		d[k] = rng_below(&r, 2) ? 0.25f : -0.25f; /* 1/sqrt(K) */
}

/* The sum of a view's masks at each pixel: at (K,P). */
static void sum_masks(const struct train_view *v, const int *objects, float *at)
{
	const size_t pixels = v->weights.pixels;

	memset(at, 0, sizeof *at * K * pixels);
	for (int i = 0; i < v->count; i++) {
		const int object = objects[v->sentences[i]];
		int same = 0;
		float d[K];
		for (int j = 0; j < v->count; j++)
			same += objects[v->sentences[j]] == object;
		direction(object, d);
		for (int k = 0; k < K; k++)
			d[k] /= (float)same;
		for (size_t p = 0; p < pixels; p++) {
			if (!(v->masks[i][p / 8] >> p % 8 & 1))
				continue;
			for (size_t k = 0; k < K; k++)
				at[k * pixels + p] += d[k];
		}
	}
}

/* sum: what all views have, each of them at a time in memory. at: room for the largest. */
static int add_views(
	const struct view_source *views, const int *objects, float *at, float *sum, struct err *e)
{
	struct view_weights w;

	for (size_t v = 0; v < views->n; v++) {
		sum_masks(&views->views[v], objects, at);
		if (view_source_open(views, v, &w, e))
			return -1;
		backproject_add(&w, at, K, sum);
		view_source_close(views, v);
	}
	return 0;
}

int octree_input_signatures(const struct view_source *views, const int *objects, size_t scene_gaussians,
	const double *weight, float *signature, struct err *e)
{
	size_t pixels = 0;

	for (size_t v = 0; v < views->n; v++)
		pixels = views->views[v].weights.pixels > pixels ? views->views[v].weights.pixels : pixels;
	SCOPED float *at = mem_alloc(pixels, K * sizeof *at, "signatures", e);
	SCOPED float *sum = mem_zalloc(
		scene_gaussians, backproject_groups(K) * VIEW_GROUP * sizeof *sum, "signatures", e);
	const int bad = !at || !sum || add_views(views, objects, at, sum, e);
	for (size_t i = 0; i < scene_gaussians && !bad; i++)
		for (size_t k = 0; k < K; k++)
			signature[i * K + k] = weight[i] > 0 ? sum[backproject_index(scene_gaussians, k, i)] /
								       (float)weight[i]
							     : 0;
	return bad ? -1 : 0;
}
