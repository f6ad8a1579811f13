#include "score/score_choice.h"

#include "score/score_lookup.h"

#include <stddef.h>
#include <string.h>

/* A prediction at the size of the truths that it is held against, which most often have one size. */
struct fitted {
	const struct rle *own, *now;
	struct rle resized;
	size_t area; /* of now */
};

static int fit(struct fitted *f, const struct rle *to, struct err *e)
{
	if (f->now && f->now->height == to->height && f->now->width == to->width)
		return 0;
	rle_free(&f->resized);
	f->now = f->own;
	if (f->own->height != to->height || f->own->width != to->width) {
		f->now = NULL;
		if (rle_resize(&f->resized, f->own, to->height, to->width, e))
			return -1;
		f->now = &f->resized;
	}
	f->area = rle_area(f->now);
	return 0;
}

static const char *name_of(const struct score_mask *m)
{
	return m->object ? m->object : m->ref;
}

/* Judges a pair by the truths of its view, items begin to end. */
static int judge(struct score_pair *p, const struct score_mask *truth, const struct score_name *items,
	size_t begin, size_t end, struct err *e)
{
	const char *own = name_of(&truth[p->truth_index]);
	struct fitted f = {.own = p->prediction};

	p->is_right = p->intersection > 0;
	for (size_t i = begin; i < end && p->is_right; i++) {
		const struct score_mask *other = &truth[items[i].index];
		if (!strcmp(name_of(other), own))
			continue;
		if (fit(&f, other->mask, e)) {
			rle_free(&f.resized);
			return -1;
		}
		size_t both = rle_intersection(f.now, other->mask);
		if (both)
			p->is_right = p->iou > (double)both / (double)(f.area + rle_area(other->mask) - both);
	}
	rle_free(&f.resized);
	return 0;
}

int score_choices(struct score_pairs *pairs, const struct score_mask *truth, size_t n, struct err *e)
{
	const ptrdiff_t count = (ptrdiff_t)pairs->n;
	struct score_lookup views = {0};
	ptrdiff_t first_bad = count;

	if (score_lookup_make(&views, truth, n, SCORE_BY_VIEW, e))
		return -1;
#pragma omp parallel for schedule(dynamic, 64)
	for (ptrdiff_t i = 0; i < count; i++) {
		struct score_pair *p = &pairs->items[i];
		size_t begin, end;
		struct err own;
		p->is_right = 0;
		if (!p->prediction || p->is_empty)
			continue;
		score_lookup_find(&views, truth[p->truth_index].view, "", &begin, &end);
		if (!judge(p, truth, views.items, begin, end, &own))
			continue;
#pragma omp critical(score_choices_failed)
		if (i < first_bad) {
			first_bad = i;
			*e = own;
		}
	}
	score_lookup_free(&views);
	return first_bad < count ? -1 : 0;
}
