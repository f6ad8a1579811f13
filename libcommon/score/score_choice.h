/* Which object a prediction shows: choosing wrong is another fault than drawing badly. */
#pragma once

#include "score/score.h"

/* Fills is_right of measured pairs: whether the prediction's IoU with its own truth is above 0 and above that
 * with the truth of every other object in the view. An object goes by its name, else by its ref. `truth` (n)
 * is what was matched. */
int score_choices(struct score_pairs *pairs, const struct mask *truth, size_t n, struct err *e);
