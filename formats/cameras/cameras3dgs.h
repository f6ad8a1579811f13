/* The cameras.json that 3D Gaussian Splatting writes beside a trained scene. formats/cameras/cameras3dgs.md.
 */
#ifndef FORMATS_CAMERAS3DGS_H
#define FORMATS_CAMERAS3DGS_H

#include "base/err.h"
#include "geom/camera.h"

#include <cjson/cJSON.h>

/* From a parsed file; `path` is for messages. Views are checked, named and sorted by views_finish; `image` is
 * img_name, the principal point is the centre, all are SPLIT_TRAIN. Returns 0, or -1 with *e and *c zeroed.
 */
int cameras3dgs_parse(struct cameras *c, const cJSON *list, const char *path, struct err *e);

#endif
