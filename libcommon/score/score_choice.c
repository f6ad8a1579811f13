#include "score/score_choice.h"

#include "base/mem.h"
#include "mask/mask_index.h"

/* Judges a pair by the truths of its view, keys begin to end. */
static int judge(struct score_pair *p, const struct mask *truth, const struct mask_key *keys, size_t begin,
	size_t end, struct err *e)
{
	const char *own = mask_object(p->truth);
	SCOPED_BY(rle_fitted_free) struct rle_fitted f = {.own = &p->prediction->rle};

	p->is_right = p->intersection > 0;
	for (size_t i = begin; i < end && p->is_right; i++) {
		const struct mask *other = &truth[keys[i].at];
		if (!strcmp(mask_object(other), own))
			continue;
		if (rle_fit(&f, &other->rle, e))
			return -1;
		size_t both = rle_intersection(f.now, &other->rle);
		if (both)
			p->is_right = p->iou > (double)both / (double)(f.area + rle_area(&other->rle) - both);
	}
	return 0;
}

int score_choices(struct score_pairs *pairs, const struct mask *truth, size_t n, struct err *e)
{
	const ptrdiff_t count = (ptrdiff_t)pairs->n;
	SCOPED_BY(mask_index_free) struct mask_index views = {0};
	ptrdiff_t first_bad = count;

	if (mask_index_make(&views, truth, n, MASK_BY_REF, e))
		return -1;
#pragma omp parallel for schedule(dynamic, 64)
	for (ptrdiff_t i = 0; i < count; i++) {
		struct score_pair *p = &pairs->items[i];
		size_t begin, end;
		struct err own;
		p->is_right = 0;
		if (!p->prediction || p->is_empty)
			continue;
		mask_index_view(&views, p->truth->view, &begin, &end);
		if (!judge(p, truth, views.keys, begin, end, &own))
			continue;
#pragma omp critical(score_choices_failed)
		if (i < first_bad) {
			first_bad = i;
			*e = own;
		}
	}
	return first_bad < count ? -1 : 0;
}
