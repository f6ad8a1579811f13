/* Annotations of other programs as masks: JSON of LabelMe, COCO, ISAT, Ref-LERF and Grounded-SAM-2.
 * formats/records/annotations.md. */
#pragma once

#include "base/err.h"
#include "mask/mask_place.h"
#include "mask/rle.h"

/* What a picture has of one label, or one of the things that a detector has found in it. */
struct annotation {
	char *view, *name;
	char *ref;		  /* the sentence that the detector was given, or NULL */
	double score;		  /* of a detector, or NAN */
	struct rle mask;	  /* all shapes of the label */
	struct mask_place *boxes; /* of ISAT and LERF-OVS, a box for each shape that has one; else NULL */
	size_t shapes;
	double group;	/* by which the file tells things of one label apart, or NAN */
	int is_outline; /* a polygon is among them, so that what lies on it may be in it */
};

/* Shapes that are left out, by what they are: "shapes of type 'line'". */
struct annotations_left {
	char *kind;
	size_t n;
};

struct annotations {
	char *view, *picture; /* LabelMe's, ISAT's and Grounded-SAM-2's: the one picture's view, and its path
				 as the tool would find it, without ".."; else NULL */
	size_t n, capacity;
	struct annotation *items; /* in the order of the file */
	int is_layered;		  /* LabelMe's and COCO's: outlines may go on beneath what lies on them */
	size_t left_count, left_capacity;
	struct annotations_left *left_out; /* what has no area or is of no known type */
};

/* Reads any of them ("-" is stdin). Returns 0, or -1 with *e ("path: shape 3: ..."); free after either. */
int annotations_read(struct annotations *a, const char *path, struct err *e);
void annotations_free(struct annotations *a);
