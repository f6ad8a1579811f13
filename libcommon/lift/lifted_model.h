/* Objects lifted onto the Gaussians in closed form: geometry is frozen, so the share of a Gaussian's blend
 * weight that falls inside an object's masks says whether it is of the object, and nothing is trained. With
 * the sentences that named the objects, this is a model that answers as a trained one does. */
#pragma once

#include "base/err.h"
#include "lift/extent.h"

#include <stdint.h>

struct lifted {
	size_t gaussians; /* N of the scene */

	size_t objects;	   /* O */
	char **names;	   /* (O), different */
	float *confidence; /* (O) in [0,1]: how well the object's masks agree with what was lifted of them */
	/* The Gaussians of object o are index[indptr[o]..indptr[o+1]), rising; others have 0. */
	int64_t *indptr; /* (O+1) */
	int32_t *index;	 /* (indptr[O]) */
	float *share;	 /* (indptr[O]) in (0,1]: part of the Gaussian's weight inside the object's masks */

	/* The training sentences: what other sentences are compared with. */
	size_t sentences; /* R */
	int width;	  /* D_text */
	int32_t *object;  /* (R) the object that each names */
	char **texts;	  /* (R) */
	char **pieces;	  /* (R) its word pieces with single spaces between, as many as it has words here */
	int64_t *offsets; /* (R+1) into words */
	float *words;	  /* (offsets[R], width) */
	float *middle;	  /* the same of the encoder's middle layer, which sentences are taken apart by; NULL:
			     none */
	float *cut;	  /* (O) in (0,1): see lifted_cut_of; NULL: LIFTED_CUT of all */

	const struct extent *extents; /* (O) somebody else's, of lifted_extents; NULL: not known */
};

/* All arrays are the struct's own; a zeroed one may be freed. */
void lifted_free(struct lifted *l);

/* The words of a sentence by the middle layer; NULL where there are none. */
const float *lifted_middle(const struct lifted *l, size_t sentence);

/* Only the first objects stay, without the others, which no sentence names. */
void lifted_cut(struct lifted *l, size_t objects);

/* Adds the objects and sentences of another model of the same scene and encoder, in place of those objects
 * that have their names. Returns 0, or -1 with *e set and *to as it was. */
int lifted_add(struct lifted *to, const struct lifted *more, struct err *e);

/* An object's mask in a view is where sum_i w_pi (a_i - cut) > 0: where more than this part of what is
 * seen in the pixel is the object's. Of 0.35, 0.4, 0.45, 0.5 and 0.55, mean mIoU of two synthetic scenes
 * (diner, seed 1; tea, seed 3; half size, ragged masks): 92.5, 93.5, 94.0, 94.1, 93.2. */
#define LIFTED_CUT 0.45f

/* The same of an object: what fits its own masks best. Where Gaussians are as large as a small or thin thing
 * they are its own in part only, and the common cut leaves nothing of it. */
float lifted_cut_of(const struct lifted *l, size_t object);

/* responses (N) = a_i - lifted_cut_of, with the share a_i of each Gaussian in the object. */
void lifted_responses(const struct lifted *l, size_t object, float *responses);

/* Where each object is: (O) extents of the Gaussians with responses above 0 that can be seen, in the frame of
 * the splats. Returns 0, or -1 with *e set. */
int lifted_extents(struct extent **extents, const struct lifted *l, const struct splats *s,
	const double up[3], struct err *e);
/* The same again after Gaussians have moved: of objects whose poses (O) are those of before, nothing. At
 * first extents and poses are zero; poses NULL: all are found. */
int lifted_extents_again(struct extent *extents, uint64_t *poses, const struct lifted *l,
	const struct splats *s, const double up[3], struct err *e);
/* Of O, or NULL. */
void lifted_extents_free(struct extent *extents, size_t objects);
