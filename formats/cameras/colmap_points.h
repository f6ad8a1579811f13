/* The points of a COLMAP model. formats/cameras/colmap.md. */
#ifndef FORMATS_COLMAP_POINTS_H
#define FORMATS_COLMAP_POINTS_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

struct colmap_points {
	size_t n;
	double *places;	 /* (n,3) world units */
	uint8_t *colors; /* (n,3) */
};

/* points3D.bin of the folder, or points3D.txt; none where there is neither. Returns 0, or -1 with *e set and
 * *p zeroed. */
int colmap_points_read(struct colmap_points *p, const char *dir, struct err *e);
void colmap_points_free(struct colmap_points *p);

#endif
