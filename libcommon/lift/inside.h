/* What is of a thing though no view shows it: the Gaussians inside it and behind its surface, which would
 * stay as its ghost when those that its masks show are taken away.
 *
 * Such a Gaussian lies in the thing's hull, has nowhere more than INSIDE_SHOWN of a pixel, is of no other
 * thing, and its INSIDE_VOTERS nearest of the thing's own are nearer than as many of others that views show:
 * what stands in a bowl, or is under a foot, has its own surface nearest. The hull is what INSIDE_DIRECTIONS
 * half-spaces have in common, each with all but INSIDE_TRIM of the thing's Gaussians, INSIDE_REACH times as
 * large. formats/records/boxes.md says how these were chosen. */
#pragma once

#include "base/err.h"
#include "lift/extent.h"
#include "splat/splats.h"

enum { INSIDE_DIRECTIONS = 102, INSIDE_VOTERS = 3 };
#define INSIDE_SHOWN 0.05f
#define INSIDE_TRIM 0.01
#define INSIDE_REACH 1.15

/* taken (s->n) is 1 for the thing's own Gaussians, and gets 1 for those inside. x: the thing without strays;
 * most (s->n): splat/visibility.h; others (s->n): what is of other things, or NULL. 0, or -1 with *e. */
int inside_take(char *taken, const struct extent *x, const struct splats *s, const float *most,
	const char *others, struct err *e);
