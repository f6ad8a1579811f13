#include "unit.h"

#include "base/rng.h"
#include "nn/adam.h"

#include <omp.h>

enum { N = 40000, STEPS = 25 };

/* The algorithm as it is printed, in double. */
static void twin_step(double *p, const float *g, double *m, double *v, size_t n, double rate, double beta1,
	double beta2, double eps, long step)
{
	for (size_t i = 0; i < n; i++) {
		m[i] = beta1 * m[i] + (1 - beta1) * (double)g[i];
		v[i] = beta2 * v[i] + (1 - beta2) * (double)g[i] * (double)g[i];
		double m_hat = m[i] / (1 - pow(beta1, (double)step));
		double v_hat = v[i] / (1 - pow(beta2, (double)step));
		p[i] -= rate * m_hat / (sqrt(v_hat) + eps);
	}
}

/* Gradients of many magnitudes; a tenth of them are zero, as those of Gaussians that a view does not see. */
static void draw(struct rng *r, float *g)
{
	for (int i = 0; i < N; i++)
		g[i] = rng_below(r, 10) ? (float)(rng_normal(r) * pow(10, -(double)(i % 9))) : 0;
}

static void follows_twin(void)
{
	static float p[N], g[N], m[N], v[N];
	static double p64[N], m64[N], v64[N];
	const double rate = 0.0025;
	struct rng r;
	double worst = 0, moved = 0;

	rng_seed(&r, 3, 1);
	for (long step = 1; step <= STEPS; step++) {
		draw(&r, g);
		adam_step(p, g, m, v, N, rate, 0.9, 0.999, 1e-15, step);
		twin_step(p64, g, m64, v64, N, rate, 0.9, 0.999, 1e-15, step);
	}
	for (int i = 0; i < N; i++) {
		worst = fmax(worst, fabs((double)p[i] - p64[i]));
		moved = fmax(moved, fabs(p64[i]));
	}
	printf("adam: worst difference to float64 after %d steps %.2e of a step\n", STEPS, worst / rate);
	CHECK(moved > 5 * rate, "the twin moved only %g", moved);
	CHECK(worst < 2e-5 * rate, "worst difference %g of a step", worst / rate);
}

/* A first step is rate * sign(g), whatever the size of g; a zero gradient moves nothing. */
static void first_step(void)
{
	float p[4] = {1, 1, 1, 1}, m[4] = {0}, v[4] = {0};
	const float g[4] = {1e-6f, -3, 1e4f, 0};

	adam_step(p, g, m, v, 4, 0.25, 0.9, 0.999, 1e-15, 1);
	CHECK(fabs((double)p[0] - 0.75) < 1e-6 && fabs((double)p[1] - 1.25) < 1e-6, "%g %g", (double)p[0],
		(double)p[1]);
	CHECK(fabs((double)p[2] - 0.75) < 1e-6 && p[3] == 1, "%g %g", (double)p[2], (double)p[3]);
	CHECK(fabs((double)m[1] + 0.3) < 1e-6 && fabs((double)v[1] - 0.009) < 1e-8, "moments %g %g",
		(double)m[1], (double)v[1]);
}

/* eps is outside the root and not scaled by the bias correction. */
static void eps_place(void)
{
	float p = 0, m = 0, v = 0;
	const float g = 0.5f;

	adam_step(&p, &g, &m, &v, 1, 1, 0.9, 0.999, 0.5, 1);
	CHECK(fabs((double)p + 0.5) < 1e-6, "%g", (double)p);
}

static void same_for_any_threads(void)
{
	static float g[N], p[2][N], m[2][N], v[2][N];
	struct rng r;

	for (int k = 0; k < 2; k++) {
		rng_seed(&r, 4, 1);
		omp_set_num_threads(k ? 3 : 1);
		for (long step = 1; step <= 3; step++) {
			draw(&r, g);
			adam_step(p[k], g, m[k], v[k], N - 7, 0.01, 0.9, 0.999, 1e-15, step);
		}
	}
	CHECK(!memcmp(p[0], p[1], sizeof p[0]) && !memcmp(v[0], v[1], sizeof v[0]), "1 and 3 threads differ");
	CHECK(p[0][N - 8] != 0 && p[0][N - 7] == 0, "n is the end");
}

int main(void)
{
	follows_twin();
	first_step();
	eps_place();
	same_for_any_threads();
	return unit_end();
}
