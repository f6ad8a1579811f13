#include "score/score.h"

#include "base/mem.h"
#include "score/score_lookup.h"

#include <stdlib.h>
#include <string.h>

const double score_cut[3] = {0.25, 0.5, 0.75};

int score_duplicate(const struct score_mask *masks, size_t n, size_t *earlier, size_t *later, struct err *e)
{
	int found = 0;

	/* sentences of one object share it rightly */
	static const enum score_lookup_by keys[] = {SCORE_BY_REF, SCORE_BY_BARE_OBJECT};

	for (int k = 0; k < 2; k++) {
		struct score_lookup list;
		if (score_lookup_make(&list, masks, n, keys[k], e))
			return -1;
		for (size_t i = 1; i < list.n; i++) {
			const struct score_name *before = &list.items[i - 1], *one = &list.items[i];
			if (!score_name_order(before, one) && (!found || one->index < *later)) {
				*earlier = before->index;
				*later = one->index;
				found = 1;
			}
		}
		score_lookup_free(&list);
	}
	return found;
}

void score_pairs_free(struct score_pairs *pairs)
{
	free(pairs->items);
	*pairs = (struct score_pairs){0};
}

/* What matching knows of each truth. */
enum { IS_MET = 1, IS_NAMED = 2 /* by a prediction's own ref */ };

struct match {
	struct score_pairs *pairs;
	const struct score_mask *truth;
	struct score_lookup lists[SCORE_LOOKUPS]; /* of the truth */
	unsigned char *state;			  /* of each truth */
};

static int add_pair(struct match *m, size_t t, const struct score_mask *prediction, struct err *e)
{
	const struct score_mask *truth = &m->truth[t];
	const char *object = truth->object ? truth->object : prediction ? prediction->object : NULL;
	void *items = m->pairs->items;

	if (mem_grow(&items, &m->pairs->capacity, m->pairs->n + 1, sizeof *m->pairs->items, "pairs", e))
		return -1;
	m->pairs->items = items;
	m->pairs->items[m->pairs->n] = (struct score_pair){.object = object ? object : truth->ref,
		.ref = prediction ? prediction->ref : NULL,
		.truth_ref = truth->ref,
		.truth_index = t,
		.place = m->pairs->n,
		.prediction = prediction ? prediction->mask : NULL,
		.truth = truth->mask};
	m->pairs->n++;
	m->state[t] |= IS_MET;
	return 0;
}

static int match_ref(struct match *m, const struct score_mask *p, struct err *e)
{
	size_t best;
	int found = score_lookup_best(m->lists, p->view, p->ref, p->object, &best);

	if (!found) {
		m->pairs->unmatched++;
		return 0;
	}
	if (found == 1)
		m->state[best] |= IS_NAMED;
	return add_pair(m, best, p, e);
}

static int match_object(struct match *m, const struct score_mask *p, struct err *e)
{
	size_t begin, end, met = 0;

	score_lookup_find(&m->lists[SCORE_BY_OBJECT], p->view, p->object, &begin, &end);
	for (size_t i = begin; i < end; i++) {
		size_t t = m->lists[SCORE_BY_OBJECT].items[i].index;
		if (m->state[t] & IS_NAMED)
			continue;
		if (add_pair(m, t, p, e))
			return -1;
		met++;
	}
	m->pairs->unmatched += !met;
	return 0;
}

static int match_all(struct match *m, size_t truth_n, const struct score_mask *predictions,
	size_t prediction_n, struct err *e)
{
	/* sentences first: they decide which truths are left to the masks of whole objects */
	for (int with_ref = 1; with_ref >= 0; with_ref--)
		for (size_t i = 0; i < prediction_n; i++) {
			const struct score_mask *p = &predictions[i];
			size_t begin, end;
			if ((p->ref != NULL) != with_ref)
				continue;
			score_lookup_find(&m->lists[SCORE_BY_VIEW], p->view, "", &begin, &end);
			if (begin == end)
				m->pairs->unlabelled++;
			else if (with_ref ? match_ref(m, p, e) : match_object(m, p, e))
				return -1;
		}
	for (size_t t = 0; t < truth_n; t++)
		if (!(m->state[t] & IS_MET) && add_pair(m, t, NULL, e))
			return -1;
	return 0;
}

int score_match(struct score_pairs *pairs, const struct score_mask *truth, size_t truth_n,
	const struct score_mask *predictions, size_t prediction_n, struct err *e)
{
	struct match m = {.pairs = pairs, .truth = truth};
	int bad = 0;

	*pairs = (struct score_pairs){0};
	for (int by = 0; by < SCORE_LOOKUPS && !bad; by++)
		bad = score_lookup_make(&m.lists[by], truth, truth_n, (enum score_lookup_by)by, e);
	m.state = mem_zalloc(truth_n, 1, "masks", e);
	if (!m.state)
		bad = -1;
	if (!bad)
		bad = match_all(&m, truth_n, predictions, prediction_n, e);
	for (int by = 0; by < SCORE_LOOKUPS; by++)
		score_lookup_free(&m.lists[by]);
	free(m.state);
	if (bad)
		score_pairs_free(pairs);
	return bad;
}

int score_measure(struct score_pair *pair, struct err *e)
{
	const struct rle *truth = pair->truth, *prediction = pair->prediction;
	struct rle resized = {0};
	size_t area = 0;

	pair->intersection = 0;
	if (prediction) {
		if (prediction->height != truth->height || prediction->width != truth->width) {
			if (rle_resize(&resized, prediction, truth->height, truth->width, e))
				return -1;
			prediction = &resized;
		}
		area = rle_area(prediction);
		pair->intersection = rle_intersection(prediction, truth);
	}
	size_t truth_area = rle_area(truth);
	pair->is_empty = !truth_area;
	pair->either = area + truth_area - pair->intersection;
	pair->iou = pair->either ? (double)pair->intersection / (double)pair->either : 1;
	rle_free(&resized);
	return 0;
}

int score_measure_all(struct score_pairs *pairs, struct err *e)
{
	const ptrdiff_t n = (ptrdiff_t)pairs->n;
	ptrdiff_t first_bad = n;

#pragma omp parallel for schedule(dynamic, 64)
	for (ptrdiff_t i = 0; i < n; i++) {
		struct err own;
		if (!score_measure(&pairs->items[i], &own))
			continue;
#pragma omp critical(score_measure_failed)
		if (i < first_bad) {
			first_bad = i;
			*e = own;
		}
	}
	return first_bad < n ? -1 : 0;
}

int score_keep_views(struct score_mask *truth, size_t *n, const struct score_mask *predictions,
	size_t prediction_n, const struct score_mask *others, size_t other_n, struct err *e)
{
	const struct score_mask *sides[2] = {predictions, others};
	const size_t counts[2] = {prediction_n, other_n};
	struct score_lookup views[2] = {{0}, {0}};
	size_t kept = 0;
	int bad = 0;

	for (int k = 0; k < 2 && !bad; k++)
		bad = score_lookup_make(&views[k], sides[k], counts[k], SCORE_BY_VIEW, e);
	for (size_t i = 0; i < *n && !bad; i++) {
		int is_kept = 0;
		for (int k = 0; k < 2 && !is_kept; k++) {
			size_t begin, end;
			score_lookup_find(&views[k], truth[i].view, "", &begin, &end);
			is_kept = begin < end;
		}
		if (is_kept)
			truth[kept++] = truth[i];
	}
	if (!bad)
		*n = kept;
	for (int k = 0; k < 2; k++)
		score_lookup_free(&views[k]);
	return bad;
}

static int order_pairs(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;
	int order = strcmp(p->object, q->object);

	return order ? order : (p->place > q->place) - (p->place < q->place);
}

void score_sort(struct score_pair *pairs, size_t n)
{
	if (n)
		qsort(pairs, n, sizeof *pairs, order_pairs);
}

void score_sum(struct score *s, const struct score_pair *pairs, size_t n)
{
	size_t intersection = 0, either = 0, right = 0, hits[3] = {0};

	*s = (struct score){0};
	for (size_t i = 0; i < n; i++) {
		const struct score_pair *p = &pairs[i];
		if (p->is_empty) {
			s->empty_truth++;
			continue;
		}
		s->pairs++;
		s->missing += !p->prediction;
		s->miou += p->iou;
		intersection += p->intersection;
		either += p->either;
		right += p->is_right != 0;
		for (int k = 0; k < 3; k++)
			hits[k] += p->iou >= score_cut[k];
	}
	if (!s->pairs)
		return;
	s->miou /= (double)s->pairs;
	s->oiou = (double)intersection / (double)either;
	s->right = (double)right / (double)s->pairs;
	for (int k = 0; k < 3; k++)
		s->precision[k] = (double)hits[k] / (double)s->pairs;
}
