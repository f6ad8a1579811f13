#include "score/score_answers.h"

#include "base/mem.h"
#include "base/names.h"
#include "mask/mask_index.h"

#include <math.h>

const double answer_cut[ANSWER_CUTS] = {0.25, 0.5};

/* The objects of a view with something in their masks: items begin to end of struct seen. */
struct view {
	const char *name;
	size_t begin, end;
	const double *time; /* NULL: it has none */
};

struct seen {
	const char *object;
	const struct rle *mask;
};

struct truth {
	size_t view_count, n;
	struct view *views;   /* by name */
	struct seen *items;   /* by view and object */
	struct names objects; /* of the masks, also where they are not seen */
};

static void truth_free(struct truth *t)
{
	names_free(&t->objects);
	mem_free_all(t->views, t->items);
}

/* Of several masks of one object in a view the one without ref, else the first. */
static void list_objects(struct truth *t, const struct mask *truth, const struct mask_index *x)
{
	for (size_t i = 0, next; i < x->n; i = next) {
		const struct mask_key *key = &x->keys[i];
		size_t chosen = key->at;
		for (next = i; next < x->n && !mask_key_order(key, &x->keys[next]); next++)
			if (truth[chosen].ref && !truth[x->keys[next].at].ref)
				chosen = x->keys[next].at;
		if (key->is_ref)
			continue;
		if (!t->view_count || strcmp(t->views[t->view_count - 1].name, key->view))
			t->views[t->view_count++] = (struct view){key->view, t->n, t->n, NULL};
		const struct mask_place *place = truth[chosen].place;
		if (place && place->has_time)
			t->views[t->view_count - 1].time = &place->time;
		if (rle_area(&truth[chosen].rle))
			t->items[t->n++] = (struct seen){key->name, &truth[chosen].rle};
		t->views[t->view_count - 1].end = t->n;
	}
}

static int truth_make(struct truth *t, const struct mask *truth, size_t n, struct err *e)
{
	SCOPED_BY(mask_index_free) struct mask_index x = {0};

	*t = (struct truth){.views = mem_alloc(n, sizeof *t->views, "views", e),
		.items = mem_alloc(n, sizeof *t->items, "masks", e)};
	if (!t->views || !t->items || mask_index_make(&x, truth, n, MASK_BY_OBJECT, e) ||
		names_make(&t->objects, truth, sizeof *truth, offsetof(struct mask, object), n, e))
		return -1;
	list_objects(t, truth, &x);
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
	size_t shown[ANSWER_CUTS], hit[ANSWER_CUTS],
		meant;		       /* objects: covered, those that are meant too, all meant */
	double best_meant, best_other; /* IoU with a single object */
	struct rle all;		       /* the union of the meant, at the size of the first */
};

static int add_object(
	struct measure *m, const struct rle_fitted *p, const struct seen *o, int is_meant, struct err *e)
{
	size_t both = rle_intersection(p->now, o->mask), area = rle_area(o->mask);
	double iou = (double)both / (double)(p->area + area - both);
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
	const struct rle *all = m->all.n ? &m->all : o->mask;
	SCOPED_BY(rle_fitted_free) struct rle_fitted own = {.own = o->mask};
	const int bad = rle_fit(&own, all, e) || rle_unite(&more, all, own.now, e);
	if (bad)
		return -1;
	rle_free(&m->all);
	m->all = more;
	return 0;
}

static void judge(struct answer *a, const struct measure *m, const struct rle_fitted *p)
{
	a->is_refused = !p->area;
	a->either = p->area;
	for (int k = 0; k < ANSWER_CUTS; k++)
		a->f1[k] = m->shown[k] + m->meant ? 2.0 * (double)m->hit[k] / (double)(m->shown[k] + m->meant)
						  : a->is_refused;
	if (!a->sentence->object_count) {
		/* A mask on nothing that has a name is an answer too. */
		a->is_right = a->is_refused;
		a->iou = a->f1[0] = a->f1[1] = a->is_refused;
		return;
	}
	a->iou = rle_iou(p->now, &m->all);
	a->intersection = rle_intersection(p->now, &m->all);
	a->either = p->area + rle_area(&m->all) - a->intersection;
	if (a->sentence->object_count == 1)
		a->is_right = m->best_meant > 0 && m->best_meant >= m->best_other;
	else
		a->is_right = m->hit[1] == m->meant && m->shown[1] == m->meant;
}

static int measure(
	struct answer *a, const struct truth *t, const struct view *v, const struct rle *p, struct err *e)
{
	struct measure m = {0};
	SCOPED_BY(rle_fitted_free) struct rle_fitted f = {.own = p};
	int bad = v->begin == v->end && rle_fit(&f, p, e);

	for (size_t i = v->begin; i < v->end && !bad; i++) {
		const struct seen *o = &t->items[i];
		bad = rle_fit(&f, o->mask, e) || add_object(&m, &f, o, means(a->sentence, o->object), e);
	}
	bad = bad || (m.all.n && rle_fit(&f, &m.all, e));
	if (!bad)
		judge(a, &m, &f);
	rle_free(&m.all);
	return bad ? -1 : 0;
}

/* What is not there covers nothing, and is wrong whatever is meant. */
static int measure_missing(struct answer *a, const struct truth *t, const struct view *v, struct err *e)
{
	uint32_t run = 1;
	const struct rle none = {.height = 1, .width = 1, .n = 1, .runs = &run};

	if (measure(a, t, v, &none, e))
		return -1;
	a->is_missing = 1;
	a->is_refused = a->is_right = 0;
	a->iou = a->f1[0] = a->f1[1] = 0;
	return 0;
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
	const struct mask *predictions, const struct mask_index *refs, struct err *e)
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
		if (s->when && s->object_count && !v->time)
			return err_set(e, ERR_FORMAT,
				"no mask of view '%s' has a time, which sentence '%s' needs: its 'when'",
				v->name, s->ref);
		one.is_outside =
			s->when && s->object_count && !(*v->time >= s->when[0] && *v->time <= s->when[1]);
		mask_index_ref(refs, v->name, s->ref, &begin, &end);
		if ((begin == end ? measure_missing(&one, t, v, e)
				  : measure(&one, t, v, &predictions[refs->keys[begin].at].rle, e)) ||
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
		for (size_t k = 0; k < sentences[i].object_count; k++)
			is_unknown |= names_find(&t->objects, sentences[i].objects[k]) == NAMES_NONE;
		a->unknown += (size_t)is_unknown;
	}
}

static int count_unmatched(struct answers *a, const struct answer_sentence *sentences, size_t n,
	const struct mask *predictions, size_t prediction_n, struct err *e)
{
	SCOPED_BY(names_free) struct names refs = {0};

	if (names_make(&refs, sentences, sizeof *sentences, offsetof(struct answer_sentence, ref), n, e))
		return -1;
	for (size_t i = 0; i < prediction_n; i++)
		a->unmatched += !predictions[i].ref || names_find(&refs, predictions[i].ref) == NAMES_NONE;
	return 0;
}

int answers_make(struct answers *a, const struct answer_sentence *sentences, size_t n,
	const struct mask *truth, size_t truth_n, const struct mask *predictions, size_t prediction_n,
	struct err *e)
{
	SCOPED_BY(mask_index_free) struct mask_index refs = {0};
	SCOPED_BY(truth_free) struct truth t = {0};

	*a = (struct answers){0};
	int bad = truth_make(&t, truth, truth_n, e) ||
		  mask_index_make(&refs, predictions, prediction_n, MASK_BY_REF, e) ||
		  count_unmatched(a, sentences, n, predictions, prediction_n, e);
	for (size_t i = 0; i < n && !bad; i++)
		bad = answer_one(a, &t, &sentences[i], predictions, &refs, e);
	if (!bad)
		count_unknown(a, &t, sentences, n);
	return bad ? -1 : 0;
}

void answers_free(struct answers *a)
{
	free(a->items);
	*a = (struct answers){0};
}

/* Of one sentence, or of several. */
struct timing {
	size_t n, views, inside, hits, both, either;
	double iou, accuracy, viou, tiou;
};

static void time_view(struct timing *t, const struct answer *a)
{
	const int is_answered = !a->is_refused && !a->is_missing, both = is_answered && !a->is_outside;

	t->views++;
	t->inside += (size_t)!a->is_outside;
	t->hits += (size_t)(is_answered == !a->is_outside);
	t->both += (size_t)both;
	t->either += (size_t)(is_answered || !a->is_outside);
	t->iou += both ? a->iou : 0;
}

/* Ends a sentence. Where no view is of its time there is nothing to be found. */
static void time_end(struct timing *t)
{
	if (t->inside) {
		t->n++;
		t->accuracy += (double)t->hits / (double)t->views;
		t->viou += t->iou / (double)t->either;
		t->tiou += (double)t->both / (double)t->either;
	}
	t->views = t->inside = t->hits = t->both = t->either = 0;
	t->iou = 0;
}

void answer_score_sum(
	struct answer_score *s, const struct answers *a, enum answer_targets targets, const char *kind)
{
	size_t intersection = 0, either = 0;
	const struct answer_sentence *last = NULL;
	struct timing t = {0};

	*s = (struct answer_score){0};
	for (size_t i = 0; i < a->n; i++) {
		const struct answer *one = &a->items[i];
		size_t n = one->sentence->object_count;
		enum answer_targets own = n == 1 ? ANSWER_ONE : n ? ANSWER_SEVERAL : ANSWER_NONE;
		const char *own_kind = one->sentence->kind ? one->sentence->kind : "";
		if ((targets != ANSWER_ANY && targets != own) || (kind && strcmp(kind, own_kind)))
			continue;
		if (one->sentence != last)
			time_end(&t);
		last = one->sentence;
		if (n && last->when)
			time_view(&t, one);
		if (one->is_outside)
			continue;
		s->pairs++;
		s->missing += (size_t)one->is_missing;
		s->right += one->is_right;
		s->refused += one->is_refused;
		s->miou += one->iou;
		intersection += one->intersection;
		either += one->either;
		for (int k = 0; k < ANSWER_CUTS; k++)
			s->f1[k] += one->f1[k];
	}
	time_end(&t);
	s->timed = t.n;
	s->accuracy = t.n ? t.accuracy / (double)t.n : 0;
	s->viou = t.n ? t.viou / (double)t.n : 0;
	s->tiou = t.n ? t.tiou / (double)t.n : 0;
	double per = s->pairs ? 1 / (double)s->pairs : 0;
	s->right *= per;
	s->refused *= per;
	s->miou *= per;
	for (int k = 0; k < ANSWER_CUTS; k++)
		s->f1[k] *= per;
	s->oiou = either ? (double)intersection / (double)either : s->pairs > 0;
}

void answer_target_accuracy(double *none, double *some, const struct answers *a)
{
	size_t pairs[2] = {0, 0}, hits[2] = {0, 0};

	for (size_t i = 0; i < a->n; i++) {
		const struct answer *one = &a->items[i];
		const int is_some = one->sentence->object_count > 0;
		if (one->is_outside)
			continue;
		pairs[is_some]++;
		hits[is_some] += (size_t)(is_some ? !one->is_refused && !one->is_missing : one->is_refused);
	}
	*none = pairs[0] ? (double)hits[0] / (double)pairs[0] : (double)NAN;
	*some = pairs[1] ? (double)hits[1] / (double)pairs[1] : (double)NAN;
}
