#include "nn/loss.h"

#include <math.h>

enum {
	BLOCKS = 256, /* at most this many partial sums, whatever n */
	RUN = 512,    /* factors 1 + exp(-|z|) <= 2 in one product: at most 2^512, far below double's end */
};

/* The sum over pixels [begin,end). A product of the factors costs one log for RUN pixels, and in double it is
 * no less exact than a sum of logs: each factor adds one rounding. */
static double bce_run(
	const float *logits, const uint8_t *mask, size_t begin, size_t end, float scale, float *dlogits)
{
	double linear = 0, product = 1;

	for (size_t i = begin; i < end; i++) {
		const float z = mask[i] ? -logits[i] : logits[i];
		const float e = expf(-fabsf(z));
		if (z > 0)
			linear += (double)z;
		product *= 1 + (double)e;
		if (dlogits) {
			const float away =
				(z > 0 ? 1 : e) / (1 + e); /* sigmoid(z): the share of the wrong answer */
			dlogits[i] = (mask[i] ? -scale : scale) * away;
		}
	}
	return linear + log(product);
}

double loss_bce(const float *logits, const uint8_t *mask, size_t n, float scale, float *dlogits)
{
	const size_t per_block = n / BLOCKS + 1;
	double partial[BLOCKS] = {0}, sum = 0;

	if (!n)
		return 0;
	const float each = (float)((double)scale / (double)n);
#pragma omp parallel for schedule(static)
	for (size_t b = 0; b < BLOCKS; b++) {
		const size_t begin = b * per_block < n ? b * per_block : n;
		const size_t end = n - begin > per_block ? begin + per_block : n;
		for (size_t i = begin; i < end; i += RUN)
			partial[b] += bce_run(logits, mask, i, end - i > RUN ? i + RUN : end, each, dlogits);
	}
	for (size_t b = 0; b < BLOCKS; b++)
		sum += partial[b];
	return sum / (double)n;
}

double loss_exp_sum(const float *x, size_t n, float *most)
{
	double sum = 0;

	*most = x[0];
	for (size_t i = 1; i < n; i++)
		*most = x[i] > *most ? x[i] : *most;
	for (size_t i = 0; i < n; i++)
		sum += exp((double)(x[i] - *most));
	return sum;
}

double loss_log_sum_exp(const float *x, size_t n)
{
	float most;
	const double sum = loss_exp_sum(x, n, &most);

	return most + log(sum);
}
