#include "mask/select.h"

/* Both sums over pixels v come from three areas, a mask being constant on each: k only, j only, both. */
static double agreement(const struct mask *k, size_t k_area, const struct mask *j, size_t j_area, int is_ciou)
{
	double g_k = is_ciou ? mask_confidence(k) : 1, g_j = is_ciou ? mask_confidence(j) : 1;
	size_t both = rle_intersection(&k->rle, &j->rle);
	double least = (g_k < g_j ? g_k : g_j) * (double)both;
	double most = g_k * (double)(k_area - both) + g_j * (double)(j_area - both);

	most += (g_k > g_j ? g_k : g_j) * (double)both;
	return most > 0 ? least / most : 1;
}

long select_winner(const struct mask *const *candidates, const size_t *areas, size_t n,
	enum select_method method, double min_score, double *votes)
{
	size_t kept = 0;
	long best = -1;

	for (size_t k = 0; k < n; k++) {
		const double score = mask_confidence(candidates[k]);
		int is_kept = score > min_score;
		votes[k] = !is_kept ? 0 : method == SELECT_TOP1 ? score : 1;
		kept += (size_t)is_kept;
	}
	/* agreement is symmetric to the bit, so each pair is met once */
	for (size_t k = 0; k < n && method != SELECT_TOP1; k++) {
		if (!(mask_confidence(candidates[k]) > min_score))
			continue;
		for (size_t j = k + 1; j < n; j++) {
			if (!(mask_confidence(candidates[j]) > min_score))
				continue;
			double both = agreement(
				candidates[k], areas[k], candidates[j], areas[j], method == SELECT_CIOU);
			votes[k] += both;
			votes[j] += both;
		}
		votes[k] /= (double)kept;
	}
	for (size_t k = 0; k < n; k++) {
		const double score = mask_confidence(candidates[k]);
		if (!(score > min_score))
			continue;
		const double surest = best < 0 ? 0 : mask_confidence(candidates[best]);
		if (best < 0 || votes[k] > votes[best] ||
			(votes[k] == votes[best] &&
				(score > surest || (score == surest &&
							   mask_order(candidates[k], candidates[best]) < 0))))
			best = (long)k;
	}
	return best;
}
