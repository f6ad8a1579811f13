#include "score/box_score.h"

#include <math.h>

static void add(struct box_figures *f, double iou)
{
	f->iou += iou;
	f->p25 += iou >= 0.25;
	f->p50 += iou >= 0.5;
}

static void divide(struct box_figures *f, size_t n)
{
	f->iou /= (double)n;
	f->p25 /= (double)n;
	f->p50 /= (double)n;
}

void box_score_sum(struct box_score *s, const struct box_pair *pairs, size_t n)
{
	size_t found = 0;

	*s = (struct box_score){.pairs = n};
	for (size_t i = 0; i < n; i++) {
		const struct box_pair *p = &pairs[i];
		double square = 0;
		s->missing += p->is_missing != 0;
		s->empty += p->is_empty != 0;
		if (p->is_missing || p->is_empty)
			continue;
		found++;
		add(&s->aligned, box_iou(&p->aligned, &p->true_aligned));
		add(&s->turned, box_iou(&p->turned, &p->true_turned));
		for (int k = 0; k < 3; k++) {
			const double d = p->aligned.centre[k] - p->true_aligned.centre[k];
			square += d * d;
		}
		const double diagonal = box_diagonal(&p->true_aligned);
		s->distance += sqrt(square);
		s->relative += diagonal > 0 ? sqrt(square) / diagonal : 0;
	}
	if (n) {
		divide(&s->aligned, n);
		divide(&s->turned, n);
	}
	s->distance = found ? s->distance / (double)found : NAN;
	s->relative = found ? s->relative / (double)found : NAN;
}
