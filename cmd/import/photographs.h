/* The photographs of cameras, as a foreign file calls them, in a folder. formats/cameras/camerafile.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

/* Turns each view's `image` from the foreign file's into a path relative to the folder `scene` (which must
 * exist), of the photograph in the folder `images`: under the foreign path or, failing that, under its file
 * name, with .jpg .jpeg .png tried where it has no extension. NULL where there is none, or `images` is NULL.
 * *missing is how many were not found. 0, or -1 with *e: two views of one photograph, say. */
int photographs_find(
	struct cameras *c, const char *images, const char *scene, size_t *missing, struct err *e);
