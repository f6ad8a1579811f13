/* Views with weights over rows, in memory and in a file: the same arrays wherever they are, and how many have
 * room.
 */
#include "unit.h"

#include "base/rng.h"
#include "train/row_views.h"

#include <omp.h>

enum { GAUSSIANS = 60, ROWS = 20, VIEWS = 6, PIXELS = 50, ENTRIES = 7 };

/* View v has PIXELS + v pixels; the source reads those that are odd. */
struct sample {
	int64_t indptr[VIEWS][PIXELS + VIEWS + 1];
	int32_t index[VIEWS][(PIXELS + VIEWS) * ENTRIES], of[GAUSSIANS];
	float weight[VIEWS][(PIXELS + VIEWS) * ENTRIES];
	struct train_view views[VIEWS];
	struct view_weights whole[VIEWS], over_rows[VIEWS];
	int opened[VIEWS], closed[VIEWS], fails;
};

static int open_view(void *context, size_t view, struct view_weights *w, struct err *e)
{
	struct sample *s = context;

	s->opened[view]++;
	*w = s->whole[view];
	return s->fails == (int)view ? err_set(e, ERR_SYSTEM, "view %zu", view) : 0;
}

static void close_view(void *context, size_t view)
{
	((struct sample *)context)->closed[view]++;
}

static void sample_init(struct sample *s, struct rows *rows)
{
	struct rng r;
	struct err e;

	*s = (struct sample){.fails = -1};
	rng_seed(&r, 6, 1);
	for (int i = 0; i < GAUSSIANS; i++)
		s->of[i] = (int32_t)rng_below(&r, ROWS + 1) - 1;
	*rows = (struct rows){GAUSSIANS, ROWS, s->of};
	for (int v = 0; v < VIEWS; v++) {
		int64_t n = 0;
		for (int p = 0; p < PIXELS + v; p++) {
			s->indptr[v][p] = n;
			for (uint32_t left = rng_below(&r, ENTRIES + 1); left; left--, n++) {
				s->index[v][n] = (int32_t)rng_below(&r, GAUSSIANS);
				s->weight[v][n] = (float)rng_uniform(&r);
			}
		}
		s->indptr[v][PIXELS + v] = n;
		s->whole[v] = (struct view_weights){
			(size_t)(PIXELS + v), GAUSSIANS, s->indptr[v], s->index[v], s->weight[v]};
		s->views[v] = (struct train_view){.weights = s->whole[v], .count = v};
		if (v % 2)
			s->views[v].weights = (struct view_weights){.pixels = s->whole[v].pixels};
		CHECK(!rows_view(rows, &s->whole[v], &s->over_rows[v], &e), "%s", e.message);
	}
}

static size_t bytes_of(const struct view_weights *w)
{
	return (w->pixels + 1) * sizeof *w->indptr + (size_t)w->indptr[w->pixels] * 8;
}

static void check_view(const struct view_weights *got, const struct view_weights *expected, size_t v)
{
	const size_t n = (size_t)expected->indptr[expected->pixels];

	if (CHECK(got->pixels == expected->pixels && got->gaussians == expected->gaussians,
		    "view %zu: its size", v))
		CHECK(!memcmp(got->indptr, expected->indptr, (got->pixels + 1) * sizeof *got->indptr) &&
				!memcmp(got->index, expected->index, n * sizeof *got->index) &&
				!memcmp(got->weight, expected->weight, n * sizeof *got->weight),
			"view %zu: its weights", v);
}

/* All of them, by many threads at a time. */
static void check_views(struct row_views *r, const struct sample *s)
{
	const struct view_source views = row_views_source(r);

#pragma omp parallel for schedule(dynamic) num_threads(4)
	for (size_t k = 0; k < 4 * VIEWS; k++) {
		const size_t v = k % VIEWS;
		struct view_weights w;
		struct err e;
		row_views_ahead(r, v);
		const int bad = view_source_open(&views, v, &w, &e);
#pragma omp critical(check)
		{
			if (CHECK(!bad, "%s", e.message))
				check_view(&w, &s->over_rows[v], v);
			CHECK(r->views[v].count == (int)v, "view %zu: its sentences", v);
		}
		if (!bad)
			view_source_close(&views, v);
	}
}

/* The views that are kept, and the largest of the others, have room. */
static void test_room(struct sample *s, const struct rows *rows, size_t room, size_t filed)
{
	const struct view_source from = {s->views, VIEWS, open_view, close_view, s, 1000};
	const struct row_views_room where = {room, "/tmp/test_row_views"};
	struct row_views r;
	struct err e;
	size_t kept = 0, largest = 0;
	double weights = 0;

	memset(s->opened, 0, sizeof s->opened);
	memset(s->closed, 0, sizeof s->closed);
	if (CHECK(!row_views_make(&r, rows, &from, &where, &e), "%s", e.message)) {
		for (size_t v = 0; v < VIEWS; v++) {
			const size_t bytes = bytes_of(&s->over_rows[v]);
			const int is_kept = r.views[v].weights.indptr != NULL;
			kept += is_kept ? bytes : 0;
			largest = !is_kept && bytes > largest ? bytes : largest;
			weights += (double)s->over_rows[v].indptr[s->over_rows[v].pixels];
			CHECK(s->opened[v] == (int)v % 2 && s->closed[v] == (int)v % 2,
				"view %zu: opened %d times", v, s->opened[v]);
		}
		CHECK(r.filed == filed, "room of %zu: %zu are in the file, expected %zu", room, r.filed,
			filed);
		CHECK(r.kept == kept && r.weights == weights, "room of %zu: %zu bytes", room, r.kept);
		CHECK(!kept || kept + largest <= room, "room of %zu: %zu and %zu", room, kept, largest);
		check_views(&r, s);
	}
	row_views_free(&r);
}

/* What fails is said, and leaves nothing. */
static void test_failures(struct sample *s, const struct rows *rows)
{
	const struct view_source from = {s->views, VIEWS, open_view, close_view, s, 0};
	const struct row_views_room nowhere = {0, "/tmp/none/x"}, somewhere = {0, "/tmp/test_row_views"};
	struct row_views r;
	struct err e;

	CHECK(row_views_make(&r, rows, &from, &nowhere, &e) && e.code == ERR_SYSTEM &&
			!strcmp(e.message, "/tmp/none/x: No such file or directory"),
		"%s", e.message);
	row_views_free(&r);
	s->fails = 3;
	CHECK(row_views_make(&r, rows, &from, &somewhere, &e) && !strcmp(e.message, "view 3"), "%s",
		e.message);
	row_views_free(&r);
}

int main(void)
{
	static struct sample s;
	struct rows rows;
	size_t all = 0, first;

	sample_init(&s, &rows);
	for (int v = 0; v < VIEWS; v++)
		all += bytes_of(&s.over_rows[v]);
	first = bytes_of(&s.over_rows[0]);
	for (int threads = 1; threads <= 3; threads += 2) {
		omp_set_num_threads(threads);
		test_room(&s, &rows, SIZE_MAX, 0);
		test_room(&s, &rows, all, 0);
		test_room(&s, &rows, all - 1, 2); /* beside the one that has none, another must go */
		test_room(&s, &rows, 0, VIEWS);
		test_room(&s, &rows, first, VIEWS);
	}
	test_failures(&s, &rows);
	for (int v = 0; v < VIEWS; v++)
		rows_view_free(&s.over_rows[v]);
	return unit_end();
}
