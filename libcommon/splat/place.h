/* A tile's place in the image. */
#pragma once

#include "splat/blend.h"
#include "splat/tile.h"

#include <stddef.h>
#include <string.h>

/* Corner, and the part of it that lies inside. */
struct place {
	int x, y, columns, rows;
};

static inline struct place place_of_tile(const struct tile_grid *g, size_t tile)
{
	int x = (int)(tile % (size_t)g->columns) * TILE_SIZE,
	    y = (int)(tile / (size_t)g->columns) * TILE_SIZE;
	int columns = g->width - x, rows = g->height - y;

	return (struct place){
		x, y, columns < TILE_SIZE ? columns : TILE_SIZE, rows < TILE_SIZE ? rows : TILE_SIZE};
}

/* The image's pixel at column x and row y of the tile. */
static inline size_t place_pixel(const struct tile_grid *g, struct place at, int x, int y)
{
	return (size_t)(at.y + y) * (size_t)g->width + (size_t)(at.x + x);
}

/* Asks for where place_plane will write: much sooner than it does, as memory is slow. */
static inline void place_fetch(const struct tile_grid *g, struct place at, float *image)
{
	for (int y = 0; y < at.rows; y++) {
		float *row = image + place_pixel(g, at, 0, y);
		__builtin_prefetch(row, 1, 2);
		__builtin_prefetch(row + at.columns - 1, 1, 2);
	}
}

/* Copies the tile's part of a plane into the image's. */
static inline void place_plane(const struct tile_grid *g, struct place at, const float *plane, float *image)
{
	for (int y = 0; y < at.rows; y++)
		for (int x = 0; x < at.columns; x += BLEND_SIDE) {
			float *to = image + place_pixel(g, at, x, y);
			const float *from = plane + blend_place(x, y);
			if (at.columns - x >= BLEND_SIDE)
				memcpy(to, from, BLEND_SIDE * sizeof *to);
			else
				memcpy(to, from, (size_t)(at.columns - x) * sizeof *to);
		}
}
