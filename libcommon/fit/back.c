#include "fit/back.h"

#include "base/mem.h"
#include "base/threads.h"
#include "splat/place.h"
#include "splat/view.h"

#include <omp.h>

static const struct back_kernels *back_kernels_of(enum cpu_level level)
{
#if defined __x86_64__
	if (level == CPU_AVX512)
		return &back_avx512;
	if (level == CPU_AVX2)
		return &back_avx2;
#else
	(void)level;
#endif
	return &back_plain;
}

void back_free(struct back_room *r)
{
	mem_free_all(r->parts, r->done);
	*r = (struct back_room){0};
}

/* What a tile's pixels begin with. Pixels outside the image have no light and count for nothing. */
static void start(struct back_tile *b, const struct tile_grid *g, struct place at, const float *image,
	const float *gradient)
{
	const size_t pixels = (size_t)g->width * (size_t)g->height;

	memset(b, 0, sizeof *b);
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x++) {
			const size_t from = place_pixel(g, at, x, y);
			const int to = blend_place(x, y);
			for (size_t c = 0; c < 3; c++) {
				b->d[c][to] = gradient[c * pixels + from];
				b->rest[to] += gradient[c * pixels + from] * image[c * pixels + from];
			}
		}
}

/* Adds the tiles' parts of the Gaussians [begin,end), tile after tile whoever does it. */
static void gather(
	const struct render_view *v, const struct back_room *room, size_t begin, size_t end, float *sums)
{
	const size_t tiles = (size_t)v->grid.columns * (size_t)v->grid.rows;

	memset(sums + begin * BACK_SUMS, 0, (end - begin) * BACK_SUMS * sizeof *sums);
	for (size_t k = 0; k < tiles; k++) {
		const size_t first = v->tiles.start[k];
		for (size_t i = first; i < first + room->done[k]; i++) {
			const size_t index = v->tiles.entries[i];
			if (index < begin || index >= end)
				continue;
			for (size_t s = 0; s < BACK_SUMS; s++)
				sums[index * BACK_SUMS + s] += room->parts[i * BACK_SUMS + s];
		}
	}
}

int back_view(const struct render_view *v, const float *colors, const float *image, const float *gradient,
	float *sums, struct back_room *room, struct err *e)
{
	const struct back_kernels *kernels = back_kernels_of(v->level);
	const size_t tiles = (size_t)v->grid.columns * (size_t)v->grid.rows;

	if (mem_room((void **)&room->parts, &room->part_room, v->tiles.start[tiles],
		    BACK_SUMS * sizeof *room->parts, "gradients", e) ||
		mem_room((void **)&room->done, &room->done_room, tiles, sizeof *room->done, "gradients", e))
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < tiles; k++) {
		const struct place at = place_of_tile(&v->grid, k);
		const size_t begin = v->tiles.start[k];
		struct blend_tile t __attribute__((aligned(64)));
		struct back_tile b __attribute__((aligned(64)));
		struct back_sums own __attribute__((aligned(64)));
		blend_start(&t, at.x, at.y, at.columns, at.rows, 0);
		start(&b, &v->grid, at, image, gradient);
		room->done[k] = kernels->tile(&t, &b, &own, v->projected, v->tiles.entries + begin,
			v->tiles.start[k + 1] - begin, colors, room->parts + begin * BACK_SUMS);
	}
#pragma omp parallel num_threads(threads_available())
	{
		const size_t part = (size_t)omp_get_thread_num(), all = (size_t)omp_get_num_threads();
		gather(v, room, v->gaussians * part / all, v->gaussians * (part + 1) / all, sums);
	}
	return 0;
}
