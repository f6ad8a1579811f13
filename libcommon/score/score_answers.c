#include "score/score_answers.h"

#include "base/mem.h"
#include "score/score_lookup.h"

#include <stdlib.h>
#include <string.h>

const double answer_cut[ANSWER_CUTS] = {0.25, 0.5};

/* The objects of a view with something in their masks: items begin to end of struct seen. */
struct view {
	const char *name;
	size_t begin, end;
};

struct seen {
	const char *object;
	const struct rle *mask;
};

struct truth {
	size_t view_count, n;
	struct view *views; /* by name */
	struct seen *items; /* by view and object */
	const char **names; /* of every object, also where it is not seen; by name */
	size_t name_count;
};

static void truth_free(struct truth *t)
{
	free(t->views);
	free(t->items);
	free(t->names);
}

static int order_strings(const void *a, const void *b)
{
	return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Of several records of one object in a view the one without ref, else the first. */
static void list_objects(struct truth *t, const struct score_mask *truth, const struct score_lookup *l)
{
	for (size_t i = 0, next; i < l->n; i = next) {
		size_t chosen = l->items[i].index;
		for (next = i; next < l->n && !score_name_order(&l->items[i], &l->items[next]); next++)
			if (truth[chosen].ref && !truth[l->items[next].index].ref)
				chosen = l->items[next].index;
		t->names[t->name_count++] = l->items[i].name;
		if (!t->view_count || strcmp(t->views[t->view_count - 1].name, l->items[i].view))
			t->views[t->view_count++] = (struct view){l->items[i].view, t->n, t->n};
		if (rle_area(truth[chosen].mask))
			t->items[t->n++] = (struct seen){l->items[i].name, truth[chosen].mask};
		t->views[t->view_count - 1].end = t->n;
	}
	if (t->name_count)
		qsort(t->names, t->name_count, sizeof *t->names, order_strings);
}

static int truth_make(struct truth *t, const struct score_mask *truth, size_t n, struct err *e)
{
	struct score_lookup l = {0};

	*t = (struct truth){.views = mem_alloc(n, sizeof *t->views, "views", e),
		.items = mem_alloc(n, sizeof *t->items, "masks", e),
		.names = mem_alloc(n, sizeof *t->names, "objects", e)};
	if (!t->views || !t->items || !t->names || score_lookup_make(&l, truth, n, SCORE_BY_OBJECT, e))
		return -1;
	list_objects(t, truth, &l);
	score_lookup_free(&l);
	return 0;
}

static int means(const struct answer_sentence *s, const char *object)
{
	for (size_t i = 0; i < s->object_count; i++)
		if (!strcmp(s->objects[i], object))
			return 1;
	return 0;
}

static int is_asked(const struct answer_sentence *s, const char *view)
{
	int is_there = !s->view_count;

	if (s->view)
		return !strcmp(s->view, view);
	for (size_t i = 0; i < s->view_count && !is_there; i++)
		is_there = !strcmp(s->views[i], view);
	return is_there;
}

/* One prediction against the objects of its view. */
struct measure {
	size_t area; /* of the prediction */
	size_t shown[ANSWER_CUTS], hit[ANSWER_CUTS],
		meant;		       /* objects: covered, those that are meant too, all meant */
	double best_meant, best_other; /* IoU with a single object */
	struct rle all;		       /* the union of the meant */
};

static int add_object(
	struct measure *m, const struct rle *p, const struct seen *o, int is_meant, struct err *e)
{
	size_t both = rle_intersection(p, o->mask), area = rle_area(o->mask);
	double iou = (double)both / (double)(m->area + area - both);
	double *best = is_meant ? &m->best_meant : &m->best_other;
	struct rle more;

	for (int k = 0; k < ANSWER_CUTS; k++) {
		int is_shown = (double)both > answer_cut[k] * (double)area;
		m->shown[k] += (size_t)is_shown;
		m->hit[k] += (size_t)(is_shown && is_meant);
	}
	*best = iou > *best ? iou : *best;
	if (!is_meant)
		return 0;
	m->meant++;
	if (rle_unite(&more, m->all.n ? &m->all : o->mask, o->mask, e))
		return -1;
	rle_free(&m->all);
	m->all = more;
	return 0;
}

static void judge(struct answer *a, const struct measure *m, const struct rle *p)
{
	a->is_refused = !m->area;
	for (int k = 0; k < ANSWER_CUTS; k++)
		a->f1[k] = m->shown[k] + m->meant ? 2.0 * (double)m->hit[k] / (double)(m->shown[k] + m->meant)
						  : a->is_refused;
	if (!a->sentence->object_count) {
		/* A mask on nothing that has a name is an answer too. */
		a->is_right = a->is_refused;
		a->iou = a->f1[0] = a->f1[1] = a->is_refused;
		return;
	}
	a->iou = rle_iou(p, &m->all);
	if (a->sentence->object_count == 1)
		a->is_right = m->best_meant > 0 && m->best_meant >= m->best_other;
	else
		a->is_right = m->hit[1] == m->meant && m->shown[1] == m->meant;
}

static int measure(
	struct answer *a, const struct truth *t, const struct view *v, const struct rle *p, struct err *e)
{
	struct measure m = {0};
	struct rle fitted = {0};
	int bad = 0;

	for (size_t i = v->begin; i < v->end && !bad; i++) {
		const struct rle *mask = t->items[i].mask;
		if (p->height != mask->height || p->width != mask->width) {
			rle_free(&fitted);
			bad = rle_resize(&fitted, p, mask->height, mask->width, e);
			p = bad ? p : &fitted;
		}
		m.area = rle_area(p);
		bad = bad || add_object(&m, p, &t->items[i], means(a->sentence, t->items[i].object), e);
	}
	if (v->begin == v->end)
		m.area = rle_area(p);
	if (!bad)
		judge(a, &m, p);
	rle_free(&fitted);
	rle_free(&m.all);
	return bad ? -1 : 0;
}

static int sees(const struct truth *t, const struct view *v, const struct answer_sentence *s)
{
	for (size_t i = v->begin; i < v->end; i++)
		if (means(s, t->items[i].object))
			return 1;
	return 0;
}

/* The answers to one sentence. */
static int answer_one(struct answers *a, const struct truth *t, const struct answer_sentence *s,
	const struct score_mask *predictions, const struct score_lookup *refs, struct err *e)
{
	for (size_t i = 0; i < t->view_count; i++) {
		const struct view *v = &t->views[i];
		size_t begin, end;
		if (!is_asked(s, v->name))
			continue;
		if (s->object_count && !sees(t, v, s)) {
			a->out_of_sight++;
			continue;
		}
		struct answer one = {.sentence = s, .view = v->name};
		score_lookup_find(refs, v->name, s->ref, &begin, &end);
		one.is_missing = begin == end;
		if ((!one.is_missing && measure(&one, t, v, predictions[refs->items[begin].index].mask, e)) ||
			mem_grow((void **)&a->items, &a->capacity, a->n + 1, sizeof *a->items, "answers", e))
			return -1;
		a->items[a->n++] = one;
	}
	return 0;
}

static void count_unknown(
	struct answers *a, const struct truth *t, const struct answer_sentence *sentences, size_t n)
{
	for (size_t i = 0; i < n; i++) {
		int is_unknown = 0;
		for (size_t k = 0; k < sentences[i].object_count; k++) {
			const char *name = sentences[i].objects[k];
			is_unknown |= !t->name_count ||
				      !bsearch(&name, t->names, t->name_count, sizeof name, order_strings);
		}
		a->unknown += (size_t)is_unknown;
	}
}

static int count_unmatched(struct answers *a, const struct answer_sentence *sentences, size_t n,
	const struct score_mask *predictions, size_t prediction_n, struct err *e)
{
	const char **refs = mem_alloc(n, sizeof *refs, "sentences", e);

	if (!refs)
		return -1;
	for (size_t i = 0; i < n; i++)
		refs[i] = sentences[i].ref;
	if (n)
		qsort(refs, n, sizeof *refs, order_strings);
	for (size_t i = 0; i < prediction_n; i++)
		a->unmatched += !predictions[i].ref ||
				!bsearch(&predictions[i].ref, refs, n, sizeof *refs, order_strings);
	free(refs);
	return 0;
}

int answers_make(struct answers *a, const struct answer_sentence *sentences, size_t n,
	const struct score_mask *truth, size_t truth_n, const struct score_mask *predictions,
	size_t prediction_n, struct err *e)
{
	struct score_lookup refs = {0};
	struct truth t = {0};

	*a = (struct answers){0};
	int bad = truth_make(&t, truth, truth_n, e) ||
		  score_lookup_make(&refs, predictions, prediction_n, SCORE_BY_REF, e) ||
		  count_unmatched(a, sentences, n, predictions, prediction_n, e);
	for (size_t i = 0; i < n && !bad; i++)
		bad = answer_one(a, &t, &sentences[i], predictions, &refs, e);
	if (!bad)
		count_unknown(a, &t, sentences, n);
	score_lookup_free(&refs);
	truth_free(&t);
	if (bad)
		answers_free(a);
	return bad ? -1 : 0;
}

void answers_free(struct answers *a)
{
	free(a->items);
	*a = (struct answers){0};
}

void answer_score_sum(
	struct answer_score *s, const struct answers *a, enum answer_targets targets, const char *kind)
{
	*s = (struct answer_score){0};
	for (size_t i = 0; i < a->n; i++) {
		const struct answer *one = &a->items[i];
		size_t n = one->sentence->object_count;
		enum answer_targets own = n == 1 ? ANSWER_ONE : n ? ANSWER_SEVERAL : ANSWER_NONE;
		const char *own_kind = one->sentence->kind ? one->sentence->kind : "";
		if ((targets != ANSWER_ANY && targets != own) || (kind && strcmp(kind, own_kind)))
			continue;
		s->pairs++;
		s->missing += (size_t)one->is_missing;
		s->right += one->is_right;
		s->refused += one->is_refused;
		s->miou += one->iou;
		for (int k = 0; k < ANSWER_CUTS; k++)
			s->f1[k] += one->f1[k];
	}
	double per = s->pairs ? 1 / (double)s->pairs : 0;
	s->right *= per;
	s->refused *= per;
	s->miou *= per;
	for (int k = 0; k < ANSWER_CUTS; k++)
		s->f1[k] *= per;
}
