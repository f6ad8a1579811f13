/* Boxes of everyday things in photographs, by a small network: box-detect. */
#pragma once

#include "base/err.h"
#include "base/report.h"

struct detecting {
	const char *model; /* folder of the weights */
	const char *scene; /* whose views' photographs are looked at; NULL: `pictures` are */
	const char *const *pictures;
	size_t count;
	double score; /* boxes have at least this */
	int crops;    /* at each photograph as a whole, and at six parts of it */
	const char *output;
};

/* Writes a record for each box (formats/records/detections.md), pictures in their order, the surest first.
 * Returns 0, or -1 with *e set. */
int detect(const struct detecting *d, const struct report *to, struct err *e);
