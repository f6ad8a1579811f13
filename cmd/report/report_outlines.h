/* Outlines of masks as paths of SVG, each text once. */
#ifndef CMD_REPORT_REPORT_OUTLINES_H
#define CMD_REPORT_REPORT_OUTLINES_H

#include "base/err.h"
#include "mask/rle.h"

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

struct report_outlines {
	size_t n, capacity;
	struct report_outline {
		char *path; /* "M3 4h2v1h-2z", in pixels; "" for an empty mask */
		uint64_t hash;
	} * items;
};

/* *index gets the place of the outline of a mask, brought to the size of a picture. Returns 0, or -1 with *e
 * set. */
int report_outline(struct report_outlines *o, const struct rle *mask, int height, int width, size_t *index,
	struct err *e);

/* All as a list of strings; NULL where memory is out. */
cJSON *report_outlines_list(const struct report_outlines *o);
void report_outlines_free(struct report_outlines *o);

#endif
