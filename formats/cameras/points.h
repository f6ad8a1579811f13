/* The points that a reconstruction has beside its cameras, in their frame: COLMAP's points3D.bin, .txt or
 * .ply, nerfstudio's sparse_pc.ply, 3DGS's input.ply. Only where they lie is read.
 * formats/cameras/camerafile.md. */
#ifndef FORMATS_POINTS_H
#define FORMATS_POINTS_H

#include "base/err.h"

#include <stddef.h>

/* Those beside a camera file, or in a model's folder, less an offset: *points (n,3); free() it. *n is 0 where
 * there are none, or none that can be read. Returns 0, or -1 with *e set where memory is out. */
int points_read(float **points, size_t *n, const char *cameras, const double offset[3], struct err *e);

#endif
