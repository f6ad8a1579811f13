/* Directions are judged on the table, strictly also by bearing and distance from who looks; sizes both by
 * bulk and by the longest extent. Units: a medium mug is 0.62 high. */
#include "base/largest.h"
#include "synth/relations.h"

#include "synth/cameras.h"

#include <math.h>

/* What is plainly true, and in `not_` what is plainly false. Second measures only count strictly. */
static const struct {
	double aside, not_ahead, not_aside;	   /* how far ahead, in units; over how far aside */
	double near, not_near;			   /* the gap, in units */
	double off, not_off, not_between;	   /* of the way from one to the other */
	double side, not_side, middle, not_middle; /* of half the table */
} margins[2] = {{1.1, 0.1, 2.5, 0.4, 0.8, 0.2, 0.45, 0.05, 0.3, 0.1, 0.35, 0.55},
	{1, 0.05, 4, 0.35, 0.9, 0.18, 0.5, 0.02, 0.35, 0.05, 0.3, 0.6}};
static const double ahead_margin = 0.3, rank_margin = 0.25, size_margin = 1.12, bearing_margin = 0.02,
		    range_margin = 0.1;

void synth_viewpoint_make(struct synth_viewpoint *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const double centre[3], const double right[2], const double away[2],
	int is_strict)
{
	double cu = right[0] * centre[0] + right[1] * centre[1];
	double cv = away[0] * centre[0] + away[1] * centre[1];

	*s = (struct synth_viewpoint){
		.n = n, .objects = objects, .visible = ~(uint64_t)0, .is_strict = is_strict};
	for (int i = 0; i < n; i++) {
		s->u[i] = right[0] * objects[i].x + right[1] * objects[i].y;
		s->v[i] = away[0] * objects[i].x + away[1] * objects[i].y;
		s->bearing[i] = atan2(s->u[i] - cu, s->v[i] - cv);
		s->range[i] = hypot(s->u[i] - cu, s->v[i] - cv);
	}
	s->half_u = fabs(right[0]) * table->half_width + fabs(right[1]) * table->half_depth;
	s->half_v = fabs(away[0]) * table->half_width + fabs(away[1]) * table->half_depth;
}

void synth_viewpoint_reference(struct synth_viewpoint *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, int is_strict)
{
	double centre[3], right[2], away[2];

	synth_cameras_reference(cameras, centre, right, away);
	synth_viewpoint_make(s, objects, n, table, centre, right, away, is_strict);
}

static int verdict(int is_true, int is_false)
{
	return is_true ? 1 : is_false ? -1 : 0;
}

static double distance(const struct synth_viewpoint *s, int i, int j)
{
	return hypot(s->u[i] - s->u[j], s->v[i] - s->v[j]);
}

static int stands_on(const struct synth_object *objects, int i, int a)
{
	for (i = objects[i].on; i >= 0; i = objects[i].on)
		if (i == a)
			return 1;
	return 0;
}

static int are_stacked(const struct synth_viewpoint *s, int i, int j)
{
	return stands_on(s->objects, i, j) || stands_on(s->objects, j, i);
}

/* What stands on a thing is hardly "beside" it, but who is to say. */
static int unless_stacked(const struct synth_viewpoint *s, int i, int j, int v)
{
	return v > 0 && are_stacked(s, i, j) ? 0 : v;
}

static int is_sideways(enum parse_relation r)
{
	return r == PARSE_LEFT || r == PARSE_RIGHT;
}

/* How far i lies from a in the direction of the relation, on the table and in the second measure. */
static void lead(
	const struct synth_viewpoint *s, enum parse_relation r, int i, int a, double *first, double *second)
{
	double sign = r == PARSE_LEFT || r == PARSE_FRONT ? -1 : 1;
	const double *x = is_sideways(r) ? s->u : s->v, *y = is_sideways(r) ? s->bearing : s->range;

	*first = sign * (x[i] - x[a]);
	*second = sign * (y[i] - y[a]);
}

static int towards(const struct synth_viewpoint *s, enum parse_relation r, int i, int a)
{
	double aside = fabs(is_sideways(r) ? s->v[i] - s->v[a] : s->u[i] - s->u[a]), ahead, second;
	double least_second = is_sideways(r) ? bearing_margin : range_margin;
	int k = s->is_strict;

	lead(s, r, i, a, &ahead, &second);
	int v = verdict(
		ahead > ahead_margin && ahead > margins[k].aside * aside && (!k || second > least_second),
		(ahead < margins[k].not_ahead && (!k || second < least_second / 2)) ||
			aside > margins[k].not_aside * ahead);
	return unless_stacked(s, i, a, v);
}

static int between(const struct synth_viewpoint *s, int i, int a, int b)
{
	double du = s->u[b] - s->u[a], dv = s->v[b] - s->v[a], length = hypot(du, dv);
	double pu = s->u[i] - s->u[a], pv = s->v[i] - s->v[a];
	int k = s->is_strict;

	if (length < 0.3)
		return 0;
	double along = (pu * du + pv * dv) / (length * length);
	double off = fabs(pu * dv - pv * du) / (length * length);
	int v = verdict(along > 0.25 && along < 0.75 && off < margins[k].off,
		along < margins[k].not_between || along > 1 - margins[k].not_between ||
			off > margins[k].not_off);
	return unless_stacked(s, i, a, unless_stacked(s, i, b, v));
}

/* The place of an object in the scene: "on the left", "in the middle". */
static int side(const struct synth_viewpoint *s, enum parse_relation r, int i)
{
	double u = s->u[i] / s->half_u, v = s->v[i] / s->half_v;
	int k = s->is_strict;

	if (r == PARSE_ON) /* the table, and no other object */
		return verdict(s->objects[i].on < 0, 1);
	if (r == PARSE_MIDDLE)
		return verdict(hypot(u, v) < margins[k].middle, hypot(u, v) > margins[k].not_middle);
	double x = r == PARSE_LEFT ? -u : r == PARSE_RIGHT ? u : r == PARSE_FRONT ? -v : v;
	return verdict(x > margins[k].side, x < margins[k].not_side);
}

/* 1 where i is plainly more than j of what the relation names, -1 where plainly less. */
static int compare_size(const struct synth_viewpoint *s, enum parse_relation r, int i, int j)
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

/* The same for where things are. What is on or under a thing has no distance from it to compare. */
static int compare_place(const struct synth_viewpoint *s, const struct synth_relation *r, int i, int j)
{
	double first, second, least_second = rank_margin;
	int sign = r->relation == PARSE_FAR ? 1 : -1, k = s->is_strict;

	if (r->relation != PARSE_NEAR && r->relation != PARSE_FAR) {
		lead(s, r->relation, i, j, &first, &second);
		least_second = is_sideways(r->relation) ? bearing_margin : rank_margin;
	} else if (r->a < 0) {
		first = sign * (s->v[i] - s->v[j]);
		second = sign * (s->range[i] - s->range[j]);
	} else {
		if ((k || r->relation == PARSE_NEAR) && (are_stacked(s, i, r->a) || are_stacked(s, j, r->a)))
			return 0;
		first = sign * (distance(s, i, r->a) - distance(s, j, r->a));
		second = first - sign * (s->objects[i].radius - s->objects[j].radius);
		least_second = range_margin;
	}
	return verdict(first > rank_margin && (!k || second > least_second),
		first < -rank_margin && (!k || second < -least_second));
}

int synth_relation_compare(const struct synth_viewpoint *s, enum parse_relation direction, int i, int j)
{
	const struct synth_relation r = {direction, PARSE_MOST, -1, -1};

	return compare_place(s, &r, i, j);
}

int synth_relation_is_size(enum parse_relation r)
{
	return r >= PARSE_LARGER && r <= PARSE_WIDER;
}

/* The most, or of two the more. "Farthest to the left" where nothing else is spoken of is so among all
 * things, and should not stand on the right. */
static int superlative(
	const struct synth_viewpoint *s, const struct synth_relation *r, int i, const int *among)
{
	int v = 1, rivals = 0, is_size = synth_relation_is_size(r->relation);

	for (int j = 0; j < s->n; j++) {
		if (j == i || j == r->a || (among && among[j] < 0))
			continue;
		int one = is_size ? compare_size(s, r->relation, i, j) : compare_place(s, r, i, j);
		/* Less than what may not be among them proves nothing. */
		v = least_of(v, among && among[j] == 0 && one < 0 ? 0 : one);
		rivals += !among || among[j] > 0;
	}
	if (!rivals && !s->is_strict && r->degree == PARSE_MOST && !is_size && among)
		return superlative(s, r, i, NULL);
	if (rivals && v > 0 && !s->is_strict && r->degree == PARSE_MOST && is_sideways(r->relation) &&
		(r->relation == PARSE_LEFT ? -s->u[i] : s->u[i]) < 0.1 * s->half_u)
		return 0;
	return rivals ? v : 0;
}

static int middle_one(const struct synth_viewpoint *s, int i, const int *among)
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

static int judge_place(const struct synth_viewpoint *s, const struct synth_relation *r, int i)
{
	double gap = distance(s, i, r->a) - s->objects[i].radius - s->objects[r->a].radius;

	switch (r->relation) {
	case PARSE_LEFT:
	case PARSE_RIGHT:
	case PARSE_FRONT:
	case PARSE_BEHIND:
		return towards(s, r->relation, i, r->a);
	case PARSE_NEAR:
		return unless_stacked(s, i, r->a,
			verdict(gap<margins[s->is_strict].near, gap> margins[s->is_strict].not_near));
	case PARSE_BETWEEN:
		return r->b < 0 ? 0 : between(s, i, r->a, r->b);
	case PARSE_ON:
		return verdict(s->objects[i].on == r->a, !stands_on(s->objects, i, r->a));
	case PARSE_BELOW:
	case PARSE_SUPPORTS:
		return verdict(s->objects[r->a].on == i, !stands_on(s->objects, r->a, i));
	default:
		return 0;
	}
}

int synth_relation_judge(
	const struct synth_viewpoint *s, const struct synth_relation *r, int i, const int *among)
{
	if (i == r->a || i == r->b)
		return -1;
	if (synth_relation_is_size(r->relation) && r->a >= 0)
		return compare_size(s, r->relation, i, r->a);
	if (r->degree != PARSE_PLAIN)
		return r->relation == PARSE_MIDDLE ? middle_one(s, i, among) : superlative(s, r, i, among);
	return r->a >= 0 ? judge_place(s, r, i) : side(s, r->relation, i);
}
