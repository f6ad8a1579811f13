#include "splat/weigh_tile.h"

#include "base/mem.h"
#include "base/ones.h"
#include "splat/kernels.h"
#include "splat/view.h"

#include <math.h>

int weigh_tile_start(struct weigh_tile *t, const struct render_view *v, size_t k, struct err *e)
{
	t->view = v;
	t->at = place_of_tile(&v->grid, k);
	t->n = v->tiles.start[k + 1] - v->tiles.start[k];
	t->list = v->tiles.entries + v->tiles.start[k];
	t->made = 0;
	blend_start(&t->pixels, t->at.x, t->at.y, t->at.columns, t->at.rows, 0);
	memset(t->dropped, 0, sizeof t->dropped);
	/* a row is written before it is known whether it has a weight */
	struct blend_rows *r = &t->rows;
	return mem_room((void **)&t->chunks, &t->chunks_room, (t->n + BLEND_CHUNK - 1) / BLEND_CHUNK,
		       sizeof *t->chunks, "weights", e) ||
			       mem_room((void **)&r->weights, &t->weights_room, t->n + BLEND_ROWS_MORE,
				       sizeof *r->weights, "weights", e) ||
			       mem_room((void **)&r->places, &t->places_room, t->n + 1, sizeof *r->places,
				       "weights", e) ||
			       mem_room((void **)&r->lanes, &t->lanes_room, t->n + 1, sizeof *r->lanes,
				       "weights", e)
		       ? -1
		       : 0;
}

void weigh_tile_free(struct weigh_tile *t)
{
	mem_free_all(t->chunks, t->rows.weights, t->rows.places, t->rows.lanes);
}

/* The least float that is not below x. */
static float float_from(double x)
{
	const float near = (float)x;

	return (double)near < x ? nextafterf(near, INFINITY) : near;
}

size_t weigh_tile_block(struct weigh_tile *t, int b, const struct render_limits *limits)
{
	const struct kernels *kernels = kernels_of(t->view->level);
	size_t weights = 0;

	kernels->rows(&t->pixels, t->view->projected, t->list, t->n, b, t->chunks, &t->made, &t->rows);
	if (limits->tolerance > 0 || limits->least > 0)
		kernels->prune(
			&t->rows, limits->tolerance, float_from(limits->least), t->dropped + b * BLEND_LANES);
	for (size_t k = 0; k < t->rows.n; k++)
		weights += ones(t->rows.lanes[k]);
	return weights;
}
