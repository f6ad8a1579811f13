/* A scene that moves: scene/motion.safetensors (refer.motion), where the Gaussians that ever move or turn are
 * at each stored time (formats/scene/motion.md). A scene without the file is still. */
#pragma once

#include "base/err.h"
#include "base/scratch.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"
#include "splat/splats.h"

#include <stdint.h>

/* In place: the file is mapped, and no more than one time of it is copied. */
struct motion {
	size_t times, moved, gaussians; /* T, M, and N of the scene */
	const double *at;		/* (T) rising */
	const int32_t *ids;		/* (M) rising: the Gaussians that ever move */
	const float *means, *quats;	/* (T,M,3), (T,M,4) as of struct splats */
	const float *scales;		/* (T,M,3); NULL: they stay as they are */
	struct fingerprint scene;	/* of the scene's splats, which are those of the first time */
	struct safetensors file;
};

/* Maps and checks a file. Returns 0, or -1 with *e set; motion_close after either. */
int motion_open(struct motion *m, const char *path, struct err *e);
void motion_close(struct motion *m);

/* Whether any of n numbers is another. */
int motion_differs(const float *a, const float *b, size_t n);

/* *frame: the stored time that is nearest to t, of two the earlier one. -1 with *e (ERR_FORMAT, names the
 * range) where t is outside of the stored times. */
int motion_find(const struct motion *m, double t, size_t *frame, struct err *e);

/* Moves the scene's splats (N), which may have been moved before, to the stored time that motion_find gives.
 * By many threads at a time. */
int motion_set(const struct motion *m, double t, struct splats *s, struct err *e);

/* A file in the making: times are put one by one, in any order, and wait in a file without a name. */
struct motion_out {
	const struct splats *first; /* of the first time */
	size_t times;
	int has_scales; /* some of them change */
	char *is_moved; /* (N) */
	float *row;	/* (10 N) */
	struct scratch put, gathered;
	struct scratch_part *parts; /* (T) of put: means, quaternions and standard deviations */
};

/* `path` is that of the file. After it motion_out_free is in order. All return 0, or -1 with *e set. */
int motion_out_begin(
	struct motion_out *o, const char *path, const struct splats *first, size_t times, struct err *e);
/* The splats of a stored time but the first, in the first's order; one thread at a time. */
int motion_out_put(struct motion_out *o, size_t frame, const struct splats *s, struct err *e);
/* at (T); *moved gets M. */
int motion_out_end(struct motion_out *o, const double *at, size_t *moved, struct err *e);
void motion_out_free(struct motion_out *o);
