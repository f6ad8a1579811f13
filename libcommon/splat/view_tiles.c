#include "splat/view_tiles.h"

#include "base/mem.h"
#include "splat/view_weights.h"

void view_tiles_lookup_make(struct view_tiles_lookup *l, const struct view_tiles *t)
{
	for (int k = 0; k < 256; k++)
		l->weight[k] = (float)k / 255;
	for (int i = 0; i < VIEW_TILE_PIXELS; i++)
		l->pixel[i] = (int64_t)(i / VIEW_TILE) * t->width + i % VIEW_TILE;
}

/* One entry, by itself so that all of it stays in registers. Returns where the levels of the next begin. */
__attribute__((noinline)) static const uint8_t *blend_entry(const struct view_tiles_lookup *of, uint64_t map,
	const uint8_t *more, const float value[VIEW_GROUP], float sums[VIEW_TILE_PIXELS][VIEW_GROUP])
{
	uint8_t level = 0;

	for (; map; map &= map - 1) {
		float *sum = sums[__builtin_ctzll(map)];
		level = (uint8_t)(level + *more++);
		for (int k = 0; k < VIEW_GROUP; k++)
			sum[k] += of->weight[level] * value[k];
	}
	return more;
}

static void blend_row(
	const struct view_tiles *t, const struct view_tiles_lookup *of, int row, const float *m, float *image)
{
	const size_t pixels = (size_t)t->width * (size_t)t->height;
	const uint8_t *more = t->levels + t->level_begin[row];

	for (int column = 0; column < t->across; column++) {
		const size_t tile = (size_t)row * (size_t)t->across + (size_t)column;
		const int x = column * VIEW_TILE, y = row * VIEW_TILE;
		float sums[VIEW_TILE_PIXELS][VIEW_GROUP] = {{0}};
		for (size_t i = t->begin[tile]; i < t->begin[tile + 1]; i++)
			more = blend_entry(
				of, view_tiles_map(t, i), more, m + (size_t)t->ids[i] * VIEW_GROUP, sums);
		for (int i = 0; i < VIEW_TILE_PIXELS; i++) {
			if (x + i % VIEW_TILE >= t->width || y + i / VIEW_TILE >= t->height)
				continue;
			float *to = image + (size_t)y * (size_t)t->width + (size_t)(x + of->pixel[i]);
			for (size_t k = 0; k < VIEW_GROUP; k++)
				to[k * pixels] = sums[i][k];
		}
	}
}

void view_tiles_blend_group(const struct view_tiles *t, const float *m, float *image)
{
	struct view_tiles_lookup of;

	view_tiles_lookup_make(&of, t);
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		blend_row(t, &of, row, m, image);
}

void view_tiles_free(struct view_tiles *t)
{
	mem_free_all(t->begin, t->ids, t->maps, t->level_begin, t->levels);
	*t = (struct view_tiles){0};
}
