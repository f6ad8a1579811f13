#include "nn/adam.h"

#include <math.h>

/* Without this GCC must set errno for the root of a negative number, and that keeps the loop from being
 * vectorised. */
#ifdef __OPTIMIZE__
#pragma GCC optimize("no-math-errno")
#endif

enum { BLOCK = 16384 };

void adam_step(float *parameters, const float *gradient, float *m, float *v, size_t n, double rate,
	double beta1, double beta2, double eps, long step)
{
	const float decay1 = (float)beta1, fresh1 = (float)(1 - beta1);
	const float decay2 = (float)beta2, fresh2 = (float)(1 - beta2);
	const float size = (float)(rate / (1 - pow(beta1, (double)step)));
	const float scale2 = (float)(1 / sqrt(1 - pow(beta2, (double)step)));
	const float small = (float)eps;
	const size_t blocks = (n + BLOCK - 1) / BLOCK;

#pragma omp parallel for schedule(static)
	for (size_t b = 0; b < blocks; b++) {
		const size_t end = b + 1 < blocks ? (b + 1) * BLOCK : n;
#pragma omp simd
		for (size_t i = b * BLOCK; i < end; i++) {
			const float g = gradient[i];
			const float mi = decay1 * m[i] + fresh1 * g;
			const float vi = decay2 * v[i] + fresh2 * g * g;
			m[i] = mi;
			v[i] = vi;
			parameters[i] -= size * mi / (sqrtf(vi) * scale2 + small);
		}
	}
}
