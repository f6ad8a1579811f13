/* Principal components: against what makes them so, and by hand. */
#include "unit.h"

#include "base/rng.h"
#include "lift/components.h"

#include <omp.h>

enum { N = 300, C = 12 };

/* Rows of a mean and of `rank` directions with spreads that halve from one to the next, which are not
 * orthogonal. */
static void make_rows(float *rows, int rank, uint64_t seed)
{
	double along[C][C];
	struct rng r;

	rng_seed(&r, seed, 1);
	for (int k = 0; k < rank; k++)
		for (int c = 0; c < C; c++)
			along[k][c] = rng_normal(&r);
	for (int i = 0; i < N; i++) {
		double x[C];
		for (int c = 0; c < C; c++)
			x[c] = 3 + c;
		for (int k = 0; k < rank; k++) {
			const double t = rng_normal(&r) / (1 << k);
			for (int c = 0; c < C; c++)
				x[c] += t * along[k][c];
		}
		for (int c = 0; c < C; c++)
			rows[i * C + c] = (float)x[c];
	}
}

/* The covariance, one entry after the other. */
static void covariance(const float *rows, const float *mean, double to[C][C])
{
	memset(to, 0, C * C * sizeof to[0][0]);
	for (int a = 0; a < C; a++)
		for (int b = 0; b < C; b++)
			for (int i = 0; i < N; i++)
				to[a][b] += ((double)rows[i * C + a] - (double)mean[a]) *
					    ((double)rows[i * C + b] - (double)mean[b]);
}

static double inner(const float *a, const float *b)
{
	double sum = 0;

	for (int c = 0; c < C; c++)
		sum += (double)a[c] * (double)b[c];
	return sum;
}

/* Orthonormal eigenvectors by falling eigenvalues, and all of what varies is in them. */
static void test_definition(int rank, size_t count)
{
	static float rows[N * C];
	double cov[C][C], before = INFINITY, kept = 0, all = 0;
	struct components p;
	struct err e = {0};

	make_rows(rows, rank, (uint64_t)rank);
	if (!CHECK(!components_find(&p, rows, N, C, count, &e), "%s", e.message))
		return;
	covariance(rows, p.mean, cov);
	for (int c = 0; c < C; c++)
		all += cov[c][c];
	for (size_t k = 0; k < count; k++) {
		const float *b = p.basis + k * C;
		double value = 0, off = 0, turned[C], length = inner(b, b);
		for (int c = 0; c < C; c++) {
			turned[c] = 0;
			for (int d = 0; d < C; d++)
				turned[c] += cov[c][d] * (double)b[d];
			value += turned[c] * (double)b[c];
		}
		for (int c = 0; c < C; c++)
			off += pow(turned[c] - value * (double)b[c], 2);
		if ((int)k >= rank) {
			CHECK(value < 1e-6 * all, "component %zu of rank %d varies", k, rank);
			continue;
		}
		CHECK(fabs(length - 1) < 1e-6, "component %zu has length %g", k, sqrt(length));
		CHECK(sqrt(off) < 1e-5 * all, "component %zu is off by %g of %g", k, sqrt(off), value);
		CHECK(value <= before * (1 + 1e-9), "component %zu: %g after %g", k, value, before);
		for (size_t j = 0; j < k; j++)
			CHECK(fabs(inner(b, p.basis + j * C)) < 1e-6, "%zu and %zu", j, k);
		before = value;
		kept += value;
	}
	if ((int)count >= rank)
		CHECK(kept > all * (1 - 1e-6), "%g of %g", kept, all);
	/* What rows are told by brings them back. */
	for (int i = 0; i < N && (int)count >= rank; i++) {
		float y[C];
		double worst = 0;
		float x0[C];
		memcpy(x0, rows + i * C, sizeof x0);
		components_of(&p, x0, 1, y);
		for (int c = 0; c < C; c++) {
			double x = (double)p.mean[c];
			for (size_t k = 0; k < count; k++)
				x += (double)y[k] * (double)p.basis[k * C + (size_t)c];
			worst = fmax(worst, fabs(x - (double)rows[i * C + c]));
		}
		CHECK(worst < 1e-4, "row %d is off by %g", i, worst);
	}
	components_free(&p);
}

static void test_by_hand(void)
{
	/* Along (3,4) most, across it less. */
	float rows[] = {1 + 6, 1 + 8, 1 - 6, 1 - 8, 1 - 4, 1 + 3, 1 + 4, 1 - 3};
	struct components p;
	struct err e = {0};
	float y[2];

	if (!CHECK(!components_find(&p, rows, 4, 2, 2, &e), "%s", e.message))
		return;
	CHECK(fabsf(p.mean[0] - 1) < 1e-6F && fabsf(p.mean[1] - 1) < 1e-6F, "mean");
	CHECK(fabsf(p.basis[0] - 0.6F) < 1e-6F && fabsf(p.basis[1] - 0.8F) < 1e-6F, "first: %g %g",
		(double)p.basis[0], (double)p.basis[1]);
	CHECK(fabsf(p.basis[2] - 0.8F) < 1e-6F && fabsf(p.basis[3] + 0.6F) < 1e-6F, "second: %g %g",
		(double)p.basis[2], (double)p.basis[3]);
	components_of(&p, rows, 1, y);
	CHECK(fabsf(y[0] - 10) < 1e-5F && fabsf(y[1]) < 1e-5F, "%g %g", (double)y[0], (double)y[1]);
	components_free(&p);
	/* No rows: nothing varies. */
	CHECK(!components_find(&p, rows, 0, 2, 1, &e) && fabsf(p.basis[0]) <= 0 && fabsf(p.mean[0]) <= 0,
		"none");
	components_free(&p);
}

static void test_threads(void)
{
	static float rows[N * C];
	const int before = omp_get_max_threads();
	struct components a, b;
	struct err e = {0};

	make_rows(rows, 6, 9);
	omp_set_num_threads(1);
	CHECK(!components_find(&a, rows, N, C, 4, &e), "%s", e.message);
	omp_set_num_threads(7);
	CHECK(!components_find(&b, rows, N, C, 4, &e), "%s", e.message);
	CHECK(!memcmp(a.basis, b.basis, 4 * C * sizeof(float)) && !memcmp(a.mean, b.mean, C * sizeof(float)),
		"any number of threads gives the same");
	omp_set_num_threads(before);
	components_free(&a);
	components_free(&b);
}

int main(void)
{
	for (int rank = 1; rank <= 8; rank += 3)
		for (size_t count = 1; count <= C; count += 3)
			test_definition(rank, count);
	test_by_hand();
	test_threads();
	return unit_end();
}
