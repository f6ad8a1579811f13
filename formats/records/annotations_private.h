/* What the parts of formats/records/annotations.h share: annotations_draw.c makes masks of shapes,
 * annotations_coco.c reads COCO's and Grounded-SAM-2's files, annotations.c the rest.
 * formats/records/annotations.md. */
#pragma once

#include "formats/records/annotations.h"
#include "formats/records/json.h"

#include <stdint.h>

enum { WHERE = 512 };

/* A file that is read; the last picture's size and memory to draw in. */
struct reading {
	struct annotations *to;
	const char *path;
	char where[WHERE]; /* "path: shape 3", for messages */
	int height, width;
	double score; /* of the detector's annotation that is read, or NAN */
	double group; /* of the shape or annotation that is read, or NAN */
	uint8_t *flips, *mask;
	double *points;
	size_t flips_room, mask_room, points_room;
};

/* The size of a picture from members of an object. */
int reading_size(
	struct reading *r, const cJSON *object, const char *height, const char *width, struct err *e);

/* The annotation of a view and name: an earlier one, or a new one of the reading's size; a new one for each
 * thing that a detector found. NULL with *e, as where the earlier one is of another group. */
struct annotation *reading_find(struct reading *r, const char *view, const char *name, struct err *e);

/* Notes by which number a shape or annotation is told from others of its label: LabelMe's "group_id", CVAT's
 * "track_id" and the like. */
void reading_group(struct reading *r, const cJSON *item);

/* A list of numbers, or of pairs of numbers, into r->points: *count points. */
int reading_points(struct reading *r, const cJSON *list, size_t *count, struct err *e);

/* Draws a shape of LabelMe's or X-AnyLabeling's types from r->points, or leaves it out. */
int reading_draw_shape(
	struct reading *r, const char *type, size_t count, const char *view, const char *name, struct err *e);

/* Draws a polygon of r->points; one without an area is left out. */
int reading_draw(struct reading *r, struct annotation *on, size_t count, struct err *e);

/* Adds a mask of the picture's size to the annotation's; one without a pixel is left out. */
int reading_unite(struct reading *r, struct annotation *on, const struct rle *mask, struct err *e);

/* One more of a kind that is left out: "shapes of type 'line'". */
int reading_leave_out(struct reading *r, const char *kind, struct err *e);

/* Notes the one picture of a file, whose path is as seen from the folder of `json`: its view, which stays the
 * reading's; NULL with *e. */
const char *reading_picture(struct reading *r, const char *json, const char *image, struct err *e);

/* COCO's annotations, or Grounded-SAM-2's. */
int reading_annotations(struct reading *r, const cJSON *root, struct err *e);
