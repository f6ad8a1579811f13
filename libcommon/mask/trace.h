/* The border of a mask as closed lines along the edges of its pixels. */
#pragma once

#include "base/err.h"

#include <stdint.h>

/* A corner, in pixels from the upper left; column x begins at x. */
struct trace_corner {
	int x, y;
	int is_first; /* of its line; the one before is the last of the line before */
};

struct trace {
	size_t n, capacity;
	struct trace_corner *corners;
};

/* Lines of mask (height,width) of 0 and 1: every second side is level, the others upright. The inside is on
 * the right hand, so that lines around holes run the other way. Pixels that touch at a corner only are of two
 * lines. Returns 0, or -1 with *e set; trace_free after either. */
int trace_mask(struct trace *t, const uint8_t *mask, int height, int width, struct err *e);
void trace_free(struct trace *t);
