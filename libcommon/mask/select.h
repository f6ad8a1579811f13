/* Pseudo masks: the one candidate mask that stands for an object in a view (ReferSplat, section 3.4:
 * confidence-weighted IoU). All sentences of the object are pooled: what most of them point at wins over one
 * confident mistake. */
#pragma once

#include "mask/mask.h"

#include <stddef.h>

/* g_k is mask_confidence. */
enum select_method {
	SELECT_CIOU, /* p_k = mean_j sum_v min(g_k M_k, g_j M_j) / sum_v max(g_k M_k, g_j M_j) */
	SELECT_IOU,  /* p_k = mean_j |M_k and M_j| / |M_k or M_j| */
	SELECT_TOP1, /* p_k = g_k */
};

/* The n candidates of one object in one view, all of one size, and their areas (rle_area). Only those with
 * g_k > min_score >= 0 take part, as candidates and as voters j; j = k is among them. Two empty masks agree:
 * 1. votes (n) gets p_k, and 0 for the rest. Returns the index with the largest vote (then the higher score,
 * then the earlier), or -1 where none takes part. */
long select_winner(const struct mask *const *candidates, const size_t *areas, size_t n,
	enum select_method method, double min_score, double *votes);
