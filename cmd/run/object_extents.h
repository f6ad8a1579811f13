/* Where each lifted object of a scene is. */
#ifndef CMD_RUN_OBJECT_EXTENTS_H
#define CMD_RUN_OBJECT_EXTENTS_H

#include "base/err.h"
#include "formats/records/boxes.h"
#include "geom/camera.h"
#include "lift/extent.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

/* (objects), in the frame of the splats. Release with object_extents_free. NULL with *e set. */
struct extent *object_extents(
	const struct lifted *l, const struct splats *s, const struct cameras *c, struct err *e);
/* Its boxes in the world, means + offset, with the score `sure`; without names. */
struct box_record object_extents_record(const struct extent *x, const double offset[3], double sure);
void object_extents_free(struct extent *extents, size_t objects);

#endif
