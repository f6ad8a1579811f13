#include "fit/photograph.h"

#include "base/mem.h"
#include "mask/shrink.h"
#include "splat/project.h"

#include <math.h>

int photograph_make(struct photograph *p, const struct camera *c, double scale, const uint8_t *rgb,
	int height, int width, struct err *e)
{
	scale = fmin(scale, (double)width / c->width);
	*p = (struct photograph){.scale = fmin(scale, 1)};
	for (int k = 0; k < FIT_LEVELS; k++) {
		p->camera[k] = camera_scaled(c, scale / (1 << k));
		p->rgb[k] = shrink_picture(rgb, height, width, p->camera[k].height, p->camera[k].width, e);
		if (!p->rgb[k])
			return -1;
	}
	return 0;
}

int photograph_ignore(struct photograph *p, const uint8_t *mask, int height, int width, struct err *e)
{
	for (int k = 0; k < FIT_LEVELS; k++) {
		const size_t h = (size_t)p->camera[k].height, w = (size_t)p->camera[k].width;
		uint8_t *to = p->ignored[k] = mem_zalloc(h * w, 1, "mask", e);
		if (!to)
			return -1;
		/* each of the larger in turn, so that none is left out between */
		const size_t rows = h > (size_t)height ? h : (size_t)height,
			     columns = w > (size_t)width ? w : (size_t)width;
		for (size_t y = 0; y < rows; y++)
			for (size_t x = 0; x < columns; x++)
				to[y * h / rows * w + x * w / columns] |=
					mask[y * (size_t)height / rows * (size_t)width +
						x * (size_t)width / columns] != 0;
	}
	return 0;
}

void photograph_free(struct photograph *p)
{
	for (int k = 0; k < FIT_LEVELS; k++)
		mem_free_all(p->rgb[k], p->ignored[k]);
	*p = (struct photograph){0};
}

/* The variance that the mean's low pass has less in the whole view; infinite where the photograph has it not.
 */
static double lost_variance(const struct photograph *p, const float *mean)
{
	const struct camera *c = &p->camera[0];
	const double world[3] = {mean[0], mean[1], mean[2]}, focal = fmax(c->fx, c->fy);
	double at[3];

	camera_transform(c, world, at);
	const double x = c->fx * at[0] / at[2] + c->cx, y = c->fy * at[1] / at[2] + c->cy;
	if (!(at[2] > 0 && x >= 0 && x < c->width && y >= 0 && y < c->height))
		return INFINITY;
	return PROJECT_LOW_PASS * (1 - p->scale * p->scale) * pow(at[2] / focal, 2);
}

void photographs_widen(struct splats *s, const struct photograph *p, size_t n)
{
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < s->n; i++) {
		double least = INFINITY;
		for (size_t v = 0; v < n; v++)
			least = fmin(least, lost_variance(&p[v], s->means + 3 * i));
		for (size_t k = 3 * i; k < 3 * i + 3 && least < INFINITY; k++)
			s->scales[k] = (float)sqrt((double)s->scales[k] * s->scales[k] + least);
	}
}
