/* Regions of a scene without masks of anything, from its photographs and perhaps a detector's boxes:
 * pseudomask-propose. formats/records/detections.md, formats/scene/proposed.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/masks/region_picture.h"
#include "formats/records/detections.h"
#include "formats/scene/scene.h"
#include "propose/affinity.h"
#include "propose/pieces.h"
#include "propose/region_scores.h"
#include "propose/region_tree.h"

#include <stdint.h>

struct proposing_options {
	const char *scene, *weights;
	const char *boxes;   /* a detector's, "-" is stdin; NULL: none */
	const char *output;  /* of the masks, "-" is stdout */
	const char *regions; /* file for the tree; NULL: none */
	int split;	     /* the views that get masks: PROPOSING_... */
	int is_disjoint;
	long long most; /* regions; 0: PROPOSING_NESTED, or PROPOSING_DISJOINT */
};

enum { PROPOSING_TRAIN, PROPOSING_TEST, PROPOSING_ALL };
enum { PROPOSING_NESTED = 110, PROPOSING_DISJOINT = 40 };

/* A view, at the size of its weights. */
struct proposing_view {
	int is_used;
	struct region_picture shown;
	struct pieces pieces;
	size_t box_count;
	struct affinity_box *boxes;
};

struct proposing {
	const struct proposing_options *options;
	struct scene scene;
	size_t box_count; /* in all views */
	size_t class_count;
	char **classes;		      /* (class_count) what the boxes are of */
	struct proposing_view *views; /* (scene.cameras.n) */
	double *weight;		      /* (N) of each Gaussian in all views */
	size_t kept;		      /* Gaussians that have neighbours */
	struct affinity affinity;
	struct region_tree tree;
	struct region_scores scores;
	double *score; /* (nodes) */
	int32_t count, *chosen;
};

/* Finds the regions and writes them; *p is zeroed before. 0, or -1 with *e; proposing_free after either. */
int proposing_write(
	struct proposing *p, const struct proposing_options *options, const struct report *to, struct err *e);
void proposing_free(struct proposing *p);
