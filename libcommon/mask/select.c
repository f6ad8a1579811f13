#include "mask/select.h"

/* Both sums over pixels v come from three areas, since a mask is constant on each of: k only, j only, both.
 */
static double agreement(const struct candidate *k, const struct candidate *j, enum select_method method)
{
	double g_k = method == SELECT_CIOU ? k->score : 1, g_j = method == SELECT_CIOU ? j->score : 1;
	size_t both = rle_intersection(k->mask, j->mask);
	double least = (g_k < g_j ? g_k : g_j) * (double)both;
	double most = g_k * (double)(k->area - both) + g_j * (double)(j->area - both);

	most += (g_k > g_j ? g_k : g_j) * (double)both;
	return most > 0 ? least / most : 1;
}

long select_winner(const struct candidate *candidates, size_t n, enum select_method method, double min_score,
	double *votes)
{
	size_t kept = 0;
	long best = -1;

	for (size_t k = 0; k < n; k++) {
		int is_kept = candidates[k].score > min_score;
		votes[k] = !is_kept ? 0 : method == SELECT_TOP1 ? candidates[k].score : 1;
		kept += (size_t)is_kept;
	}
	/* agreement is symmetric to the bit, so each pair is met once */
	for (size_t k = 0; k < n && method != SELECT_TOP1; k++) {
		if (!(candidates[k].score > min_score))
			continue;
		for (size_t j = k + 1; j < n; j++) {
			if (!(candidates[j].score > min_score))
				continue;
			double both = agreement(&candidates[k], &candidates[j], method);
			votes[k] += both;
			votes[j] += both;
		}
		votes[k] /= (double)kept;
	}
	for (size_t k = 0; k < n; k++) {
		if (!(candidates[k].score > min_score))
			continue;
		if (best < 0 || votes[k] > votes[best] ||
			(votes[k] == votes[best] && candidates[k].score > candidates[best].score))
			best = (long)k;
	}
	return best;
}
