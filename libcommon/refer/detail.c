#include "refer/detail.h"

#include "base/mem.h"
#include "base/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { K = OCTREE_SIGNATURE, STREAM_SIGNATURE = 3 };

void detail_footprints(
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

/* The sum of a view's masks at each pixel: at (P,K). */
static void sum_masks(const struct train_view *v, const int *objects, float *at)
{
	memset(at, 0, sizeof *at * K * v->weights.pixels);
	for (int i = 0; i < v->count; i++) {
		const int object = objects[v->sentences[i]];
		int same = 0;
		float d[K];
		for (int j = 0; j < v->count; j++)
			same += objects[v->sentences[j]] == object;
		direction(object, d);
		for (int k = 0; k < K; k++)
			d[k] /= (float)same;
		for (size_t p = 0; p < v->weights.pixels; p++) {
			if (!(v->masks[i][p / 8] >> p % 8 & 1))
				continue;
			for (int k = 0; k < K; k++)
				at[p * K + (size_t)k] += d[k];
		}
	}
}

int detail_signatures(const struct train_view *views, size_t view_count, const int *objects,
	size_t scene_gaussians, float *weight, float *signature, struct err *e)
{
	size_t pixels = 0;

	for (size_t v = 0; v < view_count; v++)
		pixels = views[v].weights.pixels > pixels ? views[v].weights.pixels : pixels;
	float *at = mem_alloc(pixels, K * sizeof *at, "signatures", e);
	if (!at)
		return -1;
	memset(weight, 0, sizeof *weight * scene_gaussians);
	memset(signature, 0, sizeof *signature * K * scene_gaussians);
	for (size_t v = 0; v < view_count; v++) {
		const struct view_weights *w = &views[v].weights;
		sum_masks(&views[v], objects, at);
		for (size_t p = 0; p < w->pixels; p++)
			for (int64_t i = w->indptr[p]; i < w->indptr[p + 1]; i++) {
				float *to = signature + (size_t)w->index[i] * K;
				weight[w->index[i]] += w->weight[i];
				for (size_t k = 0; k < K; k++)
					to[k] += w->weight[i] * at[p * K + k];
			}
	}
	for (size_t i = 0; i < scene_gaussians; i++)
		for (size_t k = 0; k < K && weight[i] > 0; k++)
			signature[i * K + k] /= weight[i];
	free(at);
	return 0;
}
