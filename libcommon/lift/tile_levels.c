#include "lift/tile_levels.h"

#include "base/mem.h"
#include "base/ones.h"

/* The levels of so many differences; returns their sum. */
static uint32_t take_entry(const uint8_t *restrict differences, uint8_t *restrict levels, size_t n)
{
	uint32_t total = 0;
	uint8_t level = 0;

	for (size_t k = 0; k < n; k++) {
		level = (uint8_t)(level + differences[k]);
		levels[k] = level;
		total += level;
	}
	return total;
}

/* The entries of a row of tiles. */
static void take_row(const struct tile_levels *l, int row)
{
	const struct view_tiles *t = l->tiles;
	const size_t first = (size_t)row * (size_t)t->across;
	size_t at = t->level_begin[row];

	for (size_t i = t->begin[first], end = t->begin[first + (size_t)t->across]; i < end; i++) {
		const size_t n = ones(view_tiles_map(t, i));
		l->begin[i] = at;
		l->total[i] = (uint16_t)take_entry(t->levels + at, l->levels + at, n);
		at += n;
	}
}

int tile_levels_make(struct tile_levels *l, const struct view_tiles *t, struct err *e)
{
	const size_t entries = t->begin[(size_t)t->across * (size_t)t->down];

	*l = (struct tile_levels){t, mem_alloc(entries, sizeof *l->begin, "weights", e),
		mem_alloc(t->level_begin[t->down], 1, "weights", e),
		mem_alloc(entries, sizeof *l->total, "weights", e)};
	if (!l->begin || !l->levels || !l->total) {
		tile_levels_free(l);
		return -1;
	}
#pragma omp parallel for schedule(dynamic)
	for (int row = 0; row < t->down; row++)
		take_row(l, row);
	return 0;
}

void tile_levels_free(struct tile_levels *l)
{
	mem_free_all(l->begin, l->levels, l->total);
	*l = (struct tile_levels){0};
}
