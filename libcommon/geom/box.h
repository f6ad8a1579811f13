/* Boxes in space, turned any way. */
#pragma once

struct box {
	double centre[3];
	double axes[3][3]; /* three unit vectors at right angles, right-handed */
	double half[3];	   /* half the extent along each axis, >= 0 */
};

/* The box along the world's axes between two corners. */
struct box box_between(const double low[3], const double high[3]);

/* The corners of the smallest box along the world's axes around b. */
void box_bounds(const struct box *b, double low[3], double high[3]);

double box_volume(const struct box *b);

/* The length from corner to corner. */
double box_diagonal(const struct box *b);

/* Intersection over union, in [0,1]. By the volume that both share, which is exact to 1e-8 of the smaller
 * box's: clipped faces, and the divergence theorem. 0 where neither has a volume. */
double box_iou(const struct box *a, const struct box *b);

/* How far the nearest points of two boxes are apart, 0 where they touch. */
double box_gap(const struct box *a, const struct box *b);
