/* Only what a scene needs: how well it is learned is looked at from time to time, growing ends where more
 * Gaussians no longer help, and those that then add nothing are left out. */
#pragma once

#include "fit/fit.h"

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
