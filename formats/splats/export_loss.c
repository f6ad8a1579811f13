/* What a format of splats does not keep. A place is rounded to a step: of .splat single precision, of .spz a
 * fixed point, of SOG a 65535th of the range of its logarithm. .spz has standard deviations of so many steps.
 */
#include "base/mem.h"
#include "base/quantile.h"
#include "formats/splats/anysplats.h"
#include "formats/splats/spz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A step that is more of the largest standard deviation of half of the Gaussians, or so many that become
 * larger or smaller, shows in pictures. */
static const double STEP_MOST = 0.5, RESIZED_MOST = 0.01;
static const double SPZ_SMALLEST = 4.5e-5, SPZ_LARGEST = 380; /* exp(-10), exp(255 / 16 - 10) */

static double log_of(double x)
{
	return copysign(log1p(fabs(x)), x);
}

/* The step of SOG where the logarithm does not change it. */
static void find_steps(double step[3], const struct splats *s, const double offset[3])
{
	for (size_t k = 0; k < 3; k++) {
		double low = INFINITY, high = -INFINITY;
		for (size_t i = 0; i < s->n; i++) {
			low = fmin(low, (double)s->means[3 * i + k] + offset[k]);
			high = fmax(high, (double)s->means[3 * i + k] + offset[k]);
		}
		step[k] = (log_of(high) - log_of(low)) / 65535;
	}
}

static double step_at(enum anysplats_format format, double spz, double sog, double x)
{
	const float at = (float)fabs(x);

	return format == ANYSPLATS_SPZ	   ? spz
	       : format == ANYSPLATS_SOG   ? sog * (1 + fabs(x))
	       : format == ANYSPLATS_SPLAT ? (double)nextafterf(at, INFINITY) - (double)at
					   : 0;
}

static int tell(char text[ANYSPLATS_LOSS], double step, double size, size_t resized, size_t n)
{
	if ((double)resized > RESIZED_MOST * (double)n)
		return snprintf(text, ANYSPLATS_LOSS,
			"%zu of %zu Gaussians are not within %g to %g, all that .spz has, and become larger or smaller: give the scene another unit with --scale, or write a .ply",
			resized, n, SPZ_SMALLEST, SPZ_LARGEST);
	return snprintf(text, ANYSPLATS_LOSS,
		"places are rounded to steps of %.2g, and half of the Gaussians are smaller than %.2g, so that they show off their places: move the scene to the origin or give it another unit (--translate, --scale), or write a .ply",
		step, size);
}

int anysplats_loss(const struct splats *s, const double offset[3], enum anysplats_format format,
	char text[ANYSPLATS_LOSS], struct err *e)
{
	struct quantile_item *shares = mem_alloc(s->n, sizeof *shares, "splats", e),
			     *sizes = mem_alloc(s->n, sizeof *sizes, "splats", e);
	double spz = 0, sog[3] = {0};
	size_t resized = 0;
	int found = shares && sizes ? 0 : -1;

	if (!found && s->n) {
		spz = ldexp(1, -spz_fraction(s, offset));
		find_steps(sog, s, offset);
	}
	for (size_t i = 0; i < s->n && !found; i++) {
		const float *scale = s->scales + 3 * i;
		const double size = (double)fmaxf(fmaxf(scale[0], scale[1]), scale[2]);
		double step = 0;
		for (size_t k = 0; k < 3; k++)
			step = fmax(
				step, step_at(format, spz, sog[k], (double)s->means[3 * i + k] + offset[k]));
		shares[i] = (struct quantile_item){step / fmax(size, 1e-300), 1};
		sizes[i] = (struct quantile_item){size, 1};
		resized += format == ANYSPLATS_SPZ && (size < SPZ_SMALLEST || size > SPZ_LARGEST);
	}
	if (!found && s->n) {
		const double share = quantile_weighted(shares, s->n, 0.5),
			     size = quantile_weighted(sizes, s->n, 0.5);
		found = share > STEP_MOST || (double)resized > RESIZED_MOST * (double)s->n;
		if (found)
			tell(text, share * size, size, resized, s->n);
	}
	free(shares);
	free(sizes);
	return found;
}
