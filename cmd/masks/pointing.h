/* A thing that a person points at in views, as masks in all of them: mask-pick. formats/scene/proposed.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/scene/proposed.h"
#include "formats/scene/scene.h"
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

/* The nodes of a view's pixels. */
struct pointing_view {
	int height, width;
	int32_t *nodes; /* (height,width); NULL: not yet looked at */
};

struct pointing {
	const struct pointing_options *options;
	struct scene scene;
	struct regions_file regions;
	struct weights_room room;
	struct pointing_view *views; /* (scene.cameras.n) */
	size_t click_count, click_room;
	struct region_click *clicks;
	uint8_t *is_in; /* (nodes) of what is meant */
	size_t masks;	/* that were written */
};

/* Finds what is pointed at and writes its mask in each view that shows it; *p is zeroed before. Returns 0, or
 * -1 with *e set: ERR_USAGE where a place is at fault, ERR_CHECK where nothing is there. pointing_free after
 * either. */
int pointing_write(
	struct pointing *p, const struct pointing_options *options, const struct report *to, struct err *e);
void pointing_free(struct pointing *p);
