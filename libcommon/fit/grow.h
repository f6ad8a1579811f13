/* How Gaussians are added and moved: 3D Gaussian Splatting as Markov Chain Monte Carlo (Kheradmand et al.
 * 2024). What is too faint is put where there is more to show; the number rises to a bound; a little noise
 * explores. */
#pragma once

#include "base/rng.h"
#include "fit/parameters.h"

#include <stdint.h>

/* At most this opaque is dead. */
#define GROW_DEAD 0.005f

/* Moves those with dead[i] (n) onto others, and adds copies until there are `wanted`, or as many as have
 * room. The others are drawn of those alive, with a chance in proportion to their opacity; a copy and its
 * original share opacity and scale so that together they show what the original did (section 4.3 there).
 * Activations must be up to date, and are not after. Returns 0, or -1 with *e set. */
int grow(struct fit_gaussians *g, const uint8_t *dead, size_t wanted, struct rng *rng, struct err *e);

/* Shifts each mean by the covariance times noise, the more the fainter it is; `rate` is that of the
 * positions. The covariance, a square of lengths, is taken in units of the scene's size, so that a scene may
 * be in any unit. The same for one seed and step, whatever the threads. */
void grow_noise(struct fit_gaussians *g, double rate, double size, uint64_t seed, long step);

/* The opacity and the factor on the scales of each of `copies` that together look like one of that opacity.
 */
void grow_split(double opacity, int copies, double *part, double *factor);
