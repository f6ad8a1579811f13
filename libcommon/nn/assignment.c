#include "nn/assignment.h"

#include "base/mem.h"

#include <math.h>
#include <stdint.h>

#define NONE SIZE_MAX

/* Costs are negated values. The potentials keep cost - row - column at 0 or above, and at 0 on what is
 * assigned, so that the cheapest path to a free column is found as Dijkstra finds it. */
struct work {
	size_t columns;
	const double *value;
	double *row, *column; /* potentials */
	double *distance;     /* (columns) of the cheapest path so far */
	size_t *from;	      /* (columns) the column before on that path, or NONE at its start */
	size_t *owner;	      /* (columns) row, or NONE */
	unsigned char *is_done;
};

/* Goes on from a column that is reached, or from the start; `row` is there and `base` away. Returns the
 * nearest column that is not yet done. */
static size_t search(struct work *w, size_t row, size_t at, double base)
{
	size_t nearest = NONE;

	for (size_t j = 0; j < w->columns; j++) {
		if (w->is_done[j])
			continue;
		double d = base - w->value[row * w->columns + j] - w->row[row] - w->column[j];
		if (d < w->distance[j]) {
			w->distance[j] = d;
			w->from[j] = at;
		}
		if (nearest == NONE || w->distance[j] < w->distance[nearest])
			nearest = j;
	}
	return nearest;
}

static void assign_row(struct work *w, size_t row)
{
	for (size_t j = 0; j < w->columns; j++) {
		w->distance[j] = INFINITY;
		w->is_done[j] = 0;
	}
	size_t at = search(w, row, NONE, 0);
	while (w->owner[at] != NONE) {
		w->is_done[at] = 1;
		at = search(w, w->owner[at], at, w->distance[at]);
	}
	const double length = w->distance[at];
	w->row[row] += length;
	for (size_t j = 0; j < w->columns; j++)
		if (w->is_done[j]) {
			w->row[w->owner[j]] += length - w->distance[j];
			w->column[j] -= length - w->distance[j];
		}
	for (size_t before; (before = w->from[at]) != NONE; at = before)
		w->owner[at] = w->owner[before];
	w->owner[at] = row;
}

int assignment_best(const double *value, size_t rows, size_t columns, size_t *column, struct err *e)
{
	struct work w = {columns, value, mem_zalloc(rows, sizeof *w.row, "assignment", e),
		mem_zalloc(columns, sizeof *w.column, "assignment", e),
		mem_alloc(columns, sizeof *w.distance, "assignment", e),
		mem_alloc(columns, sizeof *w.from, "assignment", e),
		mem_alloc(columns, sizeof *w.owner, "assignment", e), mem_alloc(columns, 1, "assignment", e)};
	int bad = !w.row || !w.column || !w.distance || !w.from || !w.owner || !w.is_done;

	for (size_t j = 0; j < columns && !bad; j++)
		w.owner[j] = NONE;
	for (size_t i = 0; i < rows && !bad; i++)
		assign_row(&w, i);
	for (size_t j = 0; j < columns && !bad; j++)
		if (w.owner[j] != NONE)
			column[w.owner[j]] = j;
	mem_free_all(w.row, w.column, w.distance, w.from, w.owner, w.is_done);
	return bad ? -1 : 0;
}
