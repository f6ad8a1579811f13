/* Objects lifted from masks: against plain float64 by the definitions, for hard cases, and whatever the
 * number of threads; from tiles as from rows of pixels. */
#include "unit.h"

#include "lift_twin.h"
#include "pack_whole.h"

#include <omp.h>

static void test_naive(uint64_t seed)
{
	struct lift_problem *q = lift_random(seed);
	struct lift_objects l;
	struct lifted got;
	size_t large = 0;

	if (CHECK(!lift_problem(q, O, &got, &l), "lifts")) {
		for (int64_t k = 0; k < got.indptr[O]; k++) {
			large += got.share[k] > 0.5f;
			CHECK(got.index[k] < N - UNSEEN, "a share of Gaussian %d, which no view sees",
				got.index[k]);
		}
		const double worst = lift_twin_error(q, &got);
		CHECK(worst < 1e-4 && large > 20, "off by %g, %zu large", worst, large);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	lift_problem_free(q);
}

static void test_threads(void)
{
	struct lift_problem *q = lift_random(7);
	struct lift_objects l[2];
	struct lifted got[2];
	const int before = omp_get_max_threads();
	int bad = 0;

	for (int k = 0; k < 2; k++) {
		omp_set_num_threads(k ? 7 : 1);
		bad |= lift_problem(q, O, &got[k], &l[k]);
	}
	omp_set_num_threads(before);
	if (!bad) {
		const size_t n = (size_t)got[0].indptr[O] * sizeof(float);
		CHECK(!memcmp(got[0].indptr, got[1].indptr, (O + 1) * sizeof *got[0].indptr) &&
				!memcmp(got[0].share, got[1].share, n) &&
				!memcmp(got[0].index, got[1].index, n) &&
				!memcmp(got[0].confidence, got[1].confidence, O * sizeof(float)),
			"7 threads differ from 1");
	}
	for (int k = 0; k < 2; k++) {
		lifted_free(&got[k]);
		lift_objects_free(&l[k]);
	}
	lift_problem_free(q);
}

/* A problem's weights as those of a packed file: rows of pixels, and tiles. */
struct packed_view {
	struct weights_room room;
};

static int pack_view(const struct view_weights *w, struct packed_view *to)
{
	struct weights_pack pack;
	struct err e;

	const int bad = pack_whole(&pack, W, H, N, w->indptr, w->index, w->weight, &e) ||
			weights_unpack(&pack, W, H, N, "w", &to->room, &e);
	weights_pack_free(&pack);
	return bad;
}

/* Lifts with tiles in the later rounds, or with rows alone. */
static int lift_packed(const struct lift_problem *q, const struct packed_view *views, int with_tiles,
	struct lift_objects *l, struct lifted *to)
{
	struct lift_scratch s = {0};
	struct err e;
	int bad = lift_objects_init(l, N, O, VIEWS, &e);

	*to = (struct lifted){0};
	for (int round = 0; round < LIFT_ROUNDS && !bad; round++) {
		for (size_t v = 0; v < VIEWS && !bad; v++) {
			const struct view_weights rows = {
				P, N, views[v].room.indptr, views[v].room.index, views[v].room.weight};
			bad = round && with_tiles ? lift_objects_again(l, &s, v, &views[v].room.tiles,
							    q->masks[v], q->count[v], &e)
						  : lift_objects_view(l, &s, v, &rows, H, W, q->masks[v],
							    q->count[v], &e);
		}
		bad = bad || lift_objects_settle(l, &e);
	}
	lift_scratch_free(&s);
	return bad || lift_objects_finish(l, to, &e);
}

static void test_tiles(uint64_t seed)
{
	struct lift_problem *q = lift_random(seed);
	struct packed_view *views = calloc(VIEWS, sizeof *views);
	struct lift_objects l[2] = {{0}};
	struct lifted got[2] = {{0}};
	int bad = 0;

	for (int v = 0; v < VIEWS; v++)
		bad |= pack_view(&q->weights[v], &views[v]);
	for (int k = 0; k < 2; k++)
		bad = bad || lift_packed(q, views, k, &l[k], &got[k]);
	if (CHECK(!bad, "lifts packed weights")) {
		const size_t n = (size_t)got[0].indptr[O] * sizeof(float);
		CHECK(n && !memcmp(got[0].indptr, got[1].indptr, (O + 1) * sizeof *got[0].indptr) &&
				!memcmp(got[0].share, got[1].share, n) &&
				!memcmp(got[0].index, got[1].index, n) &&
				!memcmp(got[0].confidence, got[1].confidence, O * sizeof(float)),
			"tiles differ from rows");
	}
	for (int k = 0; k < 2; k++) {
		lifted_free(&got[k]);
		lift_objects_free(&l[k]);
	}
	for (int v = 0; v < VIEWS; v++) {
		weights_room_free(&views[v].room);
	}
	free(views);
	lift_problem_free(q);
}

/* Exactly the Gaussians from..to-1 are in the object. */
static void check_columns(const struct lifted *l, size_t object, int from, int to, const char *what)
{
	float responses[N];

	lifted_responses(l, object, responses);
	for (int i = 0; i < N; i++)
		CHECK((responses[i] > 0) == (i >= from && i < to), "%s: Gaussian %d has %g", what, i,
			(double)responses[i]);
}

static void test_wrong_masks(void)
{
	struct lift_problem *q = lift_plain();
	struct lift_objects l;
	struct lifted got;

	/* a third of the masks of object 0 show something else, the same or object 1; object 2 is taken for
	 * object 0 in half of its views and for something else in none */
	for (int v = 0; v < VIEWS; v++) {
		lift_add_mask(q, v, 0, v % 3 ? 2 : 14, v % 3 ? 6 : 19, 1);
		lift_add_mask(q, v, 1, 8, 12, 1);
		lift_add_mask(q, v, 2, v % 2 ? 8 : 12, v % 2 ? 12 : 14, 1);
	}
	if (CHECK(!lift_problem(q, 3, &got, &l), "lifts")) {
		check_columns(&got, 0, 2, 6, "a third is wrong");
		check_columns(&got, 1, 8, 12, "all are right");
		check_columns(&got, 2, 12, 14, "half are another object's");
		CHECK(got.confidence[1] > 0.99f && got.confidence[0] > 0.5f && got.confidence[0] < 0.7f,
			"confidence %g and %g", (double)got.confidence[1], (double)got.confidence[0]);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	lift_problem_free(q);
}

static void test_few_masks(void)
{
	struct lift_problem *q = lift_plain();
	struct lift_objects l;
	struct lifted got;

	lift_add_mask(q, 3, 0, 5, 9, 3);
	lift_add_mask(q, 1, 1, 4, 4, 1);
	/* two of one view are averaged: what is in one alone is just above the cut, or below it in the third
	 */
	lift_add_mask(q, 2, 2, 10, 12, 1);
	lift_add_mask(q, 2, 2, 10, 12, 2);
	lift_add_mask(q, 2, 2, 10, 14, 1);
	if (CHECK(!lift_problem(q, 4, &got, &l), "lifts")) {
		check_columns(&got, 0, 5, 9, "one mask");
		check_columns(&got, 1, 0, 0, "an empty mask");
		check_columns(&got, 2, 10, 12, "three masks of one view");
		check_columns(&got, 3, 0, 0, "no mask");
		CHECK(got.confidence[0] > 0.99f, "one mask agrees with itself: %g",
			(double)got.confidence[0]);
		CHECK(got.confidence[3] == 0, "no mask, no confidence: %g", (double)got.confidence[3]);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	lift_problem_free(q);
}

int main(void)
{
	for (uint64_t seed = 1; seed <= 3; seed++)
		test_naive(seed);
	for (uint64_t seed = 11; seed <= 13; seed++)
		test_tiles(seed);
	test_threads();
	test_wrong_masks();
	test_few_masks();
	return unit_end();
}
