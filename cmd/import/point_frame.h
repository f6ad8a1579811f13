/* Whether splats lie where the points of their cameras' reconstruction do: gs-import. */
#ifndef CMD_IMPORT_POINT_FRAME_H
#define CMD_IMPORT_POINT_FRAME_H

#include "base/err.h"
#include "formats/scene/scene.h"

/* Splats were trained from these points, so that each has the other near in the frame of both, if only those
 * that were not cut away: the larger share of either that has one of the other within a twentieth of the
 * points' extent. On a real desk 0.98, and 0.92 of the inner eighth of its splats; turned by 20 degrees 0.28,
 * at half or twice the size less than 0.1. */
#define POINT_FRAME_LEAST 0.4

/* The points beside the camera file; *share is 1 where these, or splats, are too few to tell. Returns 0, or
 * -1 with *e set. */
int point_frame_find(double *share, const struct scene *s, const char *cameras, struct err *e);

#endif
