/* What images show of each Gaussian: against the sum by its definition, for images of all kinds. */
#include "unit.h"

#include "base/rng.h"
#include "lift/seen.h"
#include "lift/shares.h"

#include <omp.h>

enum { P = 90, N = 140, PER_PIXEL = 6, IMAGES = 9 };

struct view {
	int64_t indptr[P + 1];
	int32_t index[P * PER_PIXEL];
	float weight[P * PER_PIXEL];
};

/* Some pixels have no weights, some Gaussians none; a weight may be 0. */
static struct view_weights make_view(struct view *v, struct rng *r)
{
	int64_t n = 0;

	for (int p = 0; p < P; p++) {
		v->indptr[p] = n;
		for (uint32_t left = rng_below(r, PER_PIXEL + 1); left; left--, n++) {
			v->index[n] = (int32_t)rng_below(r, N - 9);
			v->weight[n] = rng_below(r, 5) ? (float)rng_uniform(r) : 0;
		}
	}
	v->indptr[P] = n;
	return (struct view_weights){P, N, v->indptr, v->index, v->weight};
}

static void check_row(const struct view_weights *w, const float *image, const struct shares *row)
{
	double sums[N] = {0};
	size_t n = 0;

	for (size_t p = 0; p < P; p++)
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
			sums[w->index[k]] += (double)w->weight[k] * (double)image[p];
	for (int i = 0; i < N; i++) {
		if (!(sums[i] > 0))
			continue;
		if (!CHECK(n < row->n && row->index[n] == i, "Gaussian %d is not in place %zu of %zu", i, n,
			    row->n))
			return;
		CHECK(fabs((double)row->share[n] - sums[i]) < 1e-5, "Gaussian %d has %g, expected %g", i,
			(double)row->share[n], sums[i]);
		n++;
	}
	CHECK(n == row->n, "%zu Gaussians, expected %zu", row->n, n);
}

/* A view's weights that are kept where they are above 0 are all of them. */
static void test_seen(const struct view_weights *w)
{
	double sum[N] = {0};
	float weight[N];
	struct seen seen, none = {0};
	struct err e;
	int unseen = 0;

	CHECK(!shares_of_view(weight, w, &e) && !seen_make(&seen, w, &e), "%s", e.message);
	seen_add(&none, N, sum);
	seen_add(&seen, N, sum);
	for (size_t i = 0; i < N; i++) {
		CHECK(seen_weight(&seen, i) == weight[i] && (float)sum[i] == weight[i],
			"Gaussian %zu has %g, in the sum %g, expected %g", i, (double)seen_weight(&seen, i),
			sum[i], (double)weight[i]);
		unseen += weight[i] == 0;
	}
	CHECK(unseen >= 9 && unseen < N / 2, "%d are not seen", unseen);
	seen_free(&seen);
}

int main(void)
{
	static float images[IMAGES][P]; /* the first one empty, the second full */
	struct shares rows[IMAGES], again[IMAGES];
	struct view v;
	struct rng r;
	struct err e;

	rng_seed(&r, 11, 1);
	const struct view_weights w = make_view(&v, &r);
	for (size_t k = 1; k < IMAGES; k++)
		for (size_t p = 0; p < P; p++)
			images[k][p] = k == 1 || !rng_below(&r, (uint32_t)k) ? (float)rng_uniform(&r) : 0;
	omp_set_num_threads(1);
	CHECK(!shares_make(rows, &w, images[0], IMAGES, &e), "%s", e.message);
	omp_set_num_threads(7);
	CHECK(!shares_make(again, &w, images[0], IMAGES, &e), "%s", e.message);
	for (size_t k = 0; k < IMAGES; k++) {
		check_row(&w, images[k], &rows[k]);
		CHECK(rows[k].n == again[k].n &&
				!memcmp(rows[k].index, again[k].index, rows[k].n * sizeof *rows[k].index),
			"image %zu: threads differ", k);
		for (size_t i = 0; i < rows[k].n; i++)
			CHECK(rows[k].share[i] == again[k].share[i], "image %zu: threads differ", k);
		shares_free(&rows[k]);
		shares_free(&again[k]);
	}
	CHECK(!shares_make(rows, &w, images[0], 0, &e), "no image");
	test_seen(&w);
	return unit_end();
}
