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

/* A problem's weights become those of a packed file, in both forms. */
static int pack_views(struct lift_problem *q, struct weights_room *rooms)
{
	int bad = 0;

	for (int v = 0; v < VIEWS; v++) {
		struct view_weights *w = &q->weights[v].rows;
		struct weights_pack pack;
		struct err e;
		bad |= pack_whole(&pack, W, H, N, w->indptr, w->index, w->weight, &e) ||
		       weights_unpack(&pack, W, H, N, "w", &rooms[v], &e);
		weights_pack_free(&pack);
		*w = (struct view_weights){P, N, rooms[v].indptr, rooms[v].index, rooms[v].weight};
		q->weights[v].tiles = &rooms[v].tiles;
	}
	return bad;
}

static void test_tiles(uint64_t seed)
{
	static struct weights_room rooms[VIEWS];
	struct lift_problem *q = lift_random(seed);
	struct lift_objects l;
	struct lifted got;

	if (CHECK(!pack_views(q, rooms) && !lift_problem(q, O, &got, &l), "lifts packed weights")) {
		const double worst = lift_twin_error(q, &got);
		CHECK(worst < 1e-6, "off by %g", worst);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	for (int v = 0; v < VIEWS; v++)
		weights_room_free(&rooms[v]);
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
