/* Average linkage of what has neighbours: pieces of a photograph, Gaussians of a scene. Two clusters are as
 * far apart as the edges between them are on the mean (UPGMA over a sparse graph; Arbelaez et al. 2011,
 * section 4, join the pieces of a picture so). The pair with the least mean * (size of the smaller)^power is
 * joined next, so that with a power above 0 what is small is joined before what is large.
 *
 * Sums are whole numbers, so that the tree does not depend on the order of leaves and edges but where two
 * pairs are exactly as near. m edges take m log m steps. */
#pragma once

#include "base/err.h"

#include <stdint.h>

struct linkage_edge {
	int32_t a, b;	/* leaves, not the same; a pair may come more than once */
	int64_t length; /* >= 0 */
};

/* Nodes below `leaves` are leaves, the others what was joined, in that order: node leaves + k by merge k. */
struct linkage {
	int32_t leaves, nodes;
	int32_t (*children)[2]; /* (nodes - leaves) the lower one first */
	int32_t *parent;	/* (nodes) -1: none; more than one where edges do not connect all leaves */
	double *size;		/* (nodes) */
};

/* size (leaves), above 0. Returns 0, or -1 with *e set for want of memory; linkage_free after either. */
int linkage_make(struct linkage *l, int32_t leaves, const double *size, const struct linkage_edge *edges,
	size_t count, double power, struct err *e);
void linkage_free(struct linkage *l);

/* place (nodes): where each node's leaves begin, when leaves stand in the order of the tree: those of a node
 * side by side. */
int linkage_order(const struct linkage *l, int32_t *place, struct err *e);

/* Undoes the last merges until at least `clusters` are left, or as many as there are leaves. cluster (leaves)
 * gets each one's, numbered in the order of `place`, so that those of a finer cut rise within those of a
 * coarser one. Returns how many there are, or -1 with *e set. */
int32_t linkage_cut(
	const struct linkage *l, const int32_t *place, int32_t clusters, int32_t *cluster, struct err *e);
