#include "splat/render.h"

#include "base/mem.h"
#include "splat/kernels.h"
#include "splat/place.h"
#include "splat/sh.h"
#include "splat/view.h"

/* Blends up to BLEND_CHANNELS planes; `values` is (N, channels). */
static void blend_planes(
	const struct render_view *v, const float *values, int channels, float *out, float *transmittance)
{
	const struct kernels *kernels = kernels_of(v->level);
	size_t tiles = (size_t)v->grid.columns * (size_t)v->grid.rows,
	       pixels = (size_t)v->grid.width * (size_t)v->grid.height;

#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < tiles; k++) {
		struct place at = place_of_tile(&v->grid, k);
		const size_t begin = v->tiles.start[k],
			     n = wanted_tile(&v->wanted, &v->grid, k) ? v->tiles.start[k + 1] - begin : 0;
		struct blend_tile t __attribute__((aligned(64)));
		for (int c = 0; c < channels; c++)
			place_fetch(&v->grid, at, out + (size_t)c * pixels);
		blend_start(&t, at.x, at.y, at.columns, at.rows, channels);
		kernels->values(&t, v->projected, v->tiles.entries + begin, n, values, channels);
		for (int c = 0; c < channels; c++)
			place_plane(&v->grid, at, t.sum[c], out + (size_t)c * pixels);
		if (transmittance)
			place_plane(&v->grid, at, t.transmittance, transmittance);
	}
}

static int group_size(int channels, int first)
{
	return channels - first < RENDER_GROUP ? channels - first : RENDER_GROUP;
}

/* The planes `first` to first + now - 1 of values (channels,N), side by side. */
static void interleave(const float *values, size_t n, int first, int now, float *out)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++)
		for (int c = 0; c < now; c++)
			out[i * (size_t)now + (size_t)c] = values[(size_t)(first + c) * n + i];
}

int render_pack(float *values, size_t n, int channels, struct err *e)
{
	const size_t most = (size_t)group_size(channels, 0);
	SCOPED float *some = channels > 1 ? mem_alloc(n, most * sizeof *some, "values", e) : NULL;

	if (channels > 1 && !some)
		return -1;
	for (int first = 0; first < channels && some; first += RENDER_GROUP) {
		int now = group_size(channels, first);
		interleave(values, n, first, now, some);
		memcpy(values + (size_t)first * n, some, n * (size_t)now * sizeof *some);
	}
	return 0;
}

void render_packed(
	const struct render_view *v, const float *values, int channels, float *out, float *transmittance)
{
	size_t pixels = (size_t)v->grid.width * (size_t)v->grid.height;

	for (int first = 0; first < channels; first += RENDER_GROUP)
		blend_planes(v, values + (size_t)first * v->gaussians, group_size(channels, first),
			out + (size_t)first * pixels, first ? NULL : transmittance);
}

int render_values(const struct render_view *v, const float *values, int channels, float *out,
	float *transmittance, struct err *e)
{
	size_t pixels = (size_t)v->grid.width * (size_t)v->grid.height;
	size_t most = (size_t)group_size(channels, 0);

	if (channels == 1) {
		render_packed(v, values, 1, out, transmittance);
		return 0;
	}
	SCOPED float *some = mem_alloc(v->gaussians, most * sizeof *some, "values", e);
	if (!some)
		return -1;
	for (int first = 0; first < channels; first += RENDER_GROUP) {
		int now = group_size(channels, first);
		interleave(values, v->gaussians, first, now, some);
		render_packed(v, some, now, out + (size_t)first * pixels, transmittance);
	}
	return 0;
}

int render_colors(const struct render_view *v, const struct splats *s, const struct camera *c,
	const float background[3], float *rgb, struct err *e)
{
	size_t pixels = (size_t)v->grid.width * (size_t)v->grid.height;
	SCOPED float *colors = mem_alloc(v->gaussians, 3 * sizeof *colors, "colours", e);
	SCOPED float *planes = mem_alloc(pixels, 4 * sizeof *planes, "image", e);
	double centre[3];

	if (!colors || !planes)
		return -1;
	camera_centre(c, centre);
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < v->visible; i++) {
		size_t k = v->sorted[i].index;
		const float *mean = s->means + 3 * k;
		double direction[3] = {mean[0] - centre[0], mean[1] - centre[1], mean[2] - centre[2]};
		sh_color(s->sh + 3 * (size_t)s->sh_coefficients * k, s->sh_coefficients, direction,
			colors + 3 * k);
	}
	blend_planes(v, colors, 3, planes, planes + 3 * pixels);
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++)
		for (size_t k = 0; k < 3; k++) {
			float x = planes[k * pixels + p] + background[k] * planes[3 * pixels + p];
			rgb[3 * p + k] = x < 0 ? 0 : x > 1 ? 1 : x;
		}
	return 0;
}
