/* Mask records (JSON Lines): candidates, pseudo masks, predictions, truth. formats/records/masks.md. */
#pragma once

#include "base/err.h"
#include "base/names.h"
#include "base/report.h"
#include "formats/records/jsonl.h"
#include "geom/camera.h"
#include "mask/mask.h"
#include "mask/pool.h"

#include <stdio.h>

/* The next record of a stream, mask_free it: 1, 0 at the end, -1 with *e ("path:LINE: key '...': ..."). A
 * "path" member names a PNG relative to the JSONL file's folder (nonzero is foreground). */
int masks_next(struct jsonl *j, struct mask *m, struct err *e);

/* All records of a file; "-" is stdin. masks_free them. */
int masks_read(struct masks *set, const char *path, struct err *e);
/* As masks_read; *lines (n) gets the line of each record. free() it. */
int masks_read_lines(struct masks *set, long **lines, const char *path, struct err *e);

/* COCO's run lengths of a mask of that size, a string or a list: the key 'segmentation.counts' of an object,
 * which messages call `where`. Returns 0, or -1 with *e set. */
int masks_take_counts(
	struct rle *mask, const cJSON *counts, int height, int width, const char *where, struct err *e);

/* The records of a file pooled. ERR_FORMAT where masks of a view differ in size. */
int masks_pool(struct pool *p, const struct masks *set, const long *lines, const char *path, struct err *e);
/* 0 where a mask, of a line of a file, has the shape of what it is of: mask_check_shape. */
int masks_check_shape(const struct mask *m, const char *of, int height, int width, const char *path,
	long line, struct err *e);

/* 0 where none of the records of a file is of a sentence (its ref) and says another object than that
 * (objects; "" says nothing), and no object is spelt in two ways (names_check_spelling), else ERR_FORMAT:
 * which of them is wrong no tool can know. */
int masks_check_refs(const struct masks *set, const char *path, char *const *refs, char *const *objects,
	size_t sentences, struct err *e);

/* views (n): the number of each record's view, which the record then names as the scene does
 * (view_part). Masks of views that the scene lacks are left out, with a warning; ERR_FORMAT where that
 * leaves none, or a mask has not the shape of its view. With NULL (and no report) nothing is left out, and
 * masks of photographs that a lens distorts are not compared. */
int masks_views(struct masks *set, long *lines, const char *path, const struct cameras *cameras,
	size_t *views, const struct report *to, struct err *e);

/* One line. Keys in the order view, ref, object, score, visible, peak, boxes, segmentation, as there are. */
int masks_put(FILE *out, const struct mask *m, struct err *e);
/* The same with a key "parts": objects of the parts' object, score, visible and segmentation. */
int masks_put_parts(FILE *out, const struct mask *m, const struct mask *parts, size_t n, struct err *e);
