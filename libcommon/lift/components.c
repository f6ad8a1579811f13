#include "lift/components.h"

#include "base/dot.h"
#include "base/mem.h"
#include "base/rng.h"
#include "nn/linear.h"

#include <math.h>

/* Directions beyond those that are wanted, and turns: then the wanted ones are as exact as their eigenvalues
 * are apart, and where those are not it does not matter which is taken. */
enum { MORE = 8, TURNS = 40, SWEEPS = 60 };

/* What is less than this share of what it was before the others were taken from it is rounding. */
#define LEAST_LEFT 1e-9

void components_free(struct components *c)
{
	mem_free_all(c->mean, c->basis);
	*c = (struct components){0};
}

static void find_mean(const float *rows, size_t n, size_t channels, float *mean)
{
#pragma omp parallel for schedule(static)
	for (size_t a = 0; a < channels; a++) {
		double sum = 0;
		for (size_t i = 0; i < n; i++)
			sum += (double)rows[i * channels + a];
		mean[a] = (float)(n ? sum / (double)n : 0);
	}
}

/* The upper triangle, row by row, then the lower one as its mirror. */
static void find_covariance(const float *rows, size_t n, size_t channels, const float *mean, double *to)
{
	memset(to, 0, channels * channels * sizeof *to);
#pragma omp parallel for schedule(dynamic)
	for (size_t a = 0; a < channels; a++)
		for (size_t i = 0; i < n; i++) {
			const float *x = rows + i * channels;
			const double own = (double)x[a] - (double)mean[a];
			for (size_t b = a; b < channels; b++)
				to[a * channels + b] += own * ((double)x[b] - (double)mean[b]);
		}
	for (size_t a = 0; a < channels; a++)
		for (size_t b = 0; b < a; b++)
			to[a * channels + b] = to[b * channels + a];
}

/* to (m,C) = from (m,C) times the symmetric covariance. */
static void turn(const double *covariance, const double *from, double *to, size_t m, size_t channels)
{
#pragma omp parallel for schedule(static)
	for (size_t a = 0; a < channels; a++)
		for (size_t k = 0; k < m; k++)
			to[k * channels + a] =
				dot(covariance + a * channels, from + k * channels, (int)channels);
}

/* Gram and Schmidt, each vector twice; what lies in the span of those before it becomes 0. */
static void make_orthonormal(double *q, size_t m, size_t channels)
{
	for (size_t k = 0; k < m; k++) {
		double *own = q + k * channels;
		const double before = sqrt(dot(own, own, (int)channels));
		for (size_t j = 0; j < 2 * k; j++) {
			const double *other = q + (j % k) * channels, along = dot(own, other, (int)channels);
			for (size_t a = 0; a < channels; a++)
				own[a] -= along * other[a];
		}
		const double left = sqrt(dot(own, own, (int)channels));
		for (size_t a = 0; a < channels; a++)
			own[a] = left > LEAST_LEFT * before ? own[a] / left : 0;
	}
}

/* One rotation of Jacobi's: t (m,m) gets a 0 at (p,q), and rows p and q of v turn alike. */
static void rotate(double *t, double *v, size_t m, size_t p, size_t q)
{
	const double off = t[p * m + q], theta = (t[q * m + q] - t[p * m + p]) / (2 * off);
	const double tangent = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
	const double c = 1 / sqrt(tangent * tangent + 1), s = tangent * c;

	for (size_t k = 0; k < m; k++) {
		const double a = t[k * m + p], b = t[k * m + q];
		t[k * m + p] = c * a - s * b;
		t[k * m + q] = s * a + c * b;
	}
	for (size_t k = 0; k < m; k++) {
		const double a = t[p * m + k], b = t[q * m + k], x = v[p * m + k], y = v[q * m + k];
		t[p * m + k] = c * a - s * b;
		t[q * m + k] = s * a + c * b;
		v[p * m + k] = c * x - s * y;
		v[q * m + k] = s * x + c * y;
	}
}

/* Eigenvalues of t (m,m) on its diagonal, eigenvectors in the rows of v (m,m). */
static void diagonalise(double *t, double *v, size_t m)
{
	double size = 0;

	memset(v, 0, m * m * sizeof *v);
	for (size_t k = 0; k < m; k++)
		v[k * m + k] = 1;
	for (size_t k = 0; k < m * m; k++)
		size = fmax(size, fabs(t[k]));
	for (int sweep = 0; sweep < SWEEPS; sweep++) {
		int is_done = 1;
		for (size_t p = 0; p < m; p++)
			for (size_t q = p + 1; q < m; q++)
				if (fabs(t[p * m + q]) > 1e-15 * size) {
					rotate(t, v, m, p, q);
					is_done = 0;
				}
		if (is_done)
			break;
	}
}

/* Row `to` of the basis: the vectors q (m,C) mixed by one eigenvector, with its sign. */
static void take_row(float *to, const double *q, const double *mix, size_t m, size_t channels)
{
	size_t largest = 0;

	for (size_t a = 0; a < channels; a++) {
		double sum = 0;
		for (size_t k = 0; k < m; k++)
			sum += mix[k] * q[k * channels + a];
		to[a] = (float)sum;
		largest = fabsf(to[a]) > fabsf(to[largest]) ? a : largest;
	}
	const float sign = to[largest] < 0 ? -1.0F : 1.0F;
	for (size_t a = 0; a < channels; a++)
		to[a] *= sign;
}

/* The basis from the vectors q (m,C) and what the covariance makes of them, by falling eigenvalues. */
static void take_basis(struct components *c, const double *q, const double *turned, size_t m, double *t,
	double *v, char *taken)
{
	for (size_t k = 0; k < m; k++)
		for (size_t j = 0; j < m; j++)
			t[k * m + j] = dot(q + k * c->channels, turned + j * c->channels, (int)c->channels);
	diagonalise(t, v, m);
	for (size_t k = 0; k < c->count; k++) {
		size_t best = m;
		for (size_t j = 0; j < m; j++)
			if (!taken[j] && (best == m || t[j * m + j] > t[best * m + best]))
				best = j;
		taken[best] = 1;
		take_row(c->basis + k * c->channels, q, v + best * m, m, c->channels);
	}
}

static int find_basis(struct components *c, const double *covariance, struct err *e)
{
	const size_t channels = c->channels, m = c->count + MORE < channels ? c->count + MORE : channels;
	SCOPED double *q = mem_alloc(2 * m * channels, sizeof *q, "components", e);
	SCOPED double *t = mem_alloc(2 * m * m, sizeof *t, "components", e);
	SCOPED char *taken = mem_zalloc(m, 1, "components", e);
	struct rng r;

	if (q && t && taken) {
		double *turned = q + m * channels;
		rng_seed(&r, 1, 1);
		for (size_t k = 0; k < m * channels; k++)
			q[k] = rng_normal(&r);
		for (int i = 0; i < TURNS; i++) {
			make_orthonormal(q, m, channels);
			turn(covariance, q, turned, m, channels);
			memcpy(q, turned, m * channels * sizeof *q);
		}
		make_orthonormal(q, m, channels);
		turn(covariance, q, turned, m, channels);
		take_basis(c, q, turned, m, t, t + m * m, taken);
	}
	return q && t && taken ? 0 : -1;
}

int components_find(
	struct components *c, const float *rows, size_t n, size_t channels, size_t count, struct err *e)
{
	SCOPED double *covariance = mem_alloc(channels, channels * sizeof *covariance, "components", e);

	*c = (struct components){channels, count, mem_alloc(channels, sizeof *c->mean, "components", e),
		mem_alloc(count, channels * sizeof *c->basis, "components", e)};
	int bad = !covariance || !c->mean || !c->basis;
	if (!bad) {
		find_mean(rows, n, channels, c->mean);
		find_covariance(rows, n, channels, c->mean, covariance);
		bad = find_basis(c, covariance, e);
	}
	if (bad)
		components_free(c);
	return bad ? -1 : 0;
}

void components_of(const struct components *c, float *x, size_t n, float *y)
{
	for (size_t i = 0; i < n; i++)
		for (size_t a = 0; a < c->channels; a++)
			x[i * c->channels + a] -= c->mean[a];
	linear_forward(y, x, c->basis, NULL, n, c->channels, c->count);
}
