/* Objects from their masks in many views onto the Gaussians, in closed form: a Gaussian's share in an object
 * is the part of its blend weight that falls inside the object's masks,
 *     a_io = sum_v u_vo sum_p w_pi M_vo(p) / sum_v u_vo sum_p w_pi,
 * both sums over the views that have a mask of the object: one without says nothing, as a detector may have
 * missed it. The weighted mean minimises sum_p w_pi (M(p) - a)^2: Occam's LGS (arXiv 2412.01807) and LUDVIG
 * (arXiv 2410.14462) lift features so; FlashSplat (arXiv 2409.08270) shows that cutting it at one half is the
 * optimum of a linear programme for the mask; Splat Feature Solver (arXiv 2508.12216,
 * the row-sum preconditioner) bounds how far it is from the best solution of all Gaussians together.
 *
 * Detectors are wrong, and alike in many views. The vote u_vo of a mask is therefore the square of how well
 * it agrees with what all masks of its object have in common, found in a few rounds; and where objects claim
 * the same Gaussian, the one with the larger share has it while votes are found. So "the yellow box" that is
 * a red bag in half of the views loses those, as the bag's own masks are there in nearly all. Measured on the
 * desk (11 objects, two test views, weights at a third, the cut of lifted.h): the mean alone 70.9 mIoU, with
 * all of it 88.0.
 *
 *     for each view { lift_objects_view; }
 *     for each of LIFT_ROUNDS rounds { but in the first, for each view { lift_objects_vote; }
 * lift_objects_settle; } Within a round the views may come in any order, and from many threads at once.
 * Results are the same to the bit for any number of threads, not where views have other numbers. */
#pragma once

#include "base/err.h"
#include "lift/lifted_model.h"
#include "lift/shares.h"
#include "mask/mask.h"
#include "splat/view_matrix.h"

enum { LIFT_ROUNDS = 3 };

/* The median of lift_left_out below which masks show no one scene, and below which they hardly do. Honest
 * masks have 0.89 on made scenes, 0.67 on a desk and 0.40 in a flat, where 17 masks of three frames have 0.21
 * to 0.32; masks of the next view 0.21 at most. Cameras in another frame, which see the same things a little
 * aside, 0.22 to 0.65, so that many are missed. */
#define LIFT_LEFT_OUT_LEAST 0.25
#define LIFT_LEFT_OUT_FEW_LEAST 0.18 /* of fewer than LIFT_LEFT_OUT_SURE masks */
#define LIFT_LEFT_OUT_FINE 0.35
enum { LIFT_LEFT_OUT_SURE = 24 };
/* The mean agreement of objects below which a detector's masks show no one scene: pseudomask-select makes
 * them of regions, which are the same in all views whatever they are of. It is 0.70 on the desk, 0.78 to 0.84
 * on made scenes and 0.49 on one of 1,000 Gaussians; with cameras in another frame 0.27 to 0.54. */
#define LIFT_AGREEMENT_LEAST 0.45
enum { LIFT_LEFT_OUT_MASKS = 4 /* of fewer nothing is said */ };

/* Cuts that are tried of an object: LIFTED_CUT, LIFTED_CUT - LIFT_CUT_STEP, ...; the largest that fits its
 * masks as well as the best but for LIFT_CUT_GAIN. */
enum { LIFT_CUTS = 8 };
#define LIFT_CUT_STEP 0.05
#define LIFT_CUT_GAIN 0.005

/* A mask and the number of the object that it is of. */
struct lift_mask {
	const struct mask *mask; /* of any size: reduced to the weights' by area and cut at one half */
	size_t object;
};

/* A view's masks and what they show. */
struct lift_view {
	size_t n;
	size_t *objects;	 /* (n) that have a mask, rising */
	size_t *starts;		 /* (n+1) where the masks of each begin */
	uint64_t *bits;		 /* (masks,tiles of the picture) mask/bits.h */
	struct shares *rows;	 /* (n) of the mean of each one's masks */
	float *vote;		 /* (n) of this round */
	double *agreement;	 /* (n) of this round */
	float (*fit)[LIFT_CUTS]; /* (n) of this round: IoU of the mask with what is above each cut */
	float *weight;		 /* (N) of each Gaussian */
};

/* The object that a Gaussian is of while votes are found, LIFT_NOBODY for none, and its share in it. */
struct lift_claim {
	int32_t object;
	float share;
};
enum { LIFT_NOBODY = -1 };

struct lift_objects {
	size_t gaussians, objects;
	int round;
	size_t view_count;
	struct lift_view *views;   /* (view_count) */
	struct shares *shares;	   /* (O) of Gaussians, from the round before */
	struct lift_claim *claims; /* (N) */
	/* of the views' masks, by object */
	double *agreement; /* (O) after the last round the mean */
	float *cut;	   /* (O) after the last round */
	size_t *masks;	   /* (O) views that have one */
};

/* For views of the numbers 0 to views - 1. Returns 0, or -1 with *e set and nothing to free. */
int lift_objects_init(struct lift_objects *l, size_t gaussians, size_t objects, size_t views, struct err *e);
void lift_objects_free(struct lift_objects *l);

/* The masks of view `at`, in the order of their objects; several of one object are averaged. A view without
 * masks need not come. Memory for a number of each Gaussian a view, two of each that a mask shows, and a bit
 * for each pixel a mask. Returns 0, or -1 with *e set for want of memory. */
int lift_objects_view(struct lift_objects *l, size_t at, const struct view_matrix *w,
	const struct lift_mask *masks, size_t n, struct err *e);

/* In a round after the first: how well the view's masks agree with what was lifted. */
int lift_objects_vote(struct lift_objects *l, size_t at, const struct view_matrix *w, struct err *e);

/* Ends a round. Returns 0, or -1 with *e set for want of memory. */
int lift_objects_settle(struct lift_objects *l, struct err *e);

/* After the last round, or instead of rounds after lift_objects_view alone, when it finds votes itself: how
 * far each mask of the first `named` objects is what the other views' masks lifted of its object, soft
 * intersection over union of what they show of each Gaussian; the median over the masks that can be compared,
 * NAN where these, *masks, are fewer than LIFT_LEFT_OUT_MASKS. 0, or -1 with *e. */
int lift_left_out(struct lift_objects *l, size_t named, double *agreement, size_t *masks, struct err *e);

/* After the last round: gaussians, objects, confidence, indptr, index and share of a zeroed model, whose
 * names and sentences are the caller's to fill. Returns 0, or -1 with *e set and *to as it can be freed. */
int lift_objects_finish(const struct lift_objects *l, struct lifted *to, struct err *e);
