/* The margins. Directions are judged both on the table and by bearing, sizes both by bulk and by the longest
 * extent, so that whoever looks or measures otherwise finds the same object. Units: formats/scene/synth.md.
 */
#include "synth/unseen_judge.h"

#include <math.h>

static const double margin = 0.25, size_margin = 1.12, bearing_margin = 0.02;

void synth_stand_camera(struct synth_stand *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const double centre[3], const double right[2], const double away[2])
{
	double cu = right[0] * centre[0] + right[1] * centre[1];
	double cv = away[0] * centre[0] + away[1] * centre[1];

	*s = (struct synth_stand){.n = n, .objects = objects, .visible = ~(uint64_t)0};
	for (int i = 0; i < n; i++) {
		s->u[i] = right[0] * objects[i].x + right[1] * objects[i].y;
		s->v[i] = away[0] * objects[i].x + away[1] * objects[i].y;
		s->bearing[i] = atan2(s->u[i] - cu, s->v[i] - cv);
		s->range[i] = hypot(s->u[i] - cu, s->v[i] - cv);
	}
	s->half_u = fabs(right[0]) * table->half_width + fabs(right[1]) * table->half_depth;
	s->half_v = fabs(away[0]) * table->half_width + fabs(away[1]) * table->half_depth;
}

static int verdict(int is_true, int is_false)
{
	return is_true ? 1 : is_false ? -1 : 0;
}

static int least(int a, int b)
{
	return a < b ? a : b;
}

static double distance(const struct synth_stand *s, int i, int j)
{
	return hypot(s->u[i] - s->u[j], s->v[i] - s->v[j]);
}

static int stands_on(const struct synth_stand *s, int i, int a)
{
	for (i = s->objects[i].on; i >= 0; i = s->objects[i].on)
		if (i == a)
			return 1;
	return 0;
}

static int are_stacked(const struct synth_stand *s, int i, int j)
{
	return stands_on(s, i, j) || stands_on(s, j, i);
}

/* How far i lies from a in the direction of the relation, on the table and in the second measure. */
static void lead(
	const struct synth_stand *s, enum parse_relation r, int i, int a, double *first, double *second)
{
	int sideways = r == PARSE_LEFT || r == PARSE_RIGHT;
	double sign = r == PARSE_LEFT || r == PARSE_FRONT ? -1 : 1;
	const double *x = sideways ? s->u : s->v, *y = sideways ? s->bearing : s->range;

	*first = sign * (x[i] - x[a]);
	*second = sign * (y[i] - y[a]);
}

static int towards(const struct synth_stand *s, enum parse_relation r, int i, int a)
{
	int sideways = r == PARSE_LEFT || r == PARSE_RIGHT;
	double ahead, second, aside = fabs(sideways ? s->v[i] - s->v[a] : s->u[i] - s->u[a]);
	double least_second = sideways ? bearing_margin : 0.1;

	lead(s, r, i, a, &ahead, &second);
	int v = verdict(ahead > 0.3 && ahead > aside && second > least_second,
		(ahead < 0.05 && second < least_second / 2) || aside > 4 * ahead);
	return v > 0 && are_stacked(s, i, a) ? 0 : v;
}

static int near(const struct synth_stand *s, int i, int a)
{
	double gap = distance(s, i, a) - s->objects[i].radius - s->objects[a].radius;

	return are_stacked(s, i, a) ? 0 : verdict(gap<0.35, gap> 0.9);
}

static int between(const struct synth_stand *s, int i, int a, int b)
{
	double du = s->u[b] - s->u[a], dv = s->v[b] - s->v[a], length = hypot(du, dv);
	double pu = s->u[i] - s->u[a], pv = s->v[i] - s->v[a];

	if (length < 0.3)
		return 0;
	double along = (pu * du + pv * dv) / (length * length);
	double off = fabs(pu * dv - pv * du) / (length * length);
	int v = verdict(
		along > 0.25 && along < 0.75 && off < 0.18, along < 0.02 || along > 0.98 || off > 0.5);
	return v > 0 && (are_stacked(s, i, a) || are_stacked(s, i, b)) ? 0 : v;
}

/* The place of an object in the scene: "on the left", "in the middle". */
static int side(const struct synth_stand *s, enum parse_relation r, int i)
{
	double u = s->u[i] / s->half_u, v = s->v[i] / s->half_v, x = 0;

	if (r == PARSE_MIDDLE)
		return verdict(hypot(u, v) < 0.3, hypot(u, v) > 0.6);
	x = r == PARSE_LEFT ? -u : r == PARSE_RIGHT ? u : r == PARSE_FRONT ? -v : v;
	return verdict(x > 0.35, x < 0.05);
}

/* 1 where i is plainly more than j of what the relation names, -1 where plainly less. */
static int compare_size(const struct synth_stand *s, enum parse_relation r, int i, int j)
{
	const struct synth_object *a = &s->objects[i], *b = &s->objects[j];
	double tall = a->height / b->height;
	double bulk = cbrt(a->radius * a->radius * a->height / (b->radius * b->radius * b->height));
	double extent = fmax(2 * a->radius, a->height) / fmax(2 * b->radius, b->height);
	double low = fmin(bulk, extent), high = fmax(bulk, extent);
	int sign = r == PARSE_SMALLER || r == PARSE_SHORTER ? -1 : 1;

	if (r == PARSE_TALLER || r == PARSE_SHORTER)
		low = high = tall;
	return sign * verdict(low > size_margin, high < 1 / size_margin);
}

/* The same for where things are: two measures of the quantity of which the superlative's object has most. */
static int compare_place(
	const struct synth_stand *s, const struct synth_unseen_clause *c, int anchor, int i, int j)
{
	double first, second, least_second = margin;
	int sign = c->relation == PARSE_FAR ? 1 : -1;

	if (c->relation == PARSE_NEAR || c->relation == PARSE_FAR) {
		if (anchor < 0) {
			first = sign * (s->v[i] - s->v[j]);
			second = sign * (s->range[i] - s->range[j]);
		} else {
			if (are_stacked(s, i, anchor) || are_stacked(s, j, anchor))
				return 0;
			first = sign * (distance(s, i, anchor) - distance(s, j, anchor));
			second = first - sign * (s->objects[i].radius - s->objects[j].radius);
			least_second = 0.1;
		}
	} else {
		lead(s, c->relation, i, j, &first, &second);
		if (c->relation == PARSE_LEFT || c->relation == PARSE_RIGHT)
			least_second = bearing_margin;
	}
	return verdict(first > margin && second > least_second, first < -margin && second < -least_second);
}

static int is_size(enum parse_relation r)
{
	return r >= PARSE_LARGER && r <= PARSE_WIDER;
}

/* The most, or of two the more. */
static int superlative(
	const struct synth_stand *s, const struct synth_unseen_clause *c, int anchor, int i, const int *among)
{
	int v = 1, rivals = 0;

	for (int j = 0; j < s->n; j++) {
		if (j == i || j == anchor || among[j] < 0)
			continue;
		int one = is_size(c->relation) ? compare_size(s, c->relation, i, j)
					       : compare_place(s, c, anchor, i, j);
		/* Less than what may not be among them proves nothing. */
		v = least(v, among[j] == 0 && one < 0 ? 0 : one);
		rivals += among[j] > 0;
	}
	return rivals ? v : 0;
}

static int middle_one(const struct synth_stand *s, int i, const int *among)
{
	int others[2], n = 0;

	for (int j = 0; j < s->n; j++) {
		if (j == i || among[j] < 0)
			continue;
		if (n == 2)
			return 0;
		others[n++] = j;
	}
	return n == 2 ? between(s, i, others[0], others[1]) : 0;
}

static int carries_anything(const struct synth_stand *s, int i)
{
	for (int j = 0; j < s->n; j++)
		if (s->objects[j].on == i)
			return 1;
	return -1;
}

/* Those of a clause's anchors, at most two; -1: who looks. The number, or -1 where it could be argued. */
static int find_anchors(const struct synth_stand *s, const struct synth_unseen *x,
	const struct synth_unseen_clause *c, int found[2])
{
	int n = 0;

	found[0] = found[1] = -1;
	for (int k = 0; k < c->anchor_count; k++) {
		uint64_t set;
		if (x->phrases[c->anchors[k]].viewer)
			continue;
		if (synth_unseen_resolve(s, x, c->anchors[k], 0, &set) || (set & ~s->visible))
			return -1;
		for (int i = 0; i < s->n; i++) {
			if (!(set >> i & 1))
				continue;
			if (n == 2)
				return -1;
			found[n++] = i;
		}
	}
	return n;
}

static int judge_place(const struct synth_stand *s, enum parse_relation r, int i, int a, int b)
{
	switch (r) {
	case PARSE_LEFT:
	case PARSE_RIGHT:
	case PARSE_FRONT:
	case PARSE_BEHIND:
		return towards(s, r, i, a);
	case PARSE_NEAR:
		return near(s, i, a);
	case PARSE_BETWEEN:
		return b < 0 ? 0 : between(s, i, a, b);
	case PARSE_ON:
		return verdict(s->objects[i].on == a, !stands_on(s, i, a));
	case PARSE_BELOW:
	case PARSE_SUPPORTS:
		return verdict(s->objects[a].on == i, !stands_on(s, a, i));
	default:
		return 0;
	}
}

int synth_unseen_judge(
	const struct synth_stand *s, const struct synth_unseen *x, int clause, int i, const int *among)
{
	const struct synth_unseen_clause *c = &x->clauses[clause];
	int found[2], n, v, sign = c->negated ? -1 : 1;

	if (c->relation == PARSE_OTHER) {
		unsigned bit = 1u << s->objects[i].shape;
		return sign * (c->does & bit ? 1 : c->may_do & bit ? 0 : -1);
	}
	if (c->anchor_count && x->phrases[c->anchors[0]].is_anything)
		return sign * carries_anything(s, i);
	n = find_anchors(s, x, c, found);
	if (n < 0)
		return 0;
	if (i == found[0] || i == found[1])
		return -1;
	if (is_size(c->relation) && n)
		v = compare_size(s, c->relation, i, found[0]);
	else if (c->degree != PARSE_PLAIN)
		v = superlative(s, c, found[0], i, among);
	else if (n)
		v = judge_place(s, c->relation, i, found[0], found[1]);
	else
		v = side(s, c->relation, i);
	return sign * v;
}

static int judge_words(const struct synth_unseen_sense *w, const struct synth_object *o)
{
	unsigned shape = 1u << o->shape, colour = 1u << o->colour, size = 1u << o->size;

	if (w->shapes & shape && w->colours & colour && w->sizes & size && w->finishes >> o->finish & 1)
		return 1;
	return (w->shapes | w->maybe_shapes) & shape && (w->colours | w->maybe_colours) & colour &&
			       (w->sizes | w->maybe_sizes) & size && w->finishes >> o->finish & 1
		       ? 0
		       : -1;
}

/* 1 where the clause ranks what the rest of the phrase fits. */
static int ranks(const struct synth_unseen *x, const struct synth_unseen_phrase *p, int k)
{
	const struct synth_unseen_clause *c = &x->clauses[p->clauses[k]];

	return p->group ? 1 : c->degree != PARSE_PLAIN && !(is_size(c->relation) && c->anchor_count);
}

/* Verdicts without what ranks: words, clauses and what is left out. */
static void judge_phrase(const struct synth_stand *s, const struct synth_unseen *x, int phrase, int *values)
{
	const struct synth_unseen_phrase *p = &x->phrases[phrase];

	for (int i = 0; i < s->n; i++) {
		values[i] = judge_words(&p->sense, &s->objects[i]);
		for (int k = 0; k < p->clause_count && values[i] >= 0; k++)
			if (!ranks(x, p, k))
				values[i] =
					least(values[i], synth_unseen_judge(s, x, p->clauses[k], i, NULL));
	}
	for (int k = 0; k < p->except_count; k++) {
		uint64_t out;
		int bad = synth_unseen_resolve(s, x, p->except[k], 0, &out);
		for (int i = 0; i < s->n; i++)
			values[i] = bad ? least(values[i], 0) : out >> i & 1 ? -1 : values[i];
	}
}

/* Leaves the k-th from one end. All must be plainly told apart, and to be seen. */
static void take_ordinal(const struct synth_stand *s, const struct synth_unseen_phrase *p, int *values)
{
	const struct synth_unseen_clause c = {.relation = p->from, .degree = PARSE_MOST};
	int before[SYNTH_MAX_OBJECTS] = {0}, is_clear = 1;

	for (int i = 0; i < s->n; i++) {
		is_clear &= values[i] != 0 && (values[i] < 0 || s->visible >> i & 1);
		for (int j = 0; j < s->n && values[i] > 0; j++) {
			int one = j == i || values[j] < 0 ? -1 : compare_place(s, &c, -1, j, i);
			is_clear &= one != 0;
			before[i] += one > 0;
		}
	}
	for (int i = 0; i < s->n; i++)
		values[i] = !is_clear ? 0 : values[i] > 0 && before[i] == p->ordinal - 1 ? 1 : -1;
}

static int count_of(const int *values, int n, int value)
{
	int count = 0;

	for (int i = 0; i < n; i++)
		count += values[i] == value;
	return count;
}

static void rank(const struct synth_stand *s, const struct synth_unseen *x, int phrase, int *values)
{
	const struct synth_unseen_phrase *p = &x->phrases[phrase];
	int among[SYNTH_MAX_OBJECTS];

	if (p->group && (count_of(values, s->n, 1) != p->group || count_of(values, s->n, 0)))
		for (int i = 0; i < s->n; i++)
			values[i] = 0;
	if (p->ordinal)
		take_ordinal(s, p, values);
	for (int i = 0; i < s->n; i++)
		among[i] = values[i];
	for (int k = 0; k < p->clause_count; k++) {
		const struct synth_unseen_clause *c = &x->clauses[p->clauses[k]];
		struct synth_unseen_clause most = *c;
		int found[2], n = ranks(x, p, k) ? find_anchors(s, x, c, found) : -1;
		most.degree = PARSE_MOST;
		for (int i = 0; i < s->n && ranks(x, p, k); i++) {
			int v = n < 0				 ? 0
				: i == found[0] || values[i] < 0 ? -1
				: c->relation == PARSE_MIDDLE	 ? middle_one(s, i, among)
								 : superlative(s, &most, found[0], i, among);
			values[i] = least(values[i], c->negated ? -v : v);
		}
	}
}

int synth_unseen_resolve(
	const struct synth_stand *s, const struct synth_unseen *x, int p, int may_be_none, uint64_t *objects)
{
	const struct synth_unseen_phrase *phrase = &x->phrases[p];
	int values[SYNTH_MAX_OBJECTS], n = 0, wanted = phrase->count;

	*objects = 0;
	judge_phrase(s, x, p, values);
	rank(s, x, p, values);
	for (int i = 0; i < s->n; i++) {
		if (!values[i])
			return -1;
		n += values[i] > 0;
		*objects |= (uint64_t)(values[i] > 0) << i;
	}
	for (int k = 0; k < phrase->also_count; k++) {
		uint64_t more;
		if (synth_unseen_resolve(s, x, phrase->also[k], 0, &more) || (more & *objects))
			return -1;
		*objects |= more;
	}
	if (!n && may_be_none)
		return 0;
	return wanted > 0 ? (n == wanted ? 0 : -1) : n >= 2 ? 0 : -1;
}
