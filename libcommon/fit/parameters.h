/* Gaussians that are being trained: what is stored of each is free of limits, as 3DGS has it (Kerbl et al.
 * 2023): logarithms of the scales, quaternions of any length, logits of the opacities. Parameters, gradients
 * and both moments of Adam are a slab each, of one layout: part after part, each (capacity,width) on a cache
 * line. */
#pragma once

#include "base/err.h"
#include "splat/splats.h"

/* The spherical harmonics stand apart by degree: a degree that is not trained yet costs nothing. */
enum fit_part { FIT_MEAN, FIT_SCALE, FIT_QUAT, FIT_LOGIT, FIT_SH, FIT_SH1, FIT_SH2, FIT_SH3, FIT_PARTS };
enum fit_slab { FIT_VALUE, FIT_GRADIENT, FIT_MOMENT1, FIT_MOMENT2, FIT_SLABS };
extern const unsigned char fit_width[FIT_PARTS]; /* 3 3 4 1 3 9 15 21 */

/* A scene of such a size (start_size) has the constants of 3DGS-MCMC that are in units of length. */
#define FIT_SIZE 10.0

struct fit_gaussians {
	size_t n, capacity;		 /* there are; at most */
	int degree;			 /* of the harmonics that there is room for, 0 to 3 */
	float *at[FIT_SLABS][FIT_PARTS]; /* NULL for a part above the degree */
	float *slab;			 /* all of them */
	struct splats splats;		 /* with activations; means and quats are those of the slab */
};

/* Room for `capacity` Gaussians, all zero; n is 0. Returns 0, or -1 with *e; fit_gaussians_free
 * after either. */
int fit_gaussians_alloc(struct fit_gaussians *g, size_t capacity, int degree, struct err *e);
void fit_gaussians_free(struct fit_gaussians *g);

/* How many parts there are up to that degree of the harmonics. */
int fit_parts(int degree);

/* Brings scales and opacities of g->splats up to the parameters; its harmonics are not. */
void fit_gaussians_activate(struct fit_gaussians *g);

/* Adds the Gaussians of a trained scene, as many as there is room for. */
void fit_gaussians_take(struct fit_gaussians *g, const struct splats *from);

/* Leaves those with kept[i] (n) not 0, with their moments. */
void fit_gaussians_keep(struct fit_gaussians *g, const char *kept);

/* A trained scene of those with kept[i] (n) not 0, quaternions of length 1. Returns 0, or -1 with *e set and
 * *to zeroed. */
int fit_gaussians_give(const struct fit_gaussians *g, const char *kept, struct splats *to, struct err *e);

/* 1 where every parameter is finite. */
int fit_gaussians_are_finite(const struct fit_gaussians *g);
