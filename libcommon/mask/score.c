#include "mask/score.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

const double score_cut[3] = {0.25, 0.5, 0.75};

/* What a record is looked up by. */
struct name {
	const char *view, *name;
	size_t index;
};

static int order_texts(const struct name *a, const struct name *b)
{
	int order = strcmp(a->view, b->view);

	return order ? order : strcmp(a->name, b->name);
}

static int order_names(const void *a, const void *b)
{
	const struct name *p = a, *q = b;
	int order = order_texts(p, q);

	return order ? order : (p->index > q->index) - (p->index < q->index);
}

struct names {
	size_t n;
	struct name *items; /* sorted */
};

enum lookup { BY_REF, BY_OBJECT, BY_VIEW, LOOKUPS };

static int names_make(
	struct names *list, const struct score_mask *masks, size_t n, enum lookup by, struct err *e)
{
	*list = (struct names){0};
	list->items = mem_alloc(n, sizeof *list->items, "masks", e);
	if (!list->items)
		return -1;
	for (size_t i = 0; i < n; i++) {
		const char *name = by == BY_REF ? masks[i].ref : by == BY_OBJECT ? masks[i].object : "";
		if (name)
			list->items[list->n++] = (struct name){masks[i].view, name, i};
	}
	if (list->n)
		qsort(list->items, list->n, sizeof *list->items, order_names);
	return 0;
}

/* The range [*begin,*end) of a name; empty where it is not listed (or NULL). */
static void names_find(
	const struct names *list, const char *view, const char *name, size_t *begin, size_t *end)
{
	struct name key = {view, name, 0};
	size_t low = 0, high = name ? list->n : 0;

	while (low < high) {
		size_t middle = low + (high - low) / 2;
		if (order_texts(&list->items[middle], &key) < 0)
			low = middle + 1;
		else
			high = middle;
	}
	*begin = *end = low;
	while (name && *end < list->n && !order_texts(&list->items[*end], &key))
		++*end;
}

int score_duplicate(const struct score_mask *masks, size_t n, size_t *earlier, size_t *later, struct err *e)
{
	int found = 0;

	for (enum lookup by = BY_REF; by <= BY_OBJECT; by++) {
		struct names list;
		if (names_make(&list, masks, n, by, e))
			return -1;
		const struct name *before = NULL;
		for (size_t i = 0; i < list.n; i++) {
			const struct name *one = &list.items[i];
			/* sentences of one object share it rightly */
			if (by == BY_OBJECT && masks[one->index].ref)
				continue;
			if (before && !order_texts(before, one) && (!found || one->index < *later)) {
				*earlier = before->index;
				*later = one->index;
				found = 1;
			}
			before = one;
		}
		free(list.items);
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
	struct names lists[LOOKUPS]; /* of the truth */
	unsigned char *state;	     /* of each truth */
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
		.place = m->pairs->n,
		.prediction = prediction ? prediction->mask : NULL,
		.truth = truth->mask};
	m->pairs->n++;
	m->state[t] |= IS_MET;
	return 0;
}

static int match_ref(struct match *m, const struct score_mask *p, struct err *e)
{
	size_t begin, end, best;

	names_find(&m->lists[BY_REF], p->view, p->ref, &begin, &end);
	if (begin < end) {
		best = m->lists[BY_REF].items[begin].index;
		m->state[best] |= IS_NAMED;
		return add_pair(m, best, p, e);
	}
	names_find(&m->lists[BY_OBJECT], p->view, p->object, &begin, &end);
	if (begin == end) {
		m->pairs->unmatched++;
		return 0;
	}
	best = m->lists[BY_OBJECT].items[begin].index;
	for (size_t i = begin; i < end && m->truth[best].ref; i++)
		if (!m->truth[m->lists[BY_OBJECT].items[i].index].ref)
			best = m->lists[BY_OBJECT].items[i].index;
	return add_pair(m, best, p, e);
}

static int match_object(struct match *m, const struct score_mask *p, struct err *e)
{
	size_t begin, end, met = 0;

	names_find(&m->lists[BY_OBJECT], p->view, p->object, &begin, &end);
	for (size_t i = begin; i < end; i++) {
		size_t t = m->lists[BY_OBJECT].items[i].index;
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
			names_find(&m->lists[BY_VIEW], p->view, "", &begin, &end);
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
	for (int by = 0; by < LOOKUPS && !bad; by++)
		bad = names_make(&m.lists[by], truth, truth_n, (enum lookup)by, e);
	m.state = mem_zalloc(truth_n, 1, "masks", e);
	if (!m.state)
		bad = -1;
	if (!bad)
		bad = match_all(&m, truth_n, predictions, prediction_n, e);
	for (int by = 0; by < LOOKUPS; by++)
		free(m.lists[by].items);
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
	size_t intersection = 0, either = 0, hits[3] = {0};

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
		for (int k = 0; k < 3; k++)
			hits[k] += p->iou >= score_cut[k];
	}
	if (!s->pairs)
		return;
	s->miou /= (double)s->pairs;
	s->oiou = (double)intersection / (double)either;
	for (int k = 0; k < 3; k++)
		s->precision[k] = (double)hits[k] / (double)s->pairs;
}
