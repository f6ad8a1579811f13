/* Which region of the scene each object is, from candidate masks of all objects in all views, and the mask
 * of it in each view.
 *
 * The paper picks a mask for each object and view alone, by the votes of the object's sentences there
 * (mask/select.h). But a detector that misunderstands a sentence does so in every view alike, so that whole
 * objects are confused; the other objects' masks tell. In steps:
 *
 * 1. Candidates of whatever object agree on regions. A candidate k of view v is lifted: Gaussian i has
 *    l_ki = sum of w_pi over the mask's pixels, out of W_vi = sum of w_pi over the view's. A region is a set
 * R of Gaussians, and its agreement with a candidate the intersection over union in the view, sum_R l_ki /
 * (sum_R W_vi + sum l_ki - sum_R l_ki). It grows from one candidate: R is what the view shows of it; in every
 * view the candidate that agrees best joins; R is the Gaussians with more than half of their weight, over the
 * views of those that joined, in their masks; and again, until they stay.
 * 2. Each sentence is a witness to what its object is: q_s(R) is the share of its candidates, by confidence,
 *    that agree with R more than with any other region. The value of R for an object is the sum of
 *    log(q_s(R) + 1/50) over its sentences: the object's region is one that all of them find at least at
 *    times, and what one sentence is sure of weighs little where another never sees it. Objects get distinct
 *    regions with the largest sum of values; none where that is no better than to be found by no sentence.
 * 3. The object's mask in a view is the candidate, of whatever object, that agrees with its region; where
 *    none agrees nearly as well as they do in its other views, the region itself is rendered (lift.h).
 * 4. Regions that are left over may still be an object: one that the detector takes for another in all of its
 *    sentences. Spare are those that candidates show in a quarter of the views, of whose weight less than
 * half is in the regions of objects or in that of a spare one with more support, the sum of q_s(R) over all
 *    sentences. Which object it is, if any, only the sentences tell (ask/disambiguate.h).
 *
 * Masks of a view that look alike (regions_lift.c) are one candidate, so that time and memory go by the
 * different ones. What a mask shows is kept by mask and by Gaussian (shares.h): two numbers each. A region
 * then asks its Gaussians which candidates show them. What an agreement below JOINS * PEER is
 * (regions_private.h) is never looked at, and given as 0.
 *
 * All of it is the same to the bit for any number of threads. */
#pragma once

#include "base/err.h"
#include "lift/lift_objects.h"
#include "lift/seen.h"
#include "lift/shares.h"
#include "mask/pool.h"
#include "splat/view_matrix.h"

#include <stdint.h>

#define REGIONS_NONE SIZE_MAX

/* A mask as it came, numbered. */
struct regions_witness {
	const struct mask *mask;
	size_t view, object, sentence;
	size_t candidate; /* the one it stands for, or REGIONS_NONE before its view is lifted */
};

/* A mask that is lifted: the surest of those that look alike in a view. */
struct regions_candidate {
	const struct mask *mask;
	size_t view;
	struct shares shares; /* l_ki */
	double mass;	      /* their sum */
};

struct regions_range {
	size_t begin, end;
};

struct region {
	size_t n;
	int32_t *members; /* (n) Gaussians, in order */
	float *agreement; /* (count) with each candidate */
	size_t *chosen;	  /* (views) the candidate that agrees best and well, or REGIONS_NONE */
	double typical;	  /* median of the agreements of those chosen */
};

struct regions {
	size_t views, gaussians;
	size_t witness_count;
	struct regions_witness *witnesses;    /* (witness_count) by view, the surest first */
	size_t count;			      /* 0 before regions_grow */
	struct regions_candidate *candidates; /* (count of witness_count) in the order of the views */
	struct regions_range *ranges;	      /* (views) each view's candidates */
	size_t object_count;
	size_t *objects; /* (object_count) the first candidate of each, in the order in which they came */
	size_t sentence_count;
	size_t *sentence_objects; /* (sentence_count) */
	struct seen *seen;	  /* (views) W_vi */
	size_t region_count, region_capacity;
	struct region *regions;
	size_t *served; /* (object_count) an object's region, or REGIONS_NONE */
	size_t spare_count;
	size_t *spare; /* (spare_count) regions that are of no object, the best supported first */
	float *field;  /* a channel of lift.h for each object: its region's share of a Gaussian's weight, -1/2
			*/
};

/* The masks with score > min_score. places (pool's n) has the view of each, below `views`; the
 * pool's masks are referred to. */
int regions_init(struct regions *r, const struct pool *p, const size_t *places, size_t views,
	size_t gaussians, double min_score, struct err *e);
void regions_free(struct regions *r);

/* Lifts the candidates of a view, which has these weights; masks of another size are reduced by area. Once a
 * view, in any order, and from many threads at once; masks of other views are left out. */
int regions_lift(struct regions *r, size_t view, const struct view_matrix *w, struct err *e);

/* Grows the regions, after all views are lifted. */
int regions_grow(struct regions *r, struct err *e);

/* The surest candidate of each object in each view, for lift_left_out, after regions_grow; its rows are r's.
 * Returns 0, or -1 with *e set; regions_surest_free after either. */
int regions_surest(const struct regions *r, struct lift_objects *to, struct err *e);
void regions_surest_free(struct lift_objects *l);

/* Gives each object its region, and finds the spare ones, after regions_grow. */
int regions_assign(struct regions *r, struct err *e);

/* The candidate that shows spare region k in a view, after regions_assign, or NULL; *score: its agreement. */
const struct mask *regions_spare(const struct regions *r, size_t k, size_t view, double *score);

/* Whether some object's region has to be rendered in a view. */
int regions_need_weights(const struct regions *r, size_t view);

/* masks and scores (object_count) in a view, after regions_assign; rle_free each mask. w may be NULL where
 * no weights are needed. They have the size of the view's candidates, or of its weights where it has none;
 * empty where an object has no region or shows nothing of it. The score is the agreement of the candidate
 * with the region, and the region's typical one where it is rendered: *rendered goes up by each such mask
 * that is not empty. On failure there are none. */
int regions_render(const struct regions *r, size_t view, const struct view_matrix *w, struct rle *masks,
	double *scores, size_t *rendered, struct err *e);
