#include "unit.h"

#include "base/rng.h"
#include "nn/loss.h"

#include <omp.h>

enum { N = 30000 };

static double twin(const float *logits, const uint8_t *mask, size_t n)
{
	double sum = 0;

	for (size_t i = 0; i < n; i++) {
		double x = (double)logits[i], y = mask[i];
		sum += fmax(x, 0) - x * y + log1p(exp(-fabs(x)));
	}
	return sum / (double)n;
}

static void draw(float *logits, uint8_t *mask, double spread, uint64_t seed)
{
	struct rng r;

	rng_seed(&r, seed, 1);
	for (int i = 0; i < N; i++) {
		logits[i] = rng_below(&r, 20) ? (float)(spread * rng_normal(&r)) : 0;
		mask[i] = (uint8_t)rng_below(&r, 2);
	}
}

/* Value and gradient against float64, from tiny logits to huge ones and for n around the block and run sizes.
 */
static void follows_twin(void)
{
	static float logits[N], d[N];
	static uint8_t mask[N];
	const double spreads[] = {1e-3, 1, 30, 1e4};
	const size_t counts[] = {1, 2, 255, 256, 257, 512, 513, 4097, N};
	double worst_value = 0, worst_gradient = 0;

	for (size_t s = 0; s < 4; s++)
		for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
			const size_t n = counts[c];
			draw(logits, mask, spreads[s], 10 * s + c);
			double value = loss_bce(logits, mask, n, 3, d), expected = twin(logits, mask, n);
			worst_value = fmax(worst_value, fabs(value - expected) / fmax(expected, 1e-3));
			CHECK(value == loss_bce(logits, mask, n, 1, NULL), "dlogits changes the value, n %zu",
				n);
			for (size_t i = 0; i < n; i++) {
				double x = (double)logits[i];
				double g = 3 * (mask[i] ? -1 / (1 + exp(x)) : 1 / (1 + exp(-x))) / (double)n;
				double floor = 1e-35; /* below this a float is denormal */
				worst_gradient =
					fmax(worst_gradient, fabs((double)d[i] - g) / fmax(fabs(g), floor));
			}
		}
	printf("loss: worst relative difference to float64: value %.2e, gradient %.2e\n", worst_value,
		worst_gradient);
	CHECK(worst_value < 1e-7, "value %g", worst_value);
	CHECK(worst_gradient < 1e-6, "gradient %g", worst_gradient);
}

static void extremes(void)
{
	const float logits[4] = {1e30f, -1e30f, INFINITY, -INFINITY};
	const uint8_t right[4] = {1, 0, 1, 0}, wrong[4] = {0, 1, 0, 1};
	float d[4];

	CHECK(loss_bce(logits, right, 4, 1, d) == 0 && d[0] == 0 && d[3] == 0,
		"right and sure costs nothing");
	CHECK(fabs(loss_bce(logits, wrong, 2, 1, d) / 1e30 - 1) < 1e-6, "wrong and sure costs |M|");
	CHECK(d[0] == 0.5f && d[1] == -0.5f, "gradient %g %g", (double)d[0], (double)d[1]);
	CHECK(isinf(loss_bce(logits, wrong, 4, 1, d)) && d[2] == 0.25f && d[3] == -0.25f,
		"infinite, not NaN");
	CHECK(loss_bce(NULL, NULL, 0, 1, NULL) == 0, "no pixels");
	const float nan[2] = {NAN, 1};
	CHECK(isnan(loss_bce(nan, right, 2, 1, d)), "NaN is not hidden");
}

static void same_for_any_threads(void)
{
	static float logits[N], d[2][N];
	static uint8_t mask[N];
	double value[2];

	draw(logits, mask, 5, 99);
	for (int k = 0; k < 2; k++) {
		omp_set_num_threads(k ? 3 : 1);
		value[k] = loss_bce(logits, mask, N, 1, d[k]);
	}
	CHECK(!memcmp(&value[0], &value[1], sizeof value[0]) && !memcmp(d[0], d[1], sizeof d[0]),
		"%.17g %.17g", value[0], value[1]);
}

int main(void)
{
	follows_twin();
	extremes();
	same_for_any_threads();
	return unit_end();
}
