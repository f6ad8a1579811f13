/* A trained scene's cameras, in whichever foreign format they are. formats/cameras/camerafile.md. */
#ifndef FORMATS_CAMERAFILE_H
#define FORMATS_CAMERAFILE_H

#include "base/err.h"
#include "geom/camera.h"

/* The camera file in a folder: the folder itself where it is a COLMAP model, else the first there is of
 * cameras.json, sparse/0, sparse, transforms.json. free() it. NULL with *e set (ERR_FORMAT) where there is
 * none. */
char *camerafile_find(const char *dir, struct err *e);

/* Reads a COLMAP folder, or a JSON file ("-" is stdin): a list is a 3DGS cameras.json, an object a
 * transforms.json. There is at least one view. Cameras that distort have their lens, and the photograph's
 * size and intrinsics. Returns 0, or -1 with *e and *c zeroed. */
int camerafile_read(struct cameras *c, const char *path, struct err *e);

/* Refuses cameras that distort (ERR_FORMAT), and says the ways out; images is the folder of their
 * photographs, or NULL. Returns 0, or -1 with *e. */
int camerafile_need_pinholes(const struct cameras *c, const char *path, const char *images, struct err *e);

/* Turns each view's `image` from the foreign file's into a path relative to the folder `scene` (which must
 * exist), of the photograph in the folder `images`: under the foreign path or, failing that, under its file
 * name, with .jpg .jpeg .png tried where it has no extension. NULL where there is none, or `images` is NULL.
 * *missing is how many were not found. */
int camerafile_images(
	struct cameras *c, const char *images, const char *scene, size_t *missing, struct err *e);

#endif
