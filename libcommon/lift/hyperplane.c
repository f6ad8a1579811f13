#include "lift/hyperplane.h"

#include "base/mem.h"

#include <math.h>

double hyperplane_side(const double *plane, const float *feature, size_t channels)
{
	double sums[4] = {0};
	size_t c = 0;

	for (; c + 4 <= channels; c += 4)
		for (size_t k = 0; k < 4; k++)
			sums[k] += plane[c + k] * (double)feature[c + k];
	for (; c < channels; c++)
		sums[0] += plane[c] * (double)feature[c];
	return sums[0] + sums[1] + sums[2] + sums[3] + plane[channels];
}

/* gradient (channels + 1) of the objective at `plane`. */
static void gradient_at(const float *examples, size_t n, size_t positive, size_t channels,
	const double *plane, double *gradient)
{
	for (size_t c = 0; c < channels; c++)
		gradient[c] = HYPERPLANE_DECAY * plane[c];
	gradient[channels] = 0;
	for (size_t i = 0; i < n; i++) {
		const float *feature = examples + i * channels;
		const double side = hyperplane_side(plane, feature, channels);
		const double share = 0.5 / (double)(i < positive ? positive : n - positive);
		const double slope = i < positive ? -share / (1 + exp(side)) : share / (1 + exp(-side));
		for (size_t c = 0; c < channels; c++)
			gradient[c] += slope * (double)feature[c];
		gradient[channels] += slope;
	}
}

int hyperplane_fit(
	const float *examples, size_t n, size_t positive, size_t channels, double *plane, struct err *e)
{
	/* the slope of a logistic function changes by 1/4 at most, and |f|^2 + 1 is 2 at most */
	const double step = 1 / (0.5 + HYPERPLANE_DECAY);
	SCOPED double *ahead = mem_zalloc(3, (channels + 1) * sizeof *ahead, "hyperplane", e);

	if (!ahead)
		return -1;
	double *before = ahead + channels + 1, *gradient = before + channels + 1;
	memset(plane, 0, (channels + 1) * sizeof *plane);
	for (int t = 0; t < HYPERPLANE_STEPS; t++) {
		const double momentum = (double)t / (t + 3);
		for (size_t c = 0; c <= channels; c++) {
			ahead[c] = plane[c] + momentum * (plane[c] - before[c]);
			before[c] = plane[c];
		}
		gradient_at(examples, n, positive, channels, ahead, gradient);
		for (size_t c = 0; c <= channels; c++)
			plane[c] = ahead[c] - step * gradient[c];
	}
	return 0;
}
