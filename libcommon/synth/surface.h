/* Surfaces to scatter Gaussians on: cones and discs about a vertical axis, rectangles, half a ring.
 *
 * A point of a surface is named by (a,b) in [0,1)^2: a runs over the patches in proportion to their area and,
 * inside one, across it; b runs around it. The map preserves area, so that an even spread of (a,b) is an even
 * spread on the surface. */
#pragma once

enum synth_patch_kind { SYNTH_FRUSTUM, SYNTH_RECTANGLE, SYNTH_HALF_RING };

/* What a patch is made of, as the object's colour is seen there. */
enum synth_tint { SYNTH_OWN, SYNTH_INNER, SYNTH_PAGES, SYNTH_CAP };

struct synth_patch {
	enum synth_patch_kind kind;
	enum synth_tint tint;
	double area;
	double centre[3];      /* of the axis at height 0; a corner; the ring's centre */
	double r0, z0, r1, z1; /* FRUSTUM: rims. Going from 0 to 1 the outside is on the right. HALF_RING: r0
				  ring, r1 tube */
	double u[3], v[3];     /* RECTANGLE: edges; u x v points outwards */
	/* FRUSTUM: whether the rims are sharp, and the radius of the curve that the profile stands for where
	 * they are not (INFINITY: a straight line). */
	int is_sharp[2];
	double bend;
};

enum { SYNTH_PATCHES = 32 };

struct synth_surface {
	int n;
	double area;
	struct synth_patch patches[SYNTH_PATCHES];
};

/* A chain of frustums through n (radius, height) points about the vertical through `centre`. */
void synth_surface_turn(struct synth_surface *s, enum synth_tint tint, const double centre[3], int n,
	const double (*profile)[2]);
/* A box without its underside; `sides` is the tint of the faces whose outside is not up. */
void synth_surface_box(struct synth_surface *s, enum synth_tint top, enum synth_tint sides,
	const double centre[3], double width, double depth, double height);
/* The half with x > centre[0] of a ring that stands in the plane y = centre[1]. */
void synth_surface_half_ring(struct synth_surface *s, const double centre[3], double ring, double tube);

/* A place on a surface, for something flat to be laid there. */
struct synth_spot {
	enum synth_tint tint;
	double point[3], normal[3];
	double along[3]; /* a unit tangent: a rectangle's first edge, otherwise straight up or down the slope;
			    across it is normal x along */
	double room[2];	 /* along and across: how far it is, one way and the other, to a sharp edge */
	double bend[2];	 /* the same: radius of curvature */
};

/* The spot at (a,b), moved away from sharp edges until they are `margin` away, or it is in the middle. */
void synth_surface_spot(
	const struct synth_surface *s, double a, double b, double margin, struct synth_spot *spot);

/* How far the surface reaches in direction d: the greatest d . p of its points. */
double synth_surface_reach(const struct synth_surface *s, const double d[3]);
