#include "splat/render.h"

#include "base/mem.h"
#include "splat/kernels.h"
#include "splat/sh.h"
#include "splat/view.h"

#include <stdlib.h>
#include <string.h>

struct render_view *render_prepare(const struct splats *s, const struct camera *c, struct err *e)
{
	struct render_view *v = mem_zalloc(1, sizeof *v, "view", e);

	if (!v)
		return NULL;
	*v = (struct render_view){
		.width = c->width, .height = c->height, .gaussians = s->n, .level = cpu_level()};
	if (!project_splats(s, c, v->level, &v->projected, &v->visible, e) &&
		!tile_build(&v->tiles, v->projected, v->visible, v->width, v->height, e))
		return v;
	render_free(v);
	return NULL;
}

void render_free(struct render_view *v)
{
	if (!v)
		return;
	tile_free(&v->tiles);
	free(v->projected);
	free(v);
}

/* A tile's place in the image: corner, and the part of it that lies inside. */
struct place {
	int x, y, columns, rows;
};

static struct place tile_place(const struct render_view *v, size_t tile)
{
	int x = (int)(tile % (size_t)v->tiles.columns) * TILE_SIZE,
	    y = (int)(tile / (size_t)v->tiles.columns) * TILE_SIZE;
	int columns = v->width - x, rows = v->height - y;

	return (struct place){
		x, y, columns < TILE_SIZE ? columns : TILE_SIZE, rows < TILE_SIZE ? rows : TILE_SIZE};
}

/* The image's pixel at column x and row y of the tile. */
static size_t place_pixel(const struct render_view *v, struct place at, int x, int y)
{
	return (size_t)(at.y + y) * (size_t)v->width + (size_t)(at.x + x);
}

/* Copies the tile's part of a plane into the image's. */
static void put_plane(const struct render_view *v, struct place at, const float *plane, float *image)
{
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			image[place_pixel(v, at, x, y)] = plane[blend_place(x, y)];
}

/* Blends up to BLEND_CHANNELS planes; `values` is (visible, channels). */
static void blend_planes(
	const struct render_view *v, const float *values, int channels, float *out, float *transmittance)
{
	const struct kernels *kernels = kernels_of(v->level);
	size_t tiles = (size_t)v->tiles.columns * (size_t)v->tiles.rows,
	       pixels = (size_t)v->width * (size_t)v->height;

#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < tiles; k++) {
		struct place at = tile_place(v, k);
		size_t begin = v->tiles.start[k], n = v->tiles.start[k + 1] - begin;
		struct blend_tile t __attribute__((aligned(64)));
		blend_start(&t, at.x, at.y, at.columns, at.rows);
		kernels->values(&t, v->projected, v->tiles.entries + begin, n, values, channels);
		for (int c = 0; c < channels; c++)
			put_plane(v, at, t.sum[c], out + (size_t)c * pixels);
		if (transmittance)
			put_plane(v, at, t.transmittance, transmittance);
	}
}

int render_values(const struct render_view *v, const float *values, int channels, float *out,
	float *transmittance, struct err *e)
{
	size_t pixels = (size_t)v->width * (size_t)v->height;
	int most = channels < BLEND_CHANNELS ? channels : BLEND_CHANNELS;
	float *some = mem_alloc(v->visible, (size_t)most * sizeof *some, "values", e);

	if (!some)
		return -1;
	for (int first = 0; first < channels; first += BLEND_CHANNELS) {
		int now = channels - first < BLEND_CHANNELS ? channels - first : BLEND_CHANNELS;
#pragma omp parallel for schedule(static)
		for (size_t i = 0; i < v->visible; i++)
			for (int c = 0; c < now; c++)
				some[i * (size_t)now + (size_t)c] =
					values[(size_t)(first + c) * v->gaussians +
						(size_t)v->projected[i].index];
		blend_planes(v, some, now, out + (size_t)first * pixels, transmittance);
	}
	free(some);
	return 0;
}

int render_colors(const struct render_view *v, const struct splats *s, const struct camera *c,
	const float background[3], float *rgb, struct err *e)
{
	size_t pixels = (size_t)v->width * (size_t)v->height;
	float *colors = mem_alloc(v->visible, 3 * sizeof *colors, "colours", e);
	float *planes = mem_alloc(pixels, 4 * sizeof *planes, "image", e);
	double centre[3];
	int bad = -1;

	if (!colors || !planes)
		goto done;
	camera_centre(c, centre);
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < v->visible; i++) {
		size_t k = (size_t)v->projected[i].index;
		const float *mean = s->means + 3 * k;
		double direction[3] = {mean[0] - centre[0], mean[1] - centre[1], mean[2] - centre[2]};
		sh_color(s->sh + 3 * (size_t)s->sh_coefficients * k, s->sh_coefficients, direction,
			colors + 3 * i);
	}
	blend_planes(v, colors, 3, planes, planes + 3 * pixels);
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++)
		for (size_t k = 0; k < 3; k++) {
			float x = planes[k * pixels + p] + background[k] * planes[3 * pixels + p];
			rgb[3 * p + k] = x < 0 ? 0 : x > 1 ? 1 : x;
		}
	bad = 0;
done:
	free(colors);
	free(planes);
	return bad;
}

static int grow_records(struct blend_records *r, struct err *e)
{
	return mem_grow((void **)&r->items, &r->capacity, r->count + BLEND_RECORD_ROOM, sizeof *r->items,
		       "weights", e) ||
	       mem_grow((void **)&r->weights, &r->weight_capacity, r->weight_count + BLEND_WEIGHT_ROOM,
		       sizeof *r->weights, "weights", e);
}

/* Records a tile's weights, and for each of its pixels how many there are (in indptr, one place on) and what
 * is left. */
static int record_tile(const struct render_view *v, size_t k, struct blend_records *records,
	struct render_weights *w, struct err *e)
{
	const struct kernels *kernels = kernels_of(v->level);
	struct place at = tile_place(v, k);
	const uint32_t *list = v->tiles.entries + v->tiles.start[k];
	size_t n = v->tiles.start[k + 1] - v->tiles.start[k], done = 0;
	struct blend_tile t __attribute__((aligned(64)));

	blend_start(&t, at.x, at.y, at.columns, at.rows);
	while (done < n) {
		if (grow_records(records, e))
			return -1;
		done += kernels->weights(&t, v->projected, list + done, n - done, records);
	}
	put_plane(v, at, t.transmittance, w->transmittance);
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			w->indptr[place_pixel(v, at, x, y) + 1] = t.count[blend_place(x, y)];
	return 0;
}

/* Distributes a tile's records over its pixels' rows of the matrix, and frees them. */
static void scatter_tile(
	const struct render_view *v, size_t k, struct blend_records *records, struct render_weights *w)
{
	struct place at = tile_place(v, k);
	const float *weight = records->weights;
	int64_t next[TILE_PIXELS];

	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++)
			next[blend_place(x, y)] = w->indptr[place_pixel(v, at, x, y)];
	for (size_t i = 0; i < records->count; i++) {
		struct blend_record one = records->items[i];
		for (unsigned left = one.lanes; left; left &= left - 1) {
			int64_t place = next[one.block * BLEND_LANES + __builtin_ctz(left)]++;
			w->index[place] = one.index;
			w->weight[place] = *weight++;
		}
	}
	free(records->items);
	free(records->weights);
	*records = (struct blend_records){0};
}

int render_weights(const struct render_view *v, struct render_weights *w, struct err *e)
{
	size_t pixels = (size_t)v->width * (size_t)v->height,
	       tiles = (size_t)v->tiles.columns * (size_t)v->tiles.rows;
	struct blend_records *records = mem_zalloc(tiles, sizeof *records, "weights", e);
	int bad = -1;

	*w = (struct render_weights){0};
	w->indptr = mem_alloc(pixels + 1, sizeof *w->indptr, "weights", e);
	w->transmittance = mem_alloc(pixels, sizeof *w->transmittance, "weights", e);
	if (!records || !w->indptr || !w->transmittance)
		goto done;
	int failed = 0;
#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t k = 0; k < tiles; k++) {
		struct err mine;
		if (!failed && record_tile(v, k, &records[k], w, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	if (failed)
		goto done;
	w->indptr[0] = 0;
	for (size_t p = 0; p < pixels; p++)
		w->indptr[p + 1] += w->indptr[p];
	w->index = mem_alloc((size_t)w->indptr[pixels], sizeof *w->index, "weights", e);
	w->weight = mem_alloc((size_t)w->indptr[pixels], sizeof *w->weight, "weights", e);
	if (!w->index || !w->weight)
		goto done;
#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < tiles; k++)
		scatter_tile(v, k, &records[k], w);
	bad = 0;
done:
	for (size_t k = 0; records && k < tiles; k++) {
		free(records[k].items);
		free(records[k].weights);
	}
	free(records);
	if (bad)
		render_weights_free(w);
	return bad;
}

void render_weights_free(struct render_weights *w)
{
	free(w->indptr);
	free(w->index);
	free(w->weight);
	free(w->transmittance);
	*w = (struct render_weights){0};
}
