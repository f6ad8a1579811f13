#include "score/score.h"

#include "base/compare.h"
#include "base/mem.h"
#include "mask/mask_index.h"

const double score_cut[3] = {0.25, 0.5, 0.75};

void score_pairs_free(struct score_pairs *pairs)
{
	free(pairs->items);
	*pairs = (struct score_pairs){0};
}

/* What matching knows of each truth. */
enum { IS_MET = 1, IS_NAMED = 2 /* by a prediction's own ref */ };

struct match {
	struct score_pairs *pairs;
	const struct mask *truth;
	struct mask_lookup lookup; /* of the truth */
	unsigned char *state;	   /* of each truth */
};

static int add_pair(struct match *m, size_t t, const struct mask *prediction, struct err *e)
{
	const struct mask *truth = &m->truth[t];
	const char *object = truth->object ? truth->object : prediction ? prediction->object : NULL;

	if (mem_grow((void **)&m->pairs->items, &m->pairs->capacity, m->pairs->n + 1, sizeof *m->pairs->items,
		    "pairs", e))
		return -1;
	m->pairs->items[m->pairs->n] = (struct score_pair){.object = object ? object : truth->ref,
		.ref = prediction ? prediction->ref : NULL,
		.truth_index = t,
		.place = m->pairs->n,
		.prediction = prediction,
		.truth = truth};
	m->pairs->n++;
	m->state[t] |= IS_MET;
	return 0;
}

static int match_ref(struct match *m, const struct mask *p, struct err *e)
{
	size_t best;
	const enum mask_found found = mask_lookup_find(&m->lookup, p->view, p->ref, p->object, &best);

	if (found == MASK_NONE) {
		m->pairs->unmatched++;
		return 0;
	}
	if (found == MASK_OF_REF)
		m->state[best] |= IS_NAMED;
	return add_pair(m, best, p, e);
}

static int match_object(struct match *m, const struct mask *p, struct err *e)
{
	size_t begin, end, met = 0;

	mask_index_object(&m->lookup.by_object, p->view, p->object, &begin, &end);
	for (size_t i = begin; i < end; i++) {
		size_t t = m->lookup.by_object.keys[i].at;
		if (m->state[t] & IS_NAMED)
			continue;
		if (add_pair(m, t, p, e))
			return -1;
		met++;
	}
	m->pairs->unmatched += !met;
	return 0;
}

static int match_all(
	struct match *m, size_t truth_n, const struct mask *predictions, size_t prediction_n, struct err *e)
{
	/* sentences first: they decide which truths are left to the masks of whole objects */
	for (int with_ref = 1; with_ref >= 0; with_ref--)
		for (size_t i = 0; i < prediction_n; i++) {
			const struct mask *p = &predictions[i];
			size_t begin, end;
			if ((p->ref != NULL) != with_ref)
				continue;
			mask_index_view(&m->lookup.by_ref, p->view, &begin, &end);
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

int score_match(struct score_pairs *pairs, const struct mask *truth, size_t truth_n,
	const struct mask *predictions, size_t prediction_n, struct err *e)
{
	struct match m = {.pairs = pairs, .truth = truth};

	*pairs = (struct score_pairs){0};
	m.state = mem_zalloc(truth_n, 1, "masks", e);
	const int bad = !m.state || mask_lookup_make(&m.lookup, truth, truth_n, e) ||
			match_all(&m, truth_n, predictions, prediction_n, e);
	mask_lookup_free(&m.lookup);
	free(m.state);
	return bad ? -1 : 0;
}

static void measure_peak(struct score_pair *pair)
{
	const struct mask *p = pair->prediction, *truth = pair->truth;

	pair->is_in_box = pair->is_in_mask = 0;
	if (!p || !p->place || !p->place->has_peak)
		return;
	const double *peak = p->place->peak;
	pair->is_in_box = mask_place_in_box(peak, p->rle.height, p->rle.width, &truth->rle, truth->place);
	pair->is_in_mask = mask_place_in_mask(peak, p->rle.height, p->rle.width, &truth->rle);
}

int score_measure(struct score_pair *pair, struct err *e)
{
	const struct rle *truth = &pair->truth->rle;
	const size_t truth_area = rle_area(truth);
	SCOPED_BY(rle_fitted_free) struct rle_fitted f = {0};

	pair->intersection = 0;
	if (pair->prediction) {
		f.own = &pair->prediction->rle;
		if (rle_fit(&f, truth, e))
			return -1;
		pair->intersection = rle_intersection(f.now, truth);
	}
	measure_peak(pair);
	pair->is_empty = !truth_area;
	pair->either = f.area + truth_area - pair->intersection;
	pair->iou = pair->either ? (double)pair->intersection / (double)pair->either : 1;
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

int score_keep_views(struct mask *truth, size_t *n, const struct mask *predictions, size_t prediction_n,
	const struct mask *others, size_t other_n, struct err *e)
{
	struct mask_index views[2] = {{0}, {0}};
	size_t kept = 0;
	int bad = mask_index_make(&views[0], predictions, prediction_n, MASK_BY_REF, e) ||
		  mask_index_make(&views[1], others, other_n, MASK_BY_REF, e);

	for (size_t i = 0; i < *n && !bad; i++) {
		size_t begin = 0, end = 0;
		for (int k = 0; k < 2 && begin == end; k++)
			mask_index_view(&views[k], truth[i].view, &begin, &end);
		if (begin == end)
			continue;
		const struct mask m = truth[i];
		truth[i] = truth[kept];
		truth[kept++] = m;
	}
	if (!bad)
		*n = kept;
	for (int k = 0; k < 2; k++)
		mask_index_free(&views[k]);
	return bad ? -1 : 0;
}

static int order_pairs(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;
	int order = strcmp(p->object, q->object);

	return order ? order : COMPARE(p->place, q->place);
}

void score_sort(struct score_pair *pairs, size_t n)
{
	if (n)
		qsort(pairs, n, sizeof *pairs, order_pairs);
}

void score_sum(struct score *s, const struct score_pair *pairs, size_t n)
{
	size_t intersection = 0, either = 0, right = 0, in_box = 0, in_mask = 0, hits[3] = {0};

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
		s->peaks += p->prediction && p->prediction->place && p->prediction->place->has_peak;
		in_box += p->is_in_box != 0;
		in_mask += p->is_in_mask != 0;
		for (int k = 0; k < 3; k++)
			hits[k] += p->iou >= score_cut[k];
	}
	if (!s->pairs)
		return;
	s->miou /= (double)s->pairs;
	s->oiou = (double)intersection / (double)either;
	s->right = (double)right / (double)s->pairs;
	s->in_box = (double)in_box / (double)s->pairs;
	s->in_mask = (double)in_mask / (double)s->pairs;
	for (int k = 0; k < 3; k++)
		s->precision[k] = (double)hits[k] / (double)s->pairs;
}

/* By truth; a pair without ref comes before those with one. */
static int order_joined(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;

	if (p->truth_index != q->truth_index)
		return COMPARE(p->truth_index, q->truth_index);
	if (p->ref && q->ref)
		return strcmp(p->ref, q->ref);
	return (p->ref != NULL) - (q->ref != NULL);
}

static int order_places(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;

	return COMPARE(p->place, q->place);
}

/* The pairs of one truth on one side. */
struct run {
	const struct score_pair
		*bare; /* without ref, perhaps without a prediction; NULL where there is none */
	const struct score_pair *named; /* those with ref */
	size_t n;
};

static struct run take_run(const struct score_pair *items, size_t n, size_t *at)
{
	const struct score_pair *first = &items[*at];
	struct run r = {.bare = first->ref ? NULL : first, .named = first->ref ? first : first + 1};

	*at += r.bare != NULL;
	for (; *at < n && items[*at].truth_index == first->truth_index; ++*at)
		r.n++;
	return r;
}

/* What a side has for a sentence of the truth: its own, else the mask without ref, else nothing. */
static struct score_pair side_of(const struct run *r, const struct score_pair *own)
{
	const struct score_pair *found = own ? own : r->bare;
	struct score_pair pair = found ? *found : r->named[0];

	if (!found)
		pair.prediction = NULL;
	return pair;
}

struct join {
	struct score_pair *sorted[2]; /* (n[i]) */
	struct score_pair *joined[2]; /* (at most n[0]+n[1]) */
	size_t n[2], count;
};

static void add(struct join *j, const struct run runs[2], const struct score_pair *own[2])
{
	const struct score_pair *named = own[0] ? own[0] : own[1];
	struct score_pair a = side_of(&runs[0], own[0]), b = side_of(&runs[1], own[1]);

	a.ref = b.ref = named->ref;
	a.place = b.place = own[0] ? own[0]->place : j->n[0] + own[1]->place;
	a.object = b.object = a.prediction || !b.prediction ? a.object : b.object;
	j->joined[0][j->count] = a;
	j->joined[1][j->count++] = b;
}

static void join_truth(struct join *j, const struct run runs[2])
{
	size_t at[2] = {0, 0};

	while (at[0] < runs[0].n || at[1] < runs[1].n) {
		int order = at[0] == runs[0].n	 ? 1
			    : at[1] == runs[1].n ? -1
						 : order_joined(&runs[0].named[at[0]], &runs[1].named[at[1]]);
		const struct score_pair *own[2] = {order <= 0 ? &runs[0].named[at[0]++] : NULL,
			order >= 0 ? &runs[1].named[at[1]++] : NULL};
		add(j, runs, own);
	}
	if (runs[0].bare && runs[1].bare)
		add(j, runs, (const struct score_pair *[2]){runs[0].bare, runs[1].bare});
}

int score_join(struct score_pairs *a, struct score_pairs *b, struct err *e)
{
	struct score_pairs *sides[2] = {a, b};
	struct join j = {.n = {a->n, b->n}};
	size_t at[2] = {0, 0};
	int bad = 0;

	for (int s = 0; s < 2; s++) {
		j.sorted[s] = mem_alloc(sides[s]->n, sizeof *j.sorted[s], "pairs", e);
		j.joined[s] = mem_alloc(a->n + b->n, sizeof *j.joined[s], "pairs", e);
		bad = bad || !j.sorted[s] || !j.joined[s];
		if (bad || !sides[s]->n)
			continue;
		memcpy(j.sorted[s], sides[s]->items, sides[s]->n * sizeof *j.sorted[s]);
		qsort(j.sorted[s], sides[s]->n, sizeof *j.sorted[s], order_joined);
	}
	/* every truth has a pair on either side */
	while (!bad && at[0] < j.n[0]) {
		struct run runs[2];
		for (int s = 0; s < 2; s++)
			runs[s] = take_run(j.sorted[s], j.n[s], &at[s]);
		join_truth(&j, runs);
	}
	for (int s = 0; s < 2; s++) {
		free(j.sorted[s]);
		if (bad) {
			free(j.joined[s]);
			continue;
		}
		if (j.count)
			qsort(j.joined[s], j.count, sizeof *j.joined[s], order_places);
		free(sides[s]->items);
		sides[s]->items = j.joined[s];
		sides[s]->n = j.count;
		sides[s]->capacity = j.n[0] + j.n[1];
	}
	return bad ? -1 : 0;
}
