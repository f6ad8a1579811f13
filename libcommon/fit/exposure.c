#include "fit/exposure.h"

#include "base/mem.h"
#include "nn/adam.h"
#include "splat/sh.h"

#include <math.h>

enum { SEEN_LEAST = 20 }; /* fewer points say nothing of a photograph */
#define GAIN_LEAST 0.05f

/* Brings the means to identity. */
static void fix_gauge(struct exposures *x)
{
	for (int k = 0; k < EXPOSURE_WIDTH; k++) {
		double mean = 0;
		for (size_t v = 0; v < x->n; v++)
			mean += (double)x->values[v * EXPOSURE_WIDTH + (size_t)k] / (double)x->n;
		for (size_t v = 0; v < x->n; v++) {
			float *value = x->values + v * EXPOSURE_WIDTH + k;
			*value = k % 2 ? (float)(*value - mean)
				       : fmaxf((float)(*value + 1 - mean), GAIN_LEAST);
		}
	}
}

int exposures_alloc(struct exposures *x, size_t n, struct err *e)
{
	x->values = mem_zalloc(n, 3 * EXPOSURE_WIDTH * sizeof *x->values, "exposures", e);
	if (!x->values)
		return -1;
	x->n = n;
	x->moment1 = x->values + n * EXPOSURE_WIDTH;
	x->moment2 = x->moment1 + n * EXPOSURE_WIDTH;
	for (size_t i = 0; i < n * EXPOSURE_WIDTH; i += 2)
		x->values[i] = 1;
	return 0;
}

void exposures_free(struct exposures *x)
{
	free(x->values);
	*x = (struct exposures){0};
}

/* sums (2,3): of the pixels that points fall on, and of the points' colours. Returns of how many. */
static size_t compare(const struct fit_gaussians *g, const struct photograph *p, double sums[2][3])
{
	const struct camera *c = &p->camera[FIT_LEVELS - 1];
	const float *means = g->at[FIT_VALUE][FIT_MEAN], *sh = g->at[FIT_VALUE][FIT_SH];
	size_t n = 0;

	for (size_t i = 0; i < g->n; i++) {
		double at[3];
		camera_transform(c, (double[3]){means[3 * i], means[3 * i + 1], means[3 * i + 2]}, at);
		const double column = c->fx * at[0] / at[2] + c->cx, row = c->fy * at[1] / at[2] + c->cy;
		if (!(at[2] > 0 && column >= 0 && column < c->width && row >= 0 && row < c->height))
			continue;
		const uint8_t *pixel =
			p->rgb[FIT_LEVELS - 1] + 3 * ((size_t)row * (size_t)c->width + (size_t)column);
		for (size_t k = 0; k < 3; k++) {
			sums[0][k] += pixel[k] / 255.0;
			sums[1][k] += (double)sh[3 * i + k] * SH_C0 + 0.5;
		}
		n++;
	}
	return n;
}

double exposures_guess(struct exposures *x, const struct fit_gaussians *g, const struct photograph *p)
{
	double sum = 0, squares = 0;

	for (size_t v = 0; v < x->n; v++) {
		double sums[2][3] = {{0}}, gain = 0;
		if (compare(g, &p[v], sums) < SEEN_LEAST)
			continue;
		for (int k = 0; k < 3; k++) {
			const double own = (sums[0][k] + 1e-3) / (fmax(sums[1][k], 0) + 1e-3);
			x->values[v * EXPOSURE_WIDTH + 2 * (size_t)k] = (float)fmin(fmax(own, 0.1), 10);
			gain += log(own) / 3;
		}
		sum += gain / (double)x->n;
		squares += gain * gain / (double)x->n;
	}
	fix_gauge(x);
	return sqrt(fmax(0, squares - sum * sum));
}

void exposure_apply(const float *exposure, const float *image, float *shown, size_t pixels)
{
	for (size_t k = 0; k < 3; k++)
#pragma omp parallel for schedule(static)
		for (size_t i = k * pixels; i < (k + 1) * pixels; i++)
			shown[i] = exposure[2 * k] * image[i] + exposure[2 * k + 1];
}

void exposures_step(struct exposures *x, size_t which, const float *image, float *gradient, size_t pixels,
	double rate, long step)
{
	const size_t at = which * EXPOSURE_WIDTH;
	float slopes[EXPOSURE_WIDTH];

#pragma omp parallel for schedule(static)
	for (size_t k = 0; k < 3; k++) {
		double gain = 0, offset = 0;
		for (size_t i = k * pixels; i < (k + 1) * pixels; i++) {
			gain += (double)gradient[i] * image[i];
			offset += gradient[i];
			gradient[i] *= x->values[at + 2 * k];
		}
		slopes[2 * k] = (float)gain;
		slopes[2 * k + 1] = (float)offset;
	}
	adam_step(x->values + at, slopes, x->moment1 + at, x->moment2 + at, EXPOSURE_WIDTH, rate, 0.9, 0.999,
		1e-15, step);
	fix_gauge(x);
}

void exposure_nearest(float *exposure, const float *image, const uint8_t *photograph, size_t pixels)
{
	const double n = (double)pixels;

	for (size_t k = 0; k < 3; k++) {
		double x = 0, y = 0, xx = 0, xy = 0;
		for (size_t i = 0; i < pixels; i++) {
			const double a = image[k * pixels + i], b = photograph[3 * i + k] / 255.0;
			x += a / n;
			y += b / n;
			xx += a * a / n;
			xy += a * b / n;
		}
		const double spread = xx - x * x, gain = spread > 1e-9 ? (xy - x * y) / spread : 1;
		exposure[2 * k] = (float)gain;
		exposure[2 * k + 1] = (float)(y - gain * x);
	}
}
