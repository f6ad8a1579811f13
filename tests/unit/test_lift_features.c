/* Features and labels lifted from pictures: against plain float64 by the definitions, pixel by pixel;
 * whatever the blocks of channels and the number of threads; and by hand. */
#include "unit.h"

#include "base/rng.h"
#include "lift/lift_features.h"
#include "lift/lift_labels.h"
#include "lift_twin.h"

#include <omp.h>

enum { SOURCES = 9, CHANNELS = 13, LABELS = 4 };

/* Pixels of each view have a source, or none; the sources have features, of which one is zero. */
struct pictures {
	int32_t source[VIEWS][P];
	float features[VIEWS][SOURCES][CHANNELS];
	double factor[VIEWS][SOURCES];
	int32_t label[VIEWS][SOURCES];
};

static struct pictures *random_pictures(uint64_t seed)
{
	struct pictures *q = calloc(1, sizeof *q);
	struct rng r;

	rng_seed(&r, seed, 1);
	for (int v = 0; v < VIEWS; v++) {
		for (int p = 0; p < P; p++)
			q->source[v][p] = (int32_t)rng_below(&r, SOURCES + 1) - 1;
		for (int k = 0; k < SOURCES; k++) {
			double square = 0;
			for (int c = 0; c < CHANNELS && k; c++) {
				q->features[v][k][c] = (float)(4 * rng_uniform(&r) - 1);
				square += (double)q->features[v][k][c] * (double)q->features[v][k][c];
			}
			q->factor[v][k] = square > 0 ? 1 / sqrt(square) : 0;
			q->label[v][k] = (int32_t)rng_below(&r, LABELS);
		}
	}
	return q;
}

struct lifted_features {
	float mean[N][CHANNELS], reliability[N];
	double weight[N];
};

/* The channels in blocks of `width`. */
static struct lifted_features *lift(const struct lift_problem *w, const struct pictures *q, size_t width)
{
	struct lifted_features *to = calloc(1, sizeof *to);
	struct source_weights s = {0};
	struct lift_features l;
	struct err e = {0};
	int bad = lift_features_init(&l, N, width, &e);

	for (size_t first = 0; first < CHANNELS && !bad; first += width) {
		const size_t n = width < CHANNELS - first ? width : CHANNELS - first;
		lift_features_begin(&l, n);
		for (int v = 0; v < VIEWS && !bad; v++) {
			float features[SOURCES * CHANNELS];
			for (size_t k = 0; k < SOURCES; k++)
				memcpy(features + k * n, q->features[v][k] + first, n * sizeof *features);
			bad = source_weights_make(&s, &w->weights[v].rows, q->source[v], SOURCES, &e);
			if (!bad)
				lift_features_add(&l, n, &s, features, q->factor[v], !first);
		}
		lift_features_end(&l, n);
		for (size_t i = 0; i < N; i++)
			memcpy(to->mean[i] + first, l.sum + i * n, n * sizeof(float));
	}
	CHECK(!bad, "%s", e.message);
	lift_features_reliability(&l, to->reliability);
	memcpy(to->weight, l.weight, sizeof to->weight);
	lift_features_free(&l);
	source_weights_free(&s);
	return to;
}

/* By the definition: the mean over pixels, and its norm. */
static void twin(
	const struct lift_problem *w, const struct pictures *q, double mean[N][CHANNELS], double weight[N])
{
	for (int v = 0; v < VIEWS; v++)
		for (int p = 0; p < P; p++)
			for (int64_t k = w->weights[v].rows.indptr[p]; k < w->weights[v].rows.indptr[p + 1];
				k++) {
				const int i = w->weights[v].rows.index[k], own = q->source[v][p];
				if (own < 0)
					continue;
				weight[i] += (double)w->weights[v].rows.weight[k];
				for (int c = 0; c < CHANNELS; c++)
					mean[i][c] += (double)w->weights[v].rows.weight[k] *
						      q->factor[v][own] * (double)q->features[v][own][c];
			}
	for (int i = 0; i < N; i++)
		for (int c = 0; c < CHANNELS; c++)
			mean[i][c] = weight[i] > 0 ? mean[i][c] / weight[i] : 0;
}

static void test_naive(uint64_t seed)
{
	struct lift_problem *w = lift_random(seed);
	struct pictures *q = random_pictures(seed);
	struct lifted_features *got = lift(w, q, CHANNELS);
	static double mean[N][CHANNELS], weight[N];
	double worst = 0, total = 0;
	int unseen = 0;

	memset(mean, 0, sizeof mean);
	memset(weight, 0, sizeof weight);
	twin(w, q, mean, weight);
	for (int i = 0; i < N; i++) {
		double square = 0;
		for (int c = 0; c < CHANNELS; c++) {
			worst = fmax(worst, fabs(mean[i][c] - (double)got->mean[i][c]));
			square += mean[i][c] * mean[i][c];
		}
		worst = fmax(worst, fabs(sqrt(square) - (double)got->reliability[i]));
		worst = fmax(worst, fabs(weight[i] - got->weight[i]) * 0.1);
		total += (double)got->reliability[i];
		unseen += !(got->weight[i] > 0);
		CHECK(got->weight[i] > 0 || (got->reliability[i] <= 0 && got->mean[i][0] <= 0), "unseen %d",
			i);
	}
	CHECK(worst < 1e-6, "off by %g", worst);
	CHECK(total > 0.2 * N && total < 0.9 * N && unseen >= UNSEEN, "%g, %d unseen", total, unseen);
	free(got);
	free(q);
	lift_problem_free(w);
}

static void test_blocks_and_threads(void)
{
	struct lift_problem *w = lift_random(5);
	struct pictures *q = random_pictures(5);
	const int before = omp_get_max_threads();
	struct lifted_features *expected = lift(w, q, CHANNELS);

	for (int threads = 1; threads <= 7; threads += 3)
		for (size_t width = 1; width <= CHANNELS; width += 3) {
			omp_set_num_threads(threads);
			struct lifted_features *got = lift(w, q, width);
			CHECK(!memcmp(expected, got, sizeof *got), "%d threads, %zu channels at a time",
				threads, width);
			free(got);
		}
	omp_set_num_threads(before);
	free(expected);
	free(q);
	lift_problem_free(w);
}

static void lift_all_labels(const struct lift_problem *w, const struct pictures *q, int32_t *label,
	float *reliability, float *weight)
{
	struct source_weights s = {0};
	struct lift_labels l;
	struct err e = {0};
	int bad = lift_labels_init(&l, N, &e);

	for (int v = 0; v < VIEWS && !bad; v++)
		bad = source_weights_make(&s, &w->weights[v].rows, q->source[v], SOURCES, &e) ||
		      lift_labels_add(&l, &s, q->label[v], &e);
	CHECK(!bad, "%s", e.message);
	lift_labels_end(&l, label, reliability, weight);
	lift_labels_free(&l);
	source_weights_free(&s);
}

static void test_labels(uint64_t seed)
{
	struct lift_problem *w = lift_random(seed);
	struct pictures *q = random_pictures(seed);
	static double votes[N][LABELS];
	int32_t label[N];
	float reliability[N], weight[N];

	lift_all_labels(w, q, label, reliability, weight);
	memset(votes, 0, sizeof votes);
	for (int v = 0; v < VIEWS; v++)
		for (int p = 0; p < P; p++)
			for (int64_t k = w->weights[v].rows.indptr[p]; k < w->weights[v].rows.indptr[p + 1];
				k++)
				if (q->source[v][p] >= 0)
					votes[w->weights[v].rows.index[k]][q->label[v][q->source[v][p]]] +=
						(double)w->weights[v].rows.weight[k];
	for (int i = 0; i < N; i++) {
		double best = 0, sum = 0;
		int winner = LABEL_NONE;
		for (int k = 0; k < LABELS; k++) {
			sum += votes[i][k];
			winner = votes[i][k] > best ? k : winner;
			best = fmax(best, votes[i][k]);
		}
		/* votes that are all but equal may go either way */
		const double own = label[i] < 0 ? 0 : votes[i][label[i]];
		CHECK(fabs(own - best) < 1e-6 && (label[i] < 0) == (winner < 0), "Gaussian %d: %d, not %d", i,
			label[i], winner);
		CHECK(fabs((double)weight[i] - sum) < 1e-5 &&
				fabs((double)reliability[i] - (sum > 0 ? best / sum : 0)) < 1e-6,
			"Gaussian %d: %g of %g", i, (double)reliability[i], (double)weight[i]);
	}
	free(q);
	lift_problem_free(w);
}

/* Every view sees Gaussian c in column c alone. */
static void test_by_hand(void)
{
	struct lift_problem *w = lift_plain();
	struct pictures *q = calloc(1, sizeof *q);
	int32_t label[N];
	float reliability[N], weight[N];

	/* columns 0 to 3 see the x axis in all views; 4 to 7 it in four and the y axis in two; 8 on nothing
	 */
	for (int v = 0; v < VIEWS; v++) {
		q->features[v][0][0] = 3;
		q->factor[v][0] = 1.0 / 3;
		q->features[v][1][1] = 1;
		q->factor[v][1] = 1;
		q->label[v][0] = 2;
		q->label[v][1] = 1;
		for (int p = 0; p < P; p++)
			q->source[v][p] = p % W < 4 ? 0 : p % W < 8 ? v >= 4 : -1;
	}
	struct lifted_features *got = lift(w, q, 2);
	CHECK(fabs((double)got->reliability[2] - 1) < 1e-6 && fabs((double)got->mean[2][0] - 1) < 1e-6,
		"agreed: %g", (double)got->reliability[2]);
	CHECK(fabs((double)got->mean[5][0] - 2.0 / 3) < 1e-6 &&
			fabs((double)got->mean[5][1] - 1.0 / 3) < 1e-6 &&
			fabs((double)got->reliability[5] - sqrt(5) / 3) < 1e-6,
		"two in three: %g", (double)got->reliability[5]);
	CHECK(got->weight[8] <= 0 && got->reliability[8] <= 0, "nothing");
	lift_all_labels(w, q, label, reliability, weight);
	CHECK(label[0] == 2 && label[5] == 2 && label[8] == LABEL_NONE, "%d %d %d", label[0], label[5],
		label[8]);
	CHECK(fabs((double)reliability[5] - 2.0 / 3) < 1e-6, "two in three: %g", (double)reliability[5]);
	for (int p = 0; p < P; p++)
		q->source[3][p] = p % W < 8 ? p % W >= 4 : -1;
	lift_all_labels(w, q, label, reliability, weight);
	CHECK(label[5] == 1, "of equal votes the smaller label: %d", label[5]);
	free(got);
	free(q);
	lift_problem_free(w);
}

static void test_cells(void)
{
	int32_t to[6];

	source_cells(to, 2, 3, 2, 3);
	for (int k = 0; k < 6; k++)
		CHECK(to[k] == k, "as large: %d", to[k]);
	source_cells(to, 2, 3, 1, 2);
	CHECK(to[0] == 0 && to[1] == 1 && to[2] == 1 && to[3] == 0,
		"coarser: the centre of column 1 is in cell 1");
	source_cells(to, 1, 2, 3, 6);
	CHECK(to[0] == 7 && to[1] == 10, "finer: %d %d", to[0], to[1]);
}

int main(void)
{
	for (uint64_t seed = 1; seed <= 3; seed++) {
		test_naive(seed);
		test_labels(seed);
	}
	test_blocks_and_threads();
	test_by_hand();
	test_cells();
	return unit_end();
}
