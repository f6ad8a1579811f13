/* Objects lifted from masks: against plain float64 by the definitions, for hard cases, and whatever the
 * number of threads. */
#include "unit.h"

#include "base/rng.h"
#include "lift/lift_objects.h"
#include "splat/backproject.h"

#include <omp.h>

enum {
	H = 12,
	W = 20,
	P = H * W,
	N = 150,
	UNSEEN = 10,
	ENTRIES = 8,
	VIEWS = 6,
	O = 19,
	MOST = VIEWS * O * 2
};

/* Pixels have none to ENTRIES weights; the last Gaussians have none. */
struct random_view {
	int64_t indptr[P + 1];
	int32_t index[P * ENTRIES];
	float weight[P * ENTRIES];
};

struct problem {
	struct random_view views[VIEWS];
	struct view_weights weights[VIEWS];
	size_t count[VIEWS];
	struct lift_mask masks[VIEWS][2 * O];
	struct mask shown[MOST];
	size_t shown_count;
};

static struct view_weights make_view(struct random_view *v, struct rng *r)
{
	int64_t n = 0;

	for (int p = 0; p < P; p++) {
		v->indptr[p] = n;
		/* near Gaussians have near numbers, as they would have places */
		for (uint32_t left = rng_below(r, ENTRIES + 1); left; left--, n++) {
			v->index[n] = (int32_t)(((uint32_t)p / 2 + rng_below(r, 30)) % (N - UNSEEN));
			v->weight[n] = (float)(rng_uniform(r) / ENTRIES);
		}
	}
	v->indptr[P] = n;
	return (struct view_weights){P, N, v->indptr, v->index, v->weight};
}

/* Adds a mask of the columns from..to-1 of a view, as large as its weights or `times` as large. */
static void add_mask(struct problem *q, int view, size_t object, int from, int to, int times)
{
	const int h = H * times, w = W * times;
	uint8_t *pixels = malloc((size_t)h * (size_t)w);
	struct mask *mask = &q->shown[q->shown_count++];
	struct err e;

	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++)
			pixels[y * w + x] = x >= from * times && x < to * times;
	CHECK(!rle_encode(&mask->rle, pixels, h, w, &e), "%s", e.message);
	free(pixels);
	q->masks[view][q->count[view]++] = (struct lift_mask){mask, object};
}

static void problem_free(struct problem *q)
{
	for (size_t i = 0; i < q->shown_count; i++)
		rle_free(&q->shown[i].rle);
	free(q);
}

/* Masks of different places in each view, some missing, some twice, some empty, of two sizes. */
static struct problem *make_random(uint64_t seed)
{
	struct problem *q = calloc(1, sizeof *q);
	struct rng r;

	rng_seed(&r, seed, 1);
	for (int v = 0; v < VIEWS; v++) {
		q->weights[v] = make_view(&q->views[v], &r);
		for (size_t o = 0; o < O; o++)
			for (uint32_t left = rng_below(&r, 3); left; left--) {
				const int from = (int)((o + rng_below(&r, 3)) % W);
				add_mask(q, v, o, from, from + (int)rng_below(&r, 6),
					1 + (int)rng_below(&r, 2));
			}
	}
	return q;
}

static int lift(const struct problem *q, size_t objects, struct lifted *to, struct lift_objects *l)
{
	struct err e;

	*to = (struct lifted){0};
	if (!CHECK(!lift_objects_init(l, N, objects, &e), "%s", e.message))
		return -1;
	for (int round = 0; round < LIFT_ROUNDS; round++) {
		for (int v = 0; v < VIEWS; v++)
			CHECK(!lift_objects_view(l, &q->weights[v], H, W, q->masks[v], q->count[v], &e), "%s",
				e.message);
		CHECK(!lift_objects_settle(l, &e), "%s", e.message);
	}
	return CHECK(!lift_objects_finish(l, to, &e), "%s", e.message) ? 0 : -1;
}

/* The mean of an object's masks in a view; how many it has. */
static int naive_mask(const struct problem *q, int v, size_t o, double *mask)
{
	uint8_t pixels[P];
	int n = 0;

	memset(mask, 0, P * sizeof *mask);
	for (size_t k = 0; k < q->count[v]; k++)
		if (q->masks[v][k].object == o) {
			struct rle r;
			struct err e;
			CHECK(!rle_resize(&r, &q->masks[v][k].mask->rle, H, W, &e), "%s", e.message);
			rle_decode(&r, pixels);
			rle_free(&r);
			for (int p = 0; p < P; p++)
				mask[p] += pixels[p];
			n++;
		}
	for (int p = 0; p < P && n; p++)
		mask[p] /= n;
	return n;
}

static double naive_agreement(const struct view_weights *w, const double *mask, const double *share)
{
	double both = 0, either = 0;

	for (int p = 0; p < P; p++) {
		double rendered = 0, total = 0;
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
			total += (double)w->weight[k];
			rendered += (double)w->weight[k] * share[w->index[k]];
		}
		const double a = total > 0 ? rendered / total : 0;
		both += fmin(a, mask[p]);
		either += fmax(a, mask[p]);
	}
	return either > 0 ? both / either : 1;
}

static double share_of[O][N], weight_of[O][N], mean_agreement[O];

static void naive_round(const struct problem *q, int round)
{
	static double sum[O][N];

	memset(sum, 0, sizeof sum);
	memset(weight_of, 0, sizeof weight_of);
	for (size_t o = 0; o < O; o++) {
		double mask[P];
		int n = 0;
		mean_agreement[o] = 0;
		for (int v = 0; v < VIEWS; v++) {
			const struct view_weights *w = &q->weights[v];
			if (!naive_mask(q, v, o, mask))
				continue;
			const double a = round ? naive_agreement(w, mask, share_of[o]) : 1;
			const double vote = fmax(a * a, 0.01);
			mean_agreement[o] += a;
			n++;
			for (int p = 0; p < P; p++)
				for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
					sum[o][w->index[k]] += vote * (double)w->weight[k] * mask[p];
					weight_of[o][w->index[k]] += vote * (double)w->weight[k];
				}
		}
		mean_agreement[o] /= n ? n : 1;
		for (int i = 0; i < N; i++)
			share_of[o][i] = sum[o][i] / (weight_of[o][i] + 0.01);
	}
}

static void naive_settle(int is_last)
{
	double level[O];

	for (size_t o = 0; o < O; o++) {
		double sum = 0, squares = 0;
		for (int i = 0; i < N; i++) {
			sum += share_of[o][i] * weight_of[o][i];
			squares += share_of[o][i] * share_of[o][i] * weight_of[o][i];
		}
		level[o] = sum > 0 ? squares / sum : 1;
	}
	for (int i = 0; i < N; i++) {
		size_t winner = 0;
		for (size_t o = 1; o < O; o++)
			if (share_of[o][i] > share_of[winner][i])
				winner = o;
		const double most = share_of[winner][i];
		for (size_t o = 0; o < O; o++) {
			double *a = &share_of[o][i];
			if (o != winner)
				*a = is_last && most > 0 ? *a * *a / most : 0;
		}
		for (size_t o = 0; o < O; o++)
			share_of[o][i] = fmin(1, share_of[o][i] / level[o]);
	}
}

static void test_naive(uint64_t seed)
{
	struct problem *q = make_random(seed);
	struct lift_objects l;
	struct lifted got;
	double worst = 0;
	size_t large = 0;

	for (int round = 0; round < LIFT_ROUNDS; round++) {
		naive_round(q, round);
		naive_settle(round == LIFT_ROUNDS - 1);
	}
	if (!lift(q, O, &got, &l)) {
		for (size_t o = 0; o < O; o++) {
			double shares[N] = {0};
			for (int64_t k = got.indptr[o]; k < got.indptr[o + 1]; k++) {
				shares[got.index[k]] = (double)got.share[k];
				large += got.share[k] > 0.5f;
				CHECK(got.index[k] < N - UNSEEN, "a share of Gaussian %d, which no view sees",
					got.index[k]);
			}
			/* those below half a step are left out */
			for (int i = 0; i < N; i++)
				worst = fmax(worst, fmax(0, fabs(shares[i] - share_of[o][i]) -
								    (shares[i] > 0 ? 0 : 0.5 / 255)));
			worst = fmax(worst, fabs((double)got.confidence[o] - mean_agreement[o]));
		}
		CHECK(worst < 1e-4 && large > 20, "off by %g, %zu large", worst, large);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	problem_free(q);
}

static void test_threads(void)
{
	struct problem *q = make_random(7);
	struct lift_objects l[2];
	struct lifted got[2];
	const int before = omp_get_max_threads();
	int bad = 0;

	for (int k = 0; k < 2; k++) {
		omp_set_num_threads(k ? 7 : 1);
		bad |= lift(q, O, &got[k], &l[k]);
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
	problem_free(q);
}

/* Every view sees Gaussian c in column c, and the others not at all. */
static struct problem *make_plain(void)
{
	struct problem *q = calloc(1, sizeof *q);

	for (int v = 0; v < VIEWS; v++) {
		for (int p = 0; p < P; p++) {
			q->views[v].indptr[p + 1] = p + 1;
			q->views[v].index[p] = p % W;
			q->views[v].weight[p] = 0.9f;
		}
		q->weights[v] = (struct view_weights){
			P, N, q->views[v].indptr, q->views[v].index, q->views[v].weight};
	}
	return q;
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
	struct problem *q = make_plain();
	struct lift_objects l;
	struct lifted got;

	/* a third of the masks of object 0 show something else, the same or object 1; object 2 is taken for
	 * object 0 in half of its views and for something else in none */
	for (int v = 0; v < VIEWS; v++) {
		add_mask(q, v, 0, v % 3 ? 2 : 14, v % 3 ? 6 : 19, 1);
		add_mask(q, v, 1, 8, 12, 1);
		add_mask(q, v, 2, v % 2 ? 8 : 12, v % 2 ? 12 : 14, 1);
	}
	if (!lift(q, 3, &got, &l)) {
		check_columns(&got, 0, 2, 6, "a third is wrong");
		check_columns(&got, 1, 8, 12, "all are right");
		check_columns(&got, 2, 12, 14, "half are another object's");
		CHECK(got.confidence[1] > 0.99f && got.confidence[0] > 0.5f && got.confidence[0] < 0.7f,
			"confidence %g and %g", (double)got.confidence[1], (double)got.confidence[0]);
	}
	lifted_free(&got);
	lift_objects_free(&l);
	problem_free(q);
}

static void test_few_masks(void)
{
	struct problem *q = make_plain();
	struct lift_objects l;
	struct lifted got;

	add_mask(q, 3, 0, 5, 9, 3);
	add_mask(q, 1, 1, 4, 4, 1);
	/* two of one view are averaged: what is in one alone is just above the cut, or below it in the third
	 */
	add_mask(q, 2, 2, 10, 12, 1);
	add_mask(q, 2, 2, 10, 12, 2);
	add_mask(q, 2, 2, 10, 14, 1);
	if (!lift(q, 4, &got, &l)) {
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
	problem_free(q);
}

int main(void)
{
	for (uint64_t seed = 1; seed <= 3; seed++)
		test_naive(seed);
	test_threads();
	test_wrong_masks();
	test_few_masks();
	return unit_end();
}
