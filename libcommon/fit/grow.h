/* How Gaussians are added and moved: 3D Gaussian Splatting as Markov Chain Monte Carlo (Kheradmand et al.
 * 2024). What is too faint is put where there is more to show; the number rises to a bound; a little noise
 * explores. */
#pragma once

#include "base/rng.h"
#include "fit/fit.h"
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

/* Only what a scene needs: how well it is learned is looked at from time to time, growing ends where more
 * Gaussians no longer help, and those that then add nothing are left out. */

/* At so much of the progress the scene is pruned; what follows heals it. */
#define FIT_PRUNED 0.85

/* What may be lost by pruning, dB. */
#define FIT_PRUNE_LOSS 0.1

/* Means of PSNR and SSIM of these photographs. Returns 0, or -1 with *e set. */
int fit_judge_all(
	struct fit *f, const struct photograph *first, size_t n, double *psnr, double *ssim, struct err *e);

/* Judges by the photographs held out, or by all where none is, once for each twentieth of the progress;
 * *is_due gets whether it was. Growing ends where so little was gained since the last time, in full size,
 * that more Gaussians do not pay. Returns 0, or -1 with *e set. */
int fit_evaluate(struct fit *f, double progress, int *is_due, double *psnr, double *ssim, struct err *e);

/* Leaves out as many as it can, up to half, those that the photographs show least first, for at most
 * FIT_PRUNE_LOSS. Returns 0, or -1 with *e set. */
int fit_prune(struct fit *f, struct err *e);
