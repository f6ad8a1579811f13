/* Where a detector found things in photographs (JSON Lines). formats/records/detections.md. */
#pragma once

#include "base/err.h"

#include <stdio.h>

struct detection {
	const char *view, *name; /* owned; name: the detector's word for it; NULL: none */
	double score;		 /* 0 to 1 */
	int height, width;	 /* of the photograph */
	double box[4];		 /* left, top, right, bottom in its pixels; not empty, and within it */
};

struct detections {
	size_t n;
	struct detection *items;
};

/* "-" is stdin. A file may have none. Returns 0, or -1 with *e ("path:LINE: reason") and nothing to free. */
int detections_read(struct detections *d, const char *path, struct err *e);
void detections_free(struct detections *d);

/* One line. Returns 0, or -1 with *e. */
int detections_put(FILE *out, const struct detection *d, struct err *e);
