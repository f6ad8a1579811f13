/* Regions without names: which of them is each thing, at best. */
#pragma once

#include "mask/mask.h"

/* named: for each thing of the truth the masks, in all views of the truth, of the one object of the
 * predictions that has the largest mean IoU with it there, under the thing's name; none where all are 0. Of
 * things and objects without an object the ref counts. *named is zeroed before; masks_free after success.
 * Returns 0, or -1 with *e set. */
int score_best(struct masks *named, const struct mask *truth, size_t truth_n, const struct mask *predictions,
	size_t prediction_n, struct err *e);
