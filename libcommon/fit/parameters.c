#include "fit/parameters.h"

#include "base/mem.h"

#include <math.h>

const unsigned char fit_width[FIT_PARTS] = {3, 3, 4, 1, 3, 9, 15, 21};

int fit_parts(int degree)
{
	return FIT_SH + 1 + degree;
}

int fit_gaussians_alloc(struct fit_gaussians *g, size_t capacity, int degree, struct err *e)
{
	const int parts = fit_parts(degree);
	size_t row = 0, all, at = 0;

	*g = (struct fit_gaussians){.degree = degree};
	const size_t room = (capacity + 15) / 16 * 16; /* so that parts begin on cache lines */
	for (int p = 0; p < parts; p++)
		row += fit_width[p];
	if (room < capacity || mem_size(room, row, &all))
		return err_set(e, ERR_SYSTEM, "%zu Gaussians are too many", capacity);
	g->slab = mem_zalloc(all, FIT_SLABS * sizeof *g->slab, "Gaussians", e);
	g->splats.scales = mem_alloc(capacity, 3 * sizeof(float), "Gaussians", e);
	g->splats.opacities = mem_alloc(capacity, sizeof(float), "Gaussians", e);
	if (!g->slab || !g->splats.scales || !g->splats.opacities)
		return -1;
	g->capacity = capacity;
	for (int s = 0; s < FIT_SLABS; s++)
		for (int p = 0; p < parts; p++) {
			g->at[s][p] = g->slab + at;
			at += room * fit_width[p];
		}
	g->splats.near = SPLATS_NEAR;
	g->splats.means = g->at[FIT_VALUE][FIT_MEAN];
	g->splats.quats = g->at[FIT_VALUE][FIT_QUAT];
	return 0;
}

void fit_gaussians_free(struct fit_gaussians *g)
{
	mem_free_all(g->slab, g->splats.scales, g->splats.opacities);
	*g = (struct fit_gaussians){0};
}

void fit_gaussians_activate(struct fit_gaussians *g)
{
	const float *scale = g->at[FIT_VALUE][FIT_SCALE], *logit = g->at[FIT_VALUE][FIT_LOGIT];

	g->splats.n = g->n;
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < g->n; i++) {
		for (size_t k = 3 * i; k < 3 * i + 3; k++)
			g->splats.scales[k] = expf(scale[k]);
		g->splats.opacities[i] = 1 / (1 + expf(-logit[i]));
	}
}

void fit_gaussians_take(struct fit_gaussians *g, const struct splats *from)
{
	const size_t room = g->capacity - g->n, n = from->n < room ? from->n : room;
	float *const *to = g->at[FIT_VALUE];

	for (size_t i = 0; i < n; i++) {
		const size_t at = g->n + i;
		const float *sh = from->sh + 3 * (size_t)from->sh_coefficients * i;
		memcpy(to[FIT_MEAN] + 3 * at, from->means + 3 * i, 3 * sizeof(float));
		memcpy(to[FIT_QUAT] + 4 * at, from->quats + 4 * i, 4 * sizeof(float));
		for (size_t k = 0; k < 3; k++) /* a scale of 0 has no logarithm */
			to[FIT_SCALE][3 * at + k] = logf(fmaxf(from->scales[3 * i + k], 1e-12f));
		const float o = fminf(fmaxf(from->opacities[i], 1e-6f), 1 - 1e-6f);
		to[FIT_LOGIT][at] = logf(o / (1 - o));
		for (int p = FIT_SH, k = 0; p < fit_parts(g->degree); k += fit_width[p++])
			if (k < 3 * from->sh_coefficients)
				memcpy(to[p] + fit_width[p] * at, sh + k, fit_width[p] * sizeof(float));
	}
	g->n += n;
}

void fit_gaussians_keep(struct fit_gaussians *g, const char *kept)
{
	size_t n = 0;

	for (size_t i = 0; i < g->n; i++) {
		if (!kept[i])
			continue;
		for (int p = 0; p < fit_parts(g->degree); p++)
			for (int s = 0; s < FIT_SLABS; s++)
				memmove(g->at[s][p] + n * fit_width[p], g->at[s][p] + i * fit_width[p],
					fit_width[p] * sizeof(float));
		n++;
	}
	g->n = n;
	fit_gaussians_activate(g);
}

int fit_gaussians_give(const struct fit_gaussians *g, const char *kept, struct splats *to, struct err *e)
{
	const int coefficients = (g->degree + 1) * (g->degree + 1);
	float *const *from = g->at[FIT_VALUE];
	size_t n = 0, at = 0;

	for (size_t i = 0; i < g->n; i++)
		n += kept[i] != 0;
	if (splats_alloc(to, n, coefficients, e))
		return -1;
	for (size_t i = 0; i < g->n; i++) {
		const float *q = from[FIT_QUAT] + 4 * i;
		const float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
		if (!kept[i])
			continue;
		memcpy(to->means + 3 * at, from[FIT_MEAN] + 3 * i, 3 * sizeof(float));
		for (size_t k = 0; k < 4; k++)
			to->quats[4 * at + k] = length > 0 ? q[k] / length : !k;
		for (size_t k = 0; k < 3; k++)
			to->scales[3 * at + k] = expf(from[FIT_SCALE][3 * i + k]);
		to->opacities[at] = 1 / (1 + expf(-from[FIT_LOGIT][i]));
		float *sh = to->sh + 3 * (size_t)coefficients * at++;
		for (int p = FIT_SH; p < fit_parts(g->degree); sh += fit_width[p++])
			memcpy(sh, from[p] + fit_width[p] * i, fit_width[p] * sizeof(float));
	}
	return 0;
}

int fit_gaussians_are_finite(const struct fit_gaussians *g)
{
	int bad = 0;

	for (int p = 0; p < fit_parts(g->degree); p++) {
		const float *x = g->at[FIT_VALUE][p];
#pragma omp parallel for schedule(static) reduction(| : bad)
		for (size_t i = 0; i < g->n * fit_width[p]; i++)
			bad |= !(fabsf(x[i]) <= 1e30f);
	}
	return !bad;
}
