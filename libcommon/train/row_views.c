#include "train/row_views.h"

#include "base/each.h"
#include "base/mem.h"

static size_t indptr_bytes(const struct view_weights *w)
{
	return (w->pixels + 1) * sizeof *w->indptr;
}

static size_t weights_bytes(const struct view_weights *w)
{
	return indptr_bytes(w) + (size_t)w->indptr[w->pixels] * (sizeof *w->index + sizeof *w->weight);
}

/* Moves a view's weights from memory into the file. */
static int move_to_file(struct row_views *r, size_t view, struct err *e)
{
	struct view_weights *w = &r->views[view].weights;
	const size_t count = (size_t)w->indptr[w->pixels], pixels = w->pixels, rows = w->gaussians;
	const struct scratch_piece pieces[] = {{w->indptr, indptr_bytes(w)},
		{w->index, count * sizeof *w->index}, {w->weight, count * sizeof *w->weight}};

	if (scratch_put(&r->file, pieces, sizeof pieces / sizeof *pieces, &r->parts[view], e))
		return -1;
	rows_view_free(w);
	*w = (struct view_weights){.pixels = pixels, .gaussians = rows};
	r->filed++;
	return 0;
}

/* What making them takes. */
struct making {
	struct row_views *to;
	const struct rows *rows;
	const struct view_source *from;
	size_t room, largest; /* of the file's views, in bytes */
};

static int make_view(void *context, int worker, size_t view, struct err *e)
{
	const struct making *m = context;
	struct view_weights w;

	(void)worker;
	if (view_source_open(m->from, view, &w, e))
		return -1;
	const int bad = rows_view(m->rows, &w, &m->to->views[view].weights, e);
	view_source_close(m->from, view);
	return bad;
}

/* Keeps the view in memory where it has room there, beside the largest of the file's. */
static int place_view(void *context, size_t view, struct err *e)
{
	struct making *m = context;
	struct row_views *r = m->to;
	const struct view_weights *w = &r->views[view].weights;
	const size_t bytes = weights_bytes(w);

	r->weights += (double)w->indptr[w->pixels];
	if (r->kept + bytes + m->largest <= m->room) {
		r->kept += bytes;
		return 0;
	}
	m->largest = bytes > m->largest ? bytes : m->largest;
	return move_to_file(r, view, e);
}

/* Where the file's largest view came late there may be too many in memory. */
static int make_room(struct making *m, struct err *e)
{
	struct row_views *r = m->to;

	for (size_t v = r->n; v-- > 0 && r->filed && r->kept && r->kept + m->largest > m->room;) {
		const struct view_weights *w = &r->views[v].weights;
		const size_t bytes = w->indptr ? weights_bytes(w) : 0;
		if (bytes && move_to_file(r, v, e))
			return -1;
		r->kept -= bytes;
		m->largest = bytes > m->largest ? bytes : m->largest;
	}
	return 0;
}

/* Views that are made at a time have room, each with the weights that it is made from. */
static int workers(const struct view_source *from, size_t room)
{
	const int most = each_workers(from->n);
	const size_t fit = from->largest ? room / from->largest / 2 : (size_t)most;

	return fit < (size_t)most ? (fit ? (int)fit : 1) : most;
}

int row_views_make(struct row_views *r, const struct rows *rows, const struct view_source *from,
	const struct row_views_room *room, struct err *e)
{
	struct making m = {.to = r, .rows = rows, .from = from, .room = room->bytes};
	const struct each by = {&m, workers(from, room->bytes), make_view, place_view};

	*r = (struct row_views){.file.path = room->path};
	omp_init_lock(&r->lock);
	r->views = mem_zalloc(from->n, sizeof *r->views, "views", e);
	r->parts = mem_zalloc(from->n, sizeof *r->parts, "views", e);
	r->maps = mem_zalloc(from->n, sizeof *r->maps, "views", e);
	if (!r->views || !r->parts || !r->maps)
		return -1;
	r->n = from->n;
	for (size_t v = 0; v < r->n; v++) {
		r->views[v] = from->views[v];
		r->views[v].weights = (struct view_weights){.pixels = from->views[v].weights.pixels};
	}
	return -(each_run(&by, r->n, e) || make_room(&m, e));
}

void row_views_free(struct row_views *r)
{
	for (size_t v = 0; v < r->n; v++)
		rows_view_free(&r->views[v].weights);
	if (r->views)
		omp_destroy_lock(&r->lock);
	scratch_close(&r->file);
	mem_free_all(r->views, r->parts, r->maps);
	*r = (struct row_views){0};
}

static int open_view(void *context, size_t view, struct view_weights *w, struct err *e)
{
	struct row_views *r = context;
	const struct view_weights *sizes = &r->views[view].weights;

	omp_set_lock(&r->lock);
	if (scratch_map(&r->file, &r->parts[view], &r->maps[view], e)) {
		omp_unset_lock(&r->lock);
		return -1;
	}
	const unsigned char *at = r->maps[view].data;
	*w = *sizes;
	w->indptr = (const int64_t *)(const void *)at;
	w->index = (const int32_t *)(const void *)(at + indptr_bytes(w));
	w->weight = (const float *)(w->index + w->indptr[w->pixels]);
	return 0;
}

static void close_view(void *context, size_t view)
{
	struct row_views *r = context;

	file_unmap(&r->maps[view]);
	omp_unset_lock(&r->lock);
}

struct view_source row_views_source(struct row_views *r)
{
	return (struct view_source){r->views, r->n, open_view, close_view, r, 0};
}

void row_views_ahead(const struct row_views *r, size_t view)
{
	if (!r->views[view].weights.indptr)
		scratch_ahead(&r->file, &r->parts[view]);
}
