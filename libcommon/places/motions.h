/* What words of motion mean, from tracks alone: how well each object's way fits, in [0,1], and from when to
 * when it does. Lengths are in sizes of the object, speeds beside those of others: a scene that is scaled,
 * shifted, turned or played faster has the same answers. */
#pragma once

#include "lang/motion_said.h"
#include "places/track.h"
#include "places/viewpoint.h"

/* Stored times; a == b: no time. */
struct motions_span {
	size_t a, b;
};

struct motions {
	const struct tracks *tracks;
	double axes[3][3],
		eye[3]; /* rows: to the right, away and up, as who speaks sees it; and from where */
};

/* As seen from there. */
void motions_look(struct motions *m, const struct tracks *t, const struct cameras *cameras,
	const struct viewpoint *from);

/* How well object o fits a kind of motion within *in, which becomes the time of that motion. about: the other
 * object; -1: any, or who looks. */
double motions_judge(
	const struct motions *m, enum motion_kind kind, size_t o, long about, struct motions_span *in);

/* The same of what compares, MOTION_FASTEST and after it, for all objects: fits (O), among those that are
 * what is said besides as far as as (O) says. in (O): the time that each is compared in. */
void motions_rank(const struct motions *m, enum motion_kind kind, const double *as,
	const struct motions_span *in, double *fits);
