/* A trained scene's cameras, in whichever foreign format they are. formats/cameras/camerafile.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

/* Reads a COLMAP folder, or a JSON file ("-" is stdin): a list is a 3DGS cameras.json, an object a
 * transforms.json. There is at least one view. Cameras that distort have their lens, and the photograph's
 * size and intrinsics. Returns 0, or -1 with *e and *c zeroed. */
int camerafile_read(struct cameras *c, const char *path, struct err *e);

/* Refuses cameras that distort (ERR_FORMAT), and says the ways out; images is the folder of their
 * photographs, or NULL. Returns 0, or -1 with *e. */
int camerafile_need_pinholes(const struct cameras *c, const char *path, const char *images, struct err *e);
