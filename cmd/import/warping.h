/* Between the photographs of lenses that distort and the views of a scene, which are pinholes: masks and
 * pictures, each pixel that of the other that shows the same, none where there is none. geom/lens.h. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "mask/rle.h"

#include <stdint.h>

enum warp { WARP_NONE, WARP_TO_VIEW, WARP_TO_PHOTOGRAPH };

struct warping {
	enum warp way;
	struct cameras cameras;
	const struct camera
		*of; /* the map is of this camera and masks of this size; NULL: there is none yet */
	int rows, columns;
	int32_t *map;
	uint8_t *from, *to;
	size_t map_room, from_room, to_room;
};

/* Reads a scene's cameras; nothing with WARP_NONE. 0, or -1 with *e; warping_free after either. */
int warping_open(struct warping *w, enum warp way, const char *scene, struct err *e);
void warping_free(struct warping *w);

/* A mask of a view, or of its photograph, in place of a mask of the other; as it is where the view has no
 * lens. Masks may be smaller or larger than what they are of. 0, or -1 with *e: ERR_FORMAT, without a file's
 * name, where the scene has no such view, or the mask has not the shape of what it should be of. */
int warping_mask(struct warping *w, const char *view, struct rle *mask, struct err *e);

/* The photograph of a view in a scene's folder, as the view sees it after so many quarter turns clockwise:
 * rgb (height,width,3); free() it. c->image is there. Returns 0, or -1 with *e set. */
int warping_read_photograph(const struct camera *c, const char *folder, int turns, uint8_t **rgb, int *height,
	int *width, struct err *e);
