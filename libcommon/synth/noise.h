/* Smooth noise: for the grain of wood, for mottled colours, and for ragged outlines. */
#pragma once

#include "base/rng.h"

enum { SYNTH_NOISE_PERIOD = 64 }; /* a power of two */

struct synth_noise {
	float lattice[SYNTH_NOISE_PERIOD][SYNTH_NOISE_PERIOD]; /* in [-1,1) */
};

void synth_noise_make(struct synth_noise *n, struct rng *r);

/* Between the lattice's points, which lie at whole x and y and repeat with the period. In [-1,1). */
double synth_noise_at(const struct synth_noise *n, double x, double y);
