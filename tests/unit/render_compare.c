#include "render_compare.h"

#include "base/rng.h"
#include "splat/render.h"
#include "splat/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct camera camera_at_origin(int width, int height, double focal)
{
	struct camera c = {.width = width,
		.height = height,
		.fx = focal,
		.fy = focal,
		.cx = 0.5 * width,
		.cy = 0.5 * height};

	for (int i = 0; i < 4; i++)
		c.world_to_camera[i][i] = 1;
	return c;
}

struct splats make_splats(size_t n)
{
	struct splats s;
	struct err e;

	if (splats_alloc(&s, n, 1, &e))
		abort();
	return s;
}

void set_splat(struct splats *s, size_t i, const double mean[3], const double scale[3], double opacity)
{
	for (int k = 0; k < 3; k++) {
		s->means[3 * i + (size_t)k] = (float)mean[k];
		s->scales[3 * i + (size_t)k] = (float)scale[k];
		s->sh[3 * i + (size_t)k] = 0.1f * (float)k;
	}
	memcpy(s->quats + 4 * i, (float[4]){1, 0, 0, 0}, 4 * sizeof(float));
	s->opacities[i] = (float)opacity;
}

struct splats random_splats(uint64_t seed, size_t n, double size, double spread)
{
	struct splats s = make_splats(n);
	struct rng r;

	rng_seed(&r, seed, 1);
	for (size_t i = 0; i < n; i++) {
		double z = rng_range(&r, -0.5, 6), mean[3], scale[3];
		mean[0] = z * rng_range(&r, -0.9, 0.9);
		mean[1] = z * rng_range(&r, -0.9, 0.9);
		mean[2] = z;
		for (int k = 0; k < 3; k++)
			scale[k] = size * exp(spread * rng_normal(&r));
		set_splat(&s, i, mean, scale, rng_uniform(&r));
		for (size_t k = 0; k < 4; k++)
			s.quats[4 * i + k] = (float)(3 * rng_normal(&r));
	}
	return s;
}

static void compare_pixel(const struct render_weights *w, size_t p, const struct twin_pixel *truth,
	struct render_report *report)
{
	int64_t begin = w->indptr[p];
	size_t n = (size_t)(w->indptr[p + 1] - begin);
	double sum = w->transmittance[p], worst = fabs((double)w->transmittance[p] - truth->transmittance);
	int is_same = n == truth->n;

	for (size_t k = 0; k < n; k++)
		sum += w->weight[begin + (int64_t)k];
	for (size_t k = 0; is_same && k < n; k++) {
		is_same = w->index[begin + (int64_t)k] == truth->index[k];
		worst = fmax(worst, fabs((double)w->weight[begin + (int64_t)k] - truth->weight[k]));
	}
	report->pixels++;
	report->nnz += (double)n;
	report->sum = fmax(report->sum, fabs(sum - 1));
	if (is_same) {
		report->weight = fmax(report->weight, worst);
	} else {
		report->cuts++;
		report->cut_margin = fmax(report->cut_margin, truth->margin);
	}
}

struct render_report render_compare(
	const struct splats *s, const struct camera *c, enum cpu_level level, size_t stride)
{
	struct err e = {0};
	struct render_weights w;
	struct render_report report = {0};
	struct twin twin;

	struct render_view *v = render_prepare(s, c, &e);
	if (!v)
		return report;
	v->level = level;
	if (!render_weights(v, &w, &e)) {
		twin_prepare(&twin, s, c);
		struct twin_pixel truth = {.index = malloc((twin.n + 1) * sizeof *truth.index),
			.weight = malloc((twin.n + 1) * sizeof *truth.weight)};
		for (size_t p = 0; p < (size_t)c->width * (size_t)c->height; p += stride) {
			twin_blend(&twin, (int)(p % (size_t)c->width), (int)(p / (size_t)c->width), &truth);
			compare_pixel(&w, p, &truth, &report);
		}
		free(truth.index);
		free(truth.weight);
		twin_free(&twin);
		render_weights_free(&w);
	}
	render_free(v);
	return report;
}

struct splats needle_splats(void)
{
	struct splats s = make_splats(400);
	struct rng r;

	rng_seed(&r, 3, 1);
	for (size_t i = 0; i < s.n; i++) {
		double length = exp(rng_range(&r, -3, 7)), z = rng_range(&r, 0.3, 5);
		set_splat(&s, i, (double[3]){rng_range(&r, -1, 1) * z, rng_range(&r, -1, 1) * z, z},
			(double[3]){length, length * 1e-6, length * 1e-6}, rng_range(&r, 0.01, 0.3));
		double turn = rng_range(&r, 0, 3.14159265);
		memcpy(s.quats + 4 * i, (float[4]){(float)cos(turn / 2), 0, 0, (float)sin(turn / 2)},
			4 * sizeof(float));
		if (i % 2)
			for (size_t k = 0; k < 4; k++)
				s.quats[4 * i + k] = (float)rng_normal(&r);
	}
	return s;
}

struct splats odd_scale_splats(void)
{
	struct splats s = make_splats(5);

	set_splat(&s, 0, (double[3]){0, 0, 2}, (double[3]){0, 0, 0}, 0.9);
	set_splat(&s, 1, (double[3]){0.3, 0.1, 3}, (double[3]){1e8, 1e8, 1e8}, 0.5);
	set_splat(&s, 2, (double[3]){0.3, 0.1, 4}, (double[3]){1e8, 0, 0}, 0.7);
	set_splat(&s, 3, (double[3]){-0.3, 0.1, 5}, (double[3]){0.2, 0, 1e4}, 0.7);
	set_splat(&s, 4, (double[3]){-0.3, 0.1, 6}, (double[3]){1e30, 1e30, 0}, 0.6);
	return s;
}

struct splats close_splats(struct camera *c)
{
	struct splats s = make_splats(202);
	struct rng r;

	rng_seed(&r, 6, 1);
	memcpy(c->world_to_camera[2], (double[4]){1e-9, 0, 1, 0}, sizeof c->world_to_camera[2]);
	for (size_t i = 0; i < 200; i++)
		set_splat(&s, i, (double[3]){rng_range(&r, -0.1, 0.1), 0, 2}, (double[3]){1, 1, 1}, 0.01);
	set_splat(&s, 200, (double[3]){0, 0, 0.3}, (double[3]){0.1, 0.1, 0.1}, 0.01);
	set_splat(&s, 201, (double[3]){0, 0, 1e30}, (double[3]){1e30, 1e30, 1e30}, 0.01);
	return s;
}

struct splats layer_splats(size_t n)
{
	struct splats s = make_splats(n);

	for (size_t i = 0; i < s.n; i++)
		set_splat(&s, i, (double[3]){0, 0, 10 - 5 * (double)i / (double)n},
			(double[3]){900, 900, 900}, 0.0041);
	return s;
}
