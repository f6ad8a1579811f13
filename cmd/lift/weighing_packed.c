#include "cmd/lift/weighing.h"

#include "base/largest.h"
#include "base/mem.h"
#include "base/threads.h"
#include "formats/scene/weights.h"
#include "splat/prune.h"

#include <omp.h>

enum {
	PART_WIDTH = 4 * RENDER_PART, /* pixels: their weights take half a megabyte */
	TILE_ROWS = RENDER_PART / VIEW_TILE,
};

/* One thread's. */
struct packing_room {
	struct render_weights rendered;
	struct weights_packer packer;
	float dropped[PART_WIDTH * RENDER_PART];
};

size_t weighing_cover(const float *transmittance, size_t pixels)
{
	size_t covered = 0;

	for (size_t p = 0; p < pixels; p++)
		covered += transmittance[p] < 0.5F;
	return covered;
}

/* Of a row of parts. */
struct counted {
	size_t weights, covered;
};

/* What all parts have in common. */
struct packing {
	const struct render_view *view;
	int width, height;
	double tolerance;
	float *dropped;		   /* (P) */
	struct weights_pack *rows; /* of tiles */
	struct counted *counted;   /* (rows of parts) */
};

static int pack_part(
	const struct packing *p, struct packing_room *r, const struct render_part *part, struct err *e)
{
	const size_t width = (size_t)part->width, height = (size_t)part->height, pixels = width * height;
	struct render_weights *w = &r->rendered;

	if (render_weights_part(p->view, part, w, e) ||
		prune_weights(w, pixels, p->tolerance, WEIGHTS_U8_LEAST, r->dropped, e))
		return -1;
	for (size_t y = 0; y < height; y++)
		memcpy(p->dropped + ((size_t)part->y + y) * (size_t)p->width + (size_t)part->x,
			r->dropped + y * width, width * sizeof *r->dropped);
	struct counted *counted = &p->counted[part->y / RENDER_PART];
	counted->weights += (size_t)w->indptr[pixels];
	counted->covered += weighing_cover(w->transmittance, pixels);
	const struct weights_picture picture = {part->width, part->height, w->indptr, w->index, w->weight};
	return weights_pack_part(p->rows + part->y / VIEW_TILE, &r->packer, &picture, e);
}

/* The parts from row y of the pixels on. */
static int pack_row(const struct packing *p, struct packing_room *r, int y, struct err *e)
{
	for (int x = 0; x < p->width; x += PART_WIDTH) {
		const struct render_part part = {
			x, y, least_of(PART_WIDTH, p->width - x), least_of(RENDER_PART, p->height - y)};
		if (pack_part(p, r, &part, e))
			return -1;
	}
	return 0;
}

static struct packing_room *room_make(size_t gaussians, struct err *e)
{
	struct packing_room *r = mem_zalloc(1, sizeof *r, "weights", e);

	if (!r || !weights_packer_make(&r->packer, gaussians, e))
		return r;
	weights_packer_free(&r->packer);
	free(r);
	return NULL;
}

static void room_free(struct packing_room *r)
{
	if (!r)
		return;
	render_weights_free(&r->rendered);
	weights_packer_free(&r->packer);
	free(r);
}

static void free_rooms(struct weighed_packed *w)
{
	for (int k = 0; k < w->room_count; k++)
		room_free(w->rooms[k]);
	free(w->rooms);
	w->rooms = NULL;
	w->room_count = 0;
}

static void free_rows(struct weighed_packed *w)
{
	for (int k = 0; k < w->row_count; k++)
		weights_pack_free(&w->rows[k]);
	free(w->rows);
	w->rows = NULL;
	w->row_count = 0;
}

void weighed_packed_free(struct weighed_packed *w)
{
	weights_pack_free(&w->pack);
	free_rooms(w);
	free_rows(w);
}

static int make_rooms(struct weighed_packed *w, int threads, size_t gaussians, struct err *e)
{
	if (threads <= w->room_count)
		return 0;
	free_rooms(w);
	w->rooms = mem_zalloc((size_t)threads, sizeof *w->rooms, "weights", e);
	if (!w->rooms)
		return -1;
	for (w->room_count = 0; w->room_count < threads; w->room_count++)
		if (!(w->rooms[w->room_count] = room_make(gaussians, e)))
			return -1;
	return 0;
}

static int make_rows(struct weighed_packed *w, int count, struct err *e)
{
	if (count <= w->row_count)
		return 0;
	free_rows(w);
	w->rows = mem_zalloc((size_t)count, sizeof *w->rows, "weights", e);
	w->row_count = w->rows ? count : 0;
	return w->rows ? 0 : -1;
}

static int pack_rows(const struct packing *p, struct packing_room **rooms, int threads, struct err *e)
{
	int failed = 0;

#pragma omp parallel num_threads(threads) reduction(| : failed)
	{
		struct err mine;
		struct packing_room *r = rooms[omp_get_thread_num()];
#pragma omp for schedule(dynamic)
		for (int y = 0; y < p->height; y += RENDER_PART)
			failed = failed || pack_row(p, r, y, &mine);
		if (failed) {
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

int weigh_packed(struct weighed_packed *to, const struct render_view *v, const struct camera *c,
	size_t gaussians, double tolerance, float *dropped, struct err *e)
{
	const int count = (c->height + VIEW_TILE - 1) / VIEW_TILE,
		  parts = (count + TILE_ROWS - 1) / TILE_ROWS, threads = threads_available();
	SCOPED struct counted *counted = mem_zalloc((size_t)parts, sizeof *counted, "weights", e);
	int bad = !counted || make_rows(to, count, e) || make_rooms(to, threads, gaussians, e);
	const struct packing p = {v, c->width, c->height, tolerance, dropped, to->rows, counted};

	bad = bad || pack_rows(&p, to->rooms, threads, e) || weights_pack_join(&to->pack, to->rows, count, e);
	to->weights = to->covered = 0;
	for (int k = 0; k < parts && !bad; k++) {
		to->weights += counted[k].weights;
		to->covered += counted[k].covered;
	}
	return bad ? -1 : 0;
}
