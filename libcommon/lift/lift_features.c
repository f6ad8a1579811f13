#include "lift/lift_features.h"

#include "base/mem.h"

#include <math.h>

enum { CHUNK = 256 }; /* Gaussians that a thread takes at a time */

int lift_features_init(struct lift_features *l, size_t gaussians, size_t channels, struct err *e)
{
	size_t bytes;

	*l = (struct lift_features){.gaussians = gaussians, .channels = channels};
	if (mem_size(channels, sizeof *l->sum, &bytes))
		return err_set(e, ERR_SYSTEM, "features of %zu channels do not fit in memory", channels);
	l->sum = mem_alloc(gaussians, bytes, "features", e);
	l->weight = mem_zalloc(gaussians, sizeof *l->weight, "weights", e);
	l->square = mem_zalloc(gaussians, sizeof *l->square, "weights", e);
	return l->sum && l->weight && l->square ? 0 : -1;
}

void lift_features_free(struct lift_features *l)
{
	mem_free_all(l->sum, l->weight, l->square);
	*l = (struct lift_features){0};
}

void lift_features_begin(struct lift_features *l, size_t channels)
{
	memset(l->sum, 0, l->gaussians * channels * sizeof *l->sum);
}

#if defined __x86_64__
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
static void
add_row(float *sum, const float *feature, float weight, size_t channels)
{
	for (size_t c = 0; c < channels; c++)
		sum[c] += weight * feature[c];
}

void lift_features_add(struct lift_features *l, size_t channels, const struct source_weights *s,
	const float *features, const double *factor, int is_first)
{
#pragma omp parallel for schedule(dynamic, CHUNK)
	for (size_t i = 0; i < l->gaussians; i++)
		for (int64_t k = s->indptr[i]; k < s->indptr[i + 1]; k++) {
			const size_t own = (size_t)s->source[k];
			const double weight = (double)s->weight[k];
			add_row(l->sum + i * channels, features + own * channels,
				(float)(weight * factor[own]), channels);
			l->weight[i] += is_first ? weight : 0;
		}
}

void lift_features_end(struct lift_features *l, size_t channels)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < l->gaussians; i++) {
		float *mean = l->sum + i * channels;
		for (size_t c = 0; c < channels && l->weight[i] > 0; c++) {
			mean[c] = (float)((double)mean[c] / l->weight[i]);
			l->square[i] += (double)mean[c] * (double)mean[c];
		}
	}
}

void lift_features_reliability(const struct lift_features *l, float *reliability)
{
	for (size_t i = 0; i < l->gaussians; i++)
		reliability[i] = (float)fmin(sqrt(l->square[i]), 1);
}
