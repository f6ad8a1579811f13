/* Files of masks as scoring takes them: names of one record at most, so that it is clear what belongs to
 * what. formats/records/masks.md. */
#pragma once

#include "formats/records/masks.h"

struct score_masks {
	const char *path; /* the caller's */
	struct masks set;
	long *lines; /* of each mask of the set as it was read */
	size_t n;    /* how many masks of the set, from the first on, count */
};

/* As masks_read; two records of the same view and ref (or, without ref, of the same view and object) are an
 * error: "FILE:LINE: view 'V', ref 'R' is on line N already". */
int score_masks_read(struct score_masks *s, const char *path, struct err *e);

/* Harmless on a zeroed struct. */
void score_masks_free(struct score_masks *s);
