/* Training of 3D Gaussians from posed photographs: the loss and the rates of 3DGS (Kerbl et al. 2023), number
 * and places by 3DGS-MCMC (fit/grow.h), images from coarse to fine. What is trained is what the rasteriser
 * (splat/render.h) shows, over black. The same input, options and seed give the same bytes for any number of
 * threads. */
#pragma once

#include "base/err.h"
#include "base/rng.h"
#include "fit/back.h"
#include "fit/exposure.h"
#include "fit/parameters.h"
#include "fit/photo_loss.h"
#include "fit/photograph.h"

#include <stdint.h>

struct fit_options {
	double extent; /* start_extent's: what positions are measured by */
	double size;   /* start_size's: what the noise and the weight on scales are measured by */
	uint64_t seed;
};

/* What changes from step to step besides the parameters; all of 8 bytes, as a checkpoint has it. */
struct fit_state {
	int64_t gaussians; /* in a checkpoint */
	int64_t iteration; /* steps done */
	int64_t weighed;   /* the step from which weights are summed */
	int64_t first;	   /* Gaussians there were at the start */
	int64_t most;	   /* Gaussians there may be */
	int64_t is_pruned; /* nothing is added any more */
	struct rng rng;
	double grown;	      /* the progress at which Gaussians were last moved or added */
	double psnr;	      /* at the last evaluation; 0: there was none */
	double judged;	      /* the progress then */
	double loss, squares; /* sums over the steps since the caller set them to 0 */
	double spent;	      /* the caller's: seconds */
};

struct fit {
	struct fit_options options;
	struct fit_gaussians gaussians;
	const struct photograph *photographs; /* (views) to learn from; the caller's */
	size_t views;
	size_t held_out; /* the last so many are learned from only once the scene is pruned */

	struct fit_state state;
	struct exposures exposures; /* (views), or none */
	uint32_t *order;	    /* (views) in which they are looked at, until the next shuffle */
	struct photo_loss last;	    /* of the last step's view */

	struct render_view *view;
	uint8_t *seen; /* (capacity) by that view */
	struct back_room back;
	struct photo_loss_room room;
	float *colors, *sums; /* (capacity,3), (capacity,BACK_SUMS) */
	float *weight;	      /* (capacity) what each has shown since, in pixels of full size */
	uint8_t *dead;	      /* (capacity) */
	float *image;	      /* (3,P), its gradient (3,P), what the photograph shows of it (3,P) */
	size_t image_room;
};

/* A fit of the Gaussians in *g, which become its own; in the end there are as many as it has room for.
 * Returns 0, or -1 with *e set; fit_close after either. */
int fit_open(struct fit *f, struct fit_gaussians *g, const struct fit_options *o,
	const struct photograph *photographs, size_t views, size_t held_out, struct err *e);
void fit_close(struct fit *f);

/* A step on one photograph. progress, from 0 to 1 and never less than before, is how much of the training is
 * done: by it go the size of the images, the rates, the degree of the harmonics and the number of Gaussians.
 * Returns 0, or -1 with *e set: ERR_CHECK where the Gaussians are no more finite numbers. */
int fit_step(struct fit *f, double progress, struct err *e);

/* The loss of a photograph, in full size and with all harmonics, by its own exposure, or the nearest where it
 * is not one of those learned from; f->image is what was judged. Returns 0, or -1 with *e set. */
int fit_judge(struct fit *f, const struct photograph *p, struct photo_loss *l, struct err *e);

/* Learns exposures from now on where the Gaussians' colours say that photographs differ by more than `least`
 * (exposures_guess); *spread gets by how much they do. Returns 0, or -1 with *e set. */
int fit_expose(struct fit *f, double least, double *spread, struct err *e);

/* Returns 0, or -1 with *e set (ERR_CHECK) where the Gaussians are no more finite numbers. */
int fit_check(const struct fit *f, struct err *e);

/* 10 log10 (1 / mean of squares), dB. */
double fit_psnr(double squares);

/* kept (n) gets 1 for the Gaussians that some photograph shows: with weights of FIT_SHOWN in sum over its
 * pixels at that level. worth (n) gets the sums over all photographs; NULL: not wanted. Returns 0, or -1 with
 * *e set. */
#define FIT_SHOWN 0.02f
int fit_shown(struct fit *f, int level, char *kept, float *worth, struct err *e);
