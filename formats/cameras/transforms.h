/* nerfstudio's transforms.json (and its ancestors'): OpenGL axes. formats/cameras/transforms.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

#include <cjson/cJSON.h>

/* Adds the views of a parsed file; `path` is for messages. They are for views_finish to check, name and sort;
 * `image` is file_path, the split is the file's where it has one, and what distorts is their lens. Returns 0,
 * or -1 with *e; the cameras are still to be freed. */
int transforms_add(struct cameras *c, const cJSON *root, const char *path, struct err *e);
