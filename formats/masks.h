/* Mask records (JSON Lines): candidates, pseudo masks, predictions and truth alike. formats/masks.md. */
#ifndef FORMATS_MASKS_H
#define FORMATS_MASKS_H

#include "base/err.h"
#include "formats/jsonl.h"
#include "geom/camera.h"
#include "mask/pool.h"

#include <stdio.h>

struct mask_record {
	char *view;   /* never NULL in a record that was read */
	char *ref;    /* NULL where the mask is of an object rather than a sentence */
	char *object; /* may be NULL where ref is given */
	double score; /* NaN where absent */
	struct rle mask;
	double visible; /* of the outline of a whole object, the share in [0,1] that is in sight; NaN where
			   absent */
};

struct mask_set {
	size_t n, capacity;
	struct mask_record *records;
};

/* The next record of a stream: 1, 0 at the end, -1 with *e ("path:LINE: key '...': ..."). A "path" member
 * names a PNG relative to the JSONL file's folder (nonzero is foreground). */
int masks_next(struct jsonl *j, struct mask_record *r, struct err *e);
void mask_record_free(struct mask_record *r);

/* All records of a file; "-" is stdin. */
int masks_read(struct mask_set *set, const char *path, struct err *e);
/* As masks_read; *lines (n) gets the line of each record. free() it. */
int masks_read_lines(struct mask_set *set, long **lines, const char *path, struct err *e);
void masks_free(struct mask_set *set);

/* The records of a file pooled, without a score as if it were 1. ERR_FORMAT where masks of a view differ in
 * size. */
int masks_pool(
	struct pool *p, const struct mask_set *set, const long *lines, const char *path, struct err *e);
/* views (n): the number of each record's view. ERR_FORMAT where there is none of the name. */
int masks_views(const struct mask_set *set, const long *lines, const char *path,
	const struct cameras *cameras, size_t *views, struct err *e);

/* One line. Keys in the order view, ref, object, score, visible, segmentation; absent ones left out. */
int masks_put(FILE *out, const struct mask_record *r, struct err *e);

#endif
