#include "nn/adam.h"

#include <math.h>

enum { BLOCK = 16384 };

/* The scalars of one step, rounded once. */
struct factors {
	float decay1, fresh1, decay2, fresh2, size, scale2, eps;
};

/* The clones give the machine's vector width; correctly rounded operations give the same bytes. */
#if defined(__x86_64__) && defined(__GLIBC__)
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
adam_block(float *restrict parameters, const float *restrict gradient, float *restrict m, float *restrict v,
	size_t n, struct factors f)
{
	for (size_t i = 0; i < n; i++) {
		const float g = gradient[i];
		const float mi = f.decay1 * m[i] + f.fresh1 * g;
		const float vi = f.decay2 * v[i] + f.fresh2 * g * g;
		m[i] = mi;
		v[i] = vi;
		parameters[i] -= f.size * mi / (sqrtf(vi) * f.scale2 + f.eps);
	}
}

void adam_step(float *parameters, const float *gradient, float *m, float *v, size_t n, double rate,
	double beta1, double beta2, double eps, long step)
{
	const struct factors f = {
		.decay1 = (float)beta1,
		.fresh1 = (float)(1 - beta1),
		.decay2 = (float)beta2,
		.fresh2 = (float)(1 - beta2),
		.size = (float)(rate / (1 - pow(beta1, (double)step))),
		.scale2 = (float)(1 / sqrt(1 - pow(beta2, (double)step))),
		.eps = (float)eps,
	};

#pragma omp parallel for schedule(static)
	for (size_t begin = 0; begin < n; begin += BLOCK) {
		const size_t count = n - begin < BLOCK ? n - begin : BLOCK;
		adam_block(parameters + begin, gradient + begin, m + begin, v + begin, count, f);
	}
}
