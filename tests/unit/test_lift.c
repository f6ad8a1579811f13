/* Lifting images onto Gaussians by blend weight and rendering fields back, against plain float64, and
 * whatever the number of threads. */
#include "unit.h"

#include "base/rng.h"
#include "splat/backproject.h"

#include <omp.h>

enum { P = 2500, N = 180, MOST = 9, ENTRIES = 12, VIEWS = 2 };

struct random_view {
	int64_t indptr[P + 1];
	int32_t index[P * ENTRIES];
	float weight[P * ENTRIES];
	float image[MOST * P];
};

/* Pixels have none to ENTRIES weights; the last ten Gaussians have none. Images are 0 in half of the columns,
 * and signed elsewhere. */
static struct view_weights make_view(struct random_view *v, struct rng *r)
{
	int64_t n = 0;

	for (int p = 0; p < P; p++) {
		v->indptr[p] = n;
		for (uint32_t left = rng_below(r, ENTRIES + 1); left; left--, n++) {
			v->index[n] = (int32_t)rng_below(r, N - 10);
			v->weight[n] = (float)(rng_uniform(r) / ENTRIES);
		}
	}
	v->indptr[P] = n;
	for (int i = 0; i < MOST * P; i++)
		v->image[i] = i / 25 % 2 ? (float)rng_range(r, -1, 2) : 0;
	return (struct view_weights){P, N, v->indptr, v->index, v->weight};
}

/* By the definitions, one channel at a time. */
static void naive_add(const struct view_weights *w, const float *image, double *sum)
{
	for (size_t p = 0; p < w->pixels; p++)
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
			sum[w->index[k]] += (double)w->weight[k] * (double)image[p];
}

static double naive_pixel(
	const struct view_weights *w, size_t p, const float *field, size_t channel, double *most)
{
	double sum = 0;

	*most = 0;
	for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
		double term = (double)w->weight[k] *
			      (double)field[backproject_index(N, channel, (size_t)w->index[k])];
		sum += term;
		*most += fabs(term);
	}
	return sum;
}

static void test_naive(size_t channels)
{
	static struct random_view views[VIEWS];
	static float sum[2][(MOST + VIEW_GROUP) * N], image[2][MOST * P];
	static double naive[MOST][N], weight[N], naive_weight[N];
	struct view_weights w[VIEWS];
	struct rng r;

	rng_seed(&r, channels, 1);
	memset(sum, 0, sizeof sum);
	memset(naive, 0, sizeof naive);
	memset(weight, 0, sizeof weight);
	memset(naive_weight, 0, sizeof naive_weight);
	for (int v = 0; v < VIEWS; v++) {
		w[v] = make_view(&views[v], &r);
		backproject_weight(&w[v], weight);
		for (int64_t k = 0; k < w[v].indptr[P]; k++)
			naive_weight[w[v].index[k]] += (double)w[v].weight[k];
		for (size_t c = 0; c < channels; c++)
			naive_add(&w[v], views[v].image + c * P, naive[c]);
	}
	for (int threads = 1; threads <= 2; threads++) {
		omp_set_num_threads(threads);
		for (int v = 0; v < VIEWS; v++)
			backproject_add(&w[v], views[v].image, channels, sum[threads - 1]);
		backproject_render(&w[0], sum[0], channels, image[threads - 1]);
	}
	CHECK(!memcmp(sum[0], sum[1], sizeof sum[0]), "lifted differently by two threads");
	CHECK(!memcmp(image[0], image[1], sizeof image[0]), "rendered differently by two threads");
	for (size_t i = 0; i < N; i++) {
		CHECK(weight[i] == naive_weight[i] && (i < N - 10 || weight[i] == 0),
			"Gaussian %zu: %g, expected %g", i, weight[i], naive_weight[i]);
		for (size_t c = 0; c < channels; c++) {
			double got = (double)sum[0][backproject_index(N, c, i)];
			CHECK(fabs(got - naive[c][i]) <= 1e-5 * weight[i], "Gaussian %zu channel %zu: %g, %g",
				i, c, got, naive[c][i]);
		}
	}
	for (size_t c = 0; c < channels; c++)
		for (size_t p = 0; p < P; p++) {
			double most, expected = naive_pixel(&w[0], p, sum[0], c, &most),
				     got = (double)image[0][c * P + p];
			CHECK(fabs(got - expected) <= 2e-6 * most, "pixel %zu channel %zu: %g, %g", p, c, got,
				expected);
		}
}

int main(void)
{
	for (size_t channels = 1; channels <= MOST; channels += 2)
		test_naive(channels);
	test_naive(VIEW_GROUP);
	return unit_end();
}
