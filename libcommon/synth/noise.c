#include "synth/noise.h"

#include <math.h>

void synth_noise_make(struct synth_noise *n, struct rng *r)
{
	for (int i = 0; i < SYNTH_NOISE_PERIOD; i++)
		for (int j = 0; j < SYNTH_NOISE_PERIOD; j++)
			n->lattice[i][j] = (float)rng_range(r, -1, 1);
}

double synth_noise_at(const struct synth_noise *n, double x, double y)
{
	double left = floor(x), low = floor(y), u = x - left, v = y - low;
	int j = (int)fmod(left, SYNTH_NOISE_PERIOD) & (SYNTH_NOISE_PERIOD - 1);
	int i = (int)fmod(low, SYNTH_NOISE_PERIOD) & (SYNTH_NOISE_PERIOD - 1);
	int j1 = (j + 1) & (SYNTH_NOISE_PERIOD - 1), i1 = (i + 1) & (SYNTH_NOISE_PERIOD - 1);

	u = u * u * (3 - 2 * u);
	v = v * v * (3 - 2 * v);
	double bottom = n->lattice[i][j] + u * (n->lattice[i][j1] - n->lattice[i][j]);
	double top = n->lattice[i1][j] + u * (n->lattice[i1][j1] - n->lattice[i1][j]);
	return bottom + v * (top - bottom);
}
