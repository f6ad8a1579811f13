/* Where lifted objects are at each stored time of a scene that moves, how they are turned, and when each
 * moves.
 *
 * An object's position is where its Gaussians that are no strays (lift/extent.h) were on average, moved by
 * the median of what they have moved by since, so that a few of something else do not count; its turn is the
 * rotation that takes these points from the first time to this one best (Horn 1987). Both together are a
 * point of 12 numbers, in which turning counts as much as moving does where the points are. What an object
 * does by less than `reach` is rest: a share of its size, of the scene's, or a multiple of its noise,
 * whichever is most. Nothing has a unit, so that a scene that is scaled, shifted or turned, or whose clock is
 * another, has the same moves. */
#pragma once

#include "base/err.h"
#include "lift/extent.h"
#include "splat/splats.h"

/* One time without rest. */
struct track_move {
	size_t first, last; /* stored times: it rests until the first and from the last on */
	double path;	    /* how far it goes, along its way */
	double speed;	    /* the highest, of a reach */
	double turned;	    /* radians about the upright axis, positive to the left as seen from above */
	double rolled;	    /* radians about level axes */
};

struct track {
	double (*at)[3];      /* (T) position, in the frame of the splats */
	double (*turn)[3][3]; /* (T) rotation since the first time */
	double size;	      /* the side of a cube as large as its box from corner to corner */
	double reach;	      /* less than this is rest */
	double noise;	      /* of the 12 numbers, from one time to the next */
	size_t moves;
	struct track_move *move; /* (moves) in the order of time */
	/* Its points: */
	size_t points;
	int is_moved; /* 0: none of them ever does */
	int32_t *ids;
	double *weight; /* sums to 1 */
	double (*first)[3];
};

struct tracks {
	size_t n, times; /* O, T */
	const double *t; /* (T) rising; the caller's */
	double up[3];
	double scene;	  /* from corner to corner of all that objects pass through */
	struct track *of; /* (O) */
};

/* Of objects with extents (O), at `times` stored times, t. is_moved (N): whether a Gaussian ever
 * changes; NULL: any may. tracks_put once for each stored time, in order; then tracks_end finds the moves.
 * All return 0, or -1 with *e set; after any tracks_free. */
int tracks_begin(struct tracks *to, size_t objects, const struct extent *extents, const struct splats *s,
	const double *t, size_t times, const char *is_moved, const double up[3], struct err *e);
int tracks_put(struct tracks *to, size_t time, const struct splats *s, struct err *e);
int tracks_end(struct tracks *to, struct err *e);
void tracks_free(struct tracks *to);

/* How far it is moved and turned between two stored times, as a length. */
double track_between(const struct track *k, size_t a, size_t b);

/* How far it goes between two stored times, along its way in steps of a reach. */
double track_path(const struct track *k, size_t a, size_t b);
