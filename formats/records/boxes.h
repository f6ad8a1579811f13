/* Where objects are in space (JSON Lines). formats/records/boxes.md. */
#pragma once

#include "base/err.h"
#include "geom/box.h"
#include "mask/mask.h"

#include <stdint.h>
#include <stdio.h>

struct box_record {
	char *ref, *object; /* either may be NULL, not both */
	double score;	    /* NAN: none */
	char time[32];	    /* of a track, when it is there, as text; "": none */
	int is_empty;	    /* there is nothing, and no box */
	struct box aligned; /* along the world's axes */
	struct box turned;
	int label; /* above 0: of the Gaussians of a labelled scene, with its colour; 0: none */
	uint8_t colour[3];
	size_t part_count; /* of several things that are meant: each by itself, for writing */
	const struct box_record *parts;
};

struct box_set {
	size_t n;
	struct box_record *records;
};

/* "-" is stdin. Two records of one ref (or, without ref, of one object) and of one time are an error. */
int boxes_read(struct box_set *s, const char *path, struct err *e);
void boxes_free(struct box_set *s);

/* Their refs and objects as those of masks without pixels in one view, "" (a track's: its time), so that
 * mask/mask_index.h finds boxes too. NULL with *e set; free() it before the boxes. */
struct mask *boxes_names(const struct box_set *s, struct err *e);

/* The Gaussians that a box is of: ids (n). */
struct box_gaussians {
	size_t n;
	const int32_t *ids;
};

/* One line. `of` may be NULL: the record then says nothing of Gaussians. Its parts have an object, a score
 * and boxes. */
void boxes_put(FILE *out, const struct box_record *r, const struct box_gaussians *of);
