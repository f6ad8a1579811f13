/* nerfstudio's transforms.json (and its ancestors'): OpenGL axes. formats/cameras/transforms.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

#include <cjson/cJSON.h>

/* From a parsed file; `path` is for messages. Views are checked, named and sorted by views_finish; `image` is
 * file_path, the split is the file's where it has one. Lens distortion is refused unless it is 0. Returns 0,
 * or -1 with *e and *c zeroed. */
int transforms_parse(struct cameras *c, const cJSON *root, const char *path, struct err *e);
