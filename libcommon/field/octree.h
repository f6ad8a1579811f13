/* An octree over the scene whose leaves share a referring feature: Gaussians that no view can tell apart need
 * only one. A leaf is named by its location code: a leading 1, then three bits a level from the root down
 * (bit 0: the upper half in x, bit 1: in y, bit 2: in z). */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum {
	OCTREE_LEVELS = 20,    /* most levels below the root */
	OCTREE_SIGNATURE = 16, /* channels of a point's signature */
};

struct octree {
	double low[3], edge; /* the root cube */
	size_t n;	     /* leaves */
	int64_t *codes;	     /* (n) location codes, in the order of space (Morton) */
};

/* The points: n of a scene's Gaussians, and what decides where a point's cube is cut further. All arrays but
 * ids have a row for each Gaussian of the scene, whether it is a point or not. */
struct octree_points {
	size_t n;
	const float *means;	/* (scene_gaussians,3) */
	const int32_t *ids;	/* (n) the Gaussians that are points */
	const float *finest;	/* (scene_gaussians) cubes no longer than this are not cut */
	const double *weight;	/* (scene_gaussians) how much a point counts */
	const float *signature; /* (scene_gaussians,OCTREE_SIGNATURE) */
};

/* The leaves of least cost: the error of a leaf is the sum of weight |signature - mean|^2 over its points,
 * and every leaf costs `price` besides. A cube no longer than the least `finest` of its points is not cut. */
int octree_build(struct octree *t, const struct octree_points *p, double price, struct err *e);
void octree_free(struct octree *t);

/* 0, or -1 where the codes are not leaves in the order of space, none inside another; *bad gets the first. */
int octree_check(const struct octree *t, size_t *bad);

/* leaf (count): the leaf of each of the points means (count,3), or -1. */
int octree_find(const struct octree *t, const float *means, size_t count, int32_t *leaf, struct err *e);
