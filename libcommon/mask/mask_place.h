/* Where and when a mask is, beside its pixels: the point that a prediction points at, and the boxes that a
 * label has. Localisation accuracy (Kerr et al. 2023, LERF) asks whether the one lies in the other. */
#pragma once

#include "base/err.h"
#include "mask/rle.h"

struct mask_place {
	int has_peak;
	double peak[2]; /* column and row of a pixel, of the mask's size; the first pixel is 0,0 */
	size_t box_count, box_room;
	double (*boxes)[4]; /* left, top, right, bottom, in the same units; owned */
	int has_time;	    /* the view is of this time, of a scene that moves */
	double time;
	int has_when; /* the sentence is of motion, from when to when */
	double when[2];
};

/* A zeroed one; NULL with *e set. */
struct mask_place *mask_place_new(struct err *e);
void mask_place_free(struct mask_place *p);

/* Appends a box, whose corners may be in any order. */
int mask_place_add_box(struct mask_place *p, const double box[4], struct err *e);

/* left, top, right, bottom of the foreground: its first and last columns and rows; 0: empty. */
int mask_place_bounds(const struct rle *r, double box[4]);

/* Whether a point, in pixels of a mask of height x width, lies in a box of the truth, its edges counting; the
 * box around the truth's mask where `boxes` has none (NULL: none). It is brought to the truth's size. */
int mask_place_in_box(
	const double peak[2], int height, int width, const struct rle *truth, const struct mask_place *boxes);

/* Whether the pixel of the truth's mask at that point is foreground. */
int mask_place_in_mask(const double peak[2], int height, int width, const struct rle *truth);
