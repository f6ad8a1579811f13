/* Two prediction files against one truth: pairs of the one beside pairs of the other. */
#pragma once

#include "score/score.h"

/* Brings the pairs of two predictions with the same truth (score_match of the same array) side by side: after
 * it both lists have the same n, and the items of an index are of the same truth and sentence. The sentences
 * of a truth are those whose refs the predictions of either side have; a side without a prediction for one
 * has its mask without ref there, else none (IoU 0). Masks without ref are a pair of their own where both
 * sides have one, or where neither has a ref. The order is that of a; what only b names comes last. Where
 * both sides have the same refs nothing else changes.
 *
 * To be called before score_measure and score_sort; object and place become the same on both sides. On
 * failure both lists are as they were. */
int score_join(struct score_pairs *a, struct score_pairs *b, struct err *e);
