/* A thing that a person points at in views, as masks in all of them: mask-pick. formats/scene/proposed.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/masks/region_picture.h"
#include "formats/scene/proposed.h"
#include "formats/scene/scene.h"
#include "mask/rle.h"
#include "propose/region_pick.h"
#include "splat/weights_pack.h"

struct pointing_options {
	const char *scene, *tree;
	const char *weights;	      /* of views, which are rendered where NULL or not there */
	const char *points, *outside; /* "VIEW:x,y" with blanks between, in pixels of the view; NULL: none */
	const char *box;	      /* "VIEW:left,top,right,bottom"; NULL: none */
	const char *name;	      /* of the thing */
	const char *output;
	long long larger, smaller; /* steps */
};

struct pointing {
	const char *weights; /* the folder; NULL: none */
	struct scene scene;
	struct regions_file regions;
	struct weights_room room;
	struct region_picture *views; /* (scene.cameras.n) */
	size_t click_count, click_room;
	struct region_click *clicks;
	float *area;	/* (nodes) in the view of the first click */
	uint8_t *is_in; /* (nodes) of what is meant */
};

/* Reads the scene, its regions, and nothing yet of its weights, a folder of views or NULL: views without are
 * rendered. *p is zeroed before. Returns 0, or -1 with *e set; pointing_free after either. */
int pointing_open(
	struct pointing *p, const char *scene, const char *regions, const char *weights, struct err *e);
void pointing_free(struct pointing *p);

/* Finds the regions of a view, once; what needs them does so itself. Returns 0, or -1 with *e set. */
int pointing_look(struct pointing *p, size_t view, struct err *e);

/* A click at a place within a view, in shares of its width and height; p->click_count = 0 forgets all. */
int pointing_click(struct pointing *p, size_t view, const double at[2], int is_outside, struct err *e);

/* p->is_in gets what the clicks mean, so many steps up, or, below 0, down. Returns 0, or -1 with *e set:
 * ERR_CHECK where nothing is there. */
int pointing_choose(struct pointing *p, int larger, struct err *e);

/* The same of a box: left, top, right, bottom in shares of the view. */
int pointing_choose_boxed(struct pointing *p, size_t view, const double box[4], struct err *e);

/* The mask of what is meant in a view, at the size of its weights; its area in *area, 0 where it is not seen.
 * Returns 0, or -1 with *e set; rle_free after either. */
int pointing_mask(struct pointing *p, size_t view, struct rle *mask, size_t *area, struct err *e);

/* Finds what the options point at and writes its mask in each view that shows it; as pointing_open. ERR_USAGE
 * where a place is at fault. */
int pointing_write(
	struct pointing *p, const struct pointing_options *options, const struct report *to, struct err *e);
