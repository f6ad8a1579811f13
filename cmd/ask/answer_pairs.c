/* Answers about two things: how far apart they are, and which is larger, nearer, higher. */
#include "cmd/ask/answering.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

/* Two answers as one. */
struct pair {
	struct asking_answer of[2];
	int count; /* of the answers: 1 where the first means both things */
	size_t ends[2];
	double probability; /* 0: they are not two things */
};

static void pair_free(struct pair *p)
{
	for (int k = 0; k < p->count; k++)
		asking_answer_free(&p->of[k]);
	p->count = 0;
}

static int ask_pair(struct asking *a, const struct question_asked *q, struct pair *p, const struct report *to,
	struct err *e)
{
	*p = (struct pair){0};
	for (int k = 0; k < 2 && *q->text[k]; k++) {
		p->count++;
		if (asking_ask(a, q->text[k], 0, &p->of[k], to, e))
			return -1;
	}
	for (int k = 0; k < 2; k++) {
		const struct asking_answer *of = &p->of[p->count == 2 ? k : 0];
		const size_t which = p->count == 2 ? 0 : (size_t)k;
		p->ends[k] = which < of->count ? of->things[which] : ASKING_NONE;
	}
	const int is_two = p->ends[0] != p->ends[1] && p->ends[0] != ASKING_NONE &&
			   p->ends[1] != ASKING_NONE && (p->count == 2 || p->of[0].count == 2);
	if (is_two)
		p->probability =
			p->of[0].probability[p->ends[0]] * p->of[p->count - 1].probability[p->ends[1]];
	return 0;
}

/* Why there are no two things, in words that end a sentence. */
static void say_why(const struct pair *p, const struct question_asked *q, const struct asking *a,
	char reason[EXPLAIN_REASON])
{
	const char *what =
		q->kind == QUESTION_DISTANCE ? "a distance is between two things" : "two things are compared";

	for (int k = 0; k < p->count; k++)
		if (!p->of[k].count) {
			snprintf(reason, EXPLAIN_REASON, "%.120s: %.120s", q->text[k], p->of[k].reason);
			return;
		}
	if (p->count == 2)
		snprintf(reason, EXPLAIN_REASON, "%s, and both are %.120s", what,
			a->model.lifted.names[p->ends[0]]);
	else
		snprintf(reason, EXPLAIN_REASON, "%s, and '%.120s' means %zu", what, q->text[0],
			p->of[0].count);
}

/* The pair as the answer, which takes over what the first of them has. */
static int take_pair(struct asking_answer *answer, const struct pair *p, const struct question_asked *q,
	const struct asking *a, struct err *e)
{
	if (asking_answer_make(answer, a->model.lifted.objects, e))
		return -1;
	memcpy(answer->centres, p->of[0].centres, a->model.lifted.objects * sizeof *answer->centres);
	answer->places = p->of[0].places;
	answer->there = p->probability;
	answer->is_guess = p->of[0].is_guess || p->of[p->count - 1].is_guess;
	if (!(p->probability > 0)) {
		say_why(p, q, a, answer->reason);
		return 0;
	}
	for (int k = 0; k < 2 && p->count == 2; k++)
		if (answering_is_unsure(&p->of[k])) {
			answer->unclear[0] = p->ends[k];
			answer->unclear[1] = p->of[k].runner_up;
			answer->probability[p->of[k].runner_up] = p->of[k].probability[p->of[k].runner_up];
		}
	for (int k = 0; k < 2; k++) {
		answer->things[k] = p->ends[k];
		answer->probability[p->ends[k]] = p->of[p->count == 2 ? k : 0].probability[p->ends[k]];
	}
	answer->count = 2;
	return 0;
}

/* The two things of a question, of the ways to read it by the one in which both are likeliest. */
static int find_pair(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	struct question_asked q, chosen = t->asked;
	struct pair best = {0};
	int bad = 0;

	for (int i = 0; i < QUESTION_WAYS && !bad && question_read(&q, t->understood, i); i++) {
		struct pair p;
		bad = ask_pair(a, &q, &p, to, e);
		if (bad || (i && p.probability <= best.probability)) {
			pair_free(&p);
			continue;
		}
		pair_free(&best);
		best = p;
		chosen = q;
	}
	if (!bad)
		bad = take_pair(found, &best, &chosen, a, e);
	pair_free(&best);
	return bad ? -1 : 0;
}

static const struct box *box_of(const struct answer_told *t, size_t object)
{
	return &t->asking->model.extents[object].turned;
}

void answering_measure_distance(struct answer_told *t)
{
	const struct box *x = box_of(t, t->answer->things[0]), *y = box_of(t, t->answer->things[1]);

	t->distance.gap = box_gap(x, y);
	t->distance.centres = hypot(
		hypot(x->centre[0] - y->centre[0], x->centre[1] - y->centre[1]), x->centre[2] - y->centre[2]);
}

/* By what two things are compared: the more of it, the more so. *kind becomes that of a length, else
 * QUESTION_WHICH. */
static double compared_by(const struct answer_told *t, size_t object, size_t anchor, enum question_kind *kind)
{
	const double *centre = t->answer->centres[object];
	const int relation = t->asked.relation;
	const int is_less = relation == PARSE_SMALLER || relation == PARSE_SHORTER ||
			    relation == PARSE_BELOW || relation == PARSE_LEFT || relation == PARSE_FRONT ||
			    relation == PARSE_NEAR;
	double x = centre[relation == PARSE_LEFT || relation == PARSE_RIGHT ? 0 : 1];

	*kind = QUESTION_WHICH;
	if (anchor != ASKING_NONE)
		return (is_less ? -1 : 1) * box_gap(box_of(t, object), box_of(t, anchor));
	if (relation == PARSE_LARGER || relation == PARSE_SMALLER)
		*kind = QUESTION_SIZE;
	else if (relation == PARSE_TALLER || relation == PARSE_SHORTER)
		*kind = QUESTION_HEIGHT;
	else if (relation == PARSE_LONGER || relation == PARSE_WIDER)
		*kind = QUESTION_WIDTH;
	else if (relation == PARSE_ABOVE || relation == PARSE_BELOW)
		x = centre[2];
	if (*kind != QUESTION_WHICH)
		x = answering_length(t, object, *kind);
	return is_less ? -x : x;
}

/* The winner of two comes first, and stays alone. Nearer to what, where the question says it, is anchor. */
static void compare(struct answer_told *t, struct asking_answer *found, size_t anchor)
{
	char text[LENGTH_TEXT];
	enum question_kind kind;
	const double x = compared_by(t, found->things[0], anchor, &kind),
		     y = compared_by(t, found->things[1], anchor, &kind);
	const int is_second = y > x;
	const size_t loser = found->things[!is_second];

	t->is_yes = !is_second;
	found->things[0] = found->things[is_second];
	found->count = 1;
	found->runner_up = loser;
	answering_say(t, "by %s", answer_length(t->asking, fabs(x - y), text));
	if (kind != QUESTION_WHICH)
		answering_say(t, ", %.2g times the %s of %s", fabs(is_second ? y / x : x / y),
			answering_length_name(kind), t->asking->model.lifted.names[loser]);
}

/* "Which of the mugs and jugs is the tallest?": of all that there are the two that are it most, in place of
 * one of each. */
static int find_most(struct answer_told *t, struct asking_answer *found, struct asking *a, size_t anchor,
	const struct report *to, struct err *e)
{
	enum question_kind kind;

	for (int k = 0; k < 2; k++) {
		SCOPED_BY(asking_answer_free) struct asking_answer group = {0};
		if (asking_ask(a, t->asked.text[k], 0, &group, to, e))
			return -1;
		for (size_t i = 0; i < group.count; i++) {
			const size_t o = group.things[i];
			const double x = compared_by(t, o, anchor, &kind);
			if (o == found->things[0] || o == found->things[1] || !a->model.extents[o].n)
				continue;
			found->probability[o] = group.probability[o];
			const int less = compared_by(t, found->things[1], anchor, &kind) <
					 compared_by(t, found->things[0], anchor, &kind);
			if (x > compared_by(t, found->things[less], anchor, &kind))
				found->things[less] = o;
		}
	}
	return 0;
}

static int answer_compared(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer anchor = {0};

	if (*t->asked.text[2] && asking_ask(a, t->asked.text[2], 0, &anchor, to, e))
		return -1;
	if (*t->asked.text[2] && !anchor.count) {
		found->count = 0;
		memcpy(found->reason, anchor.reason, sizeof found->reason);
		return 0;
	}
	const size_t nearest = anchor.count ? anchor.things[0] : ASKING_NONE;
	if (t->asked.most && find_most(t, found, a, nearest, to, e))
		return -1;
	compare(t, found, nearest);
	/* "which are taller, the mugs or the jugs?": all of these */
	const char *won = t->asked.text[!t->is_yes];
	if (t->asked.kind != QUESTION_COMPARE || !*won || anchor.count || t->asked.most)
		return 0;
	SCOPED_BY(asking_answer_free) struct asking_answer all = {0};
	if (asking_ask(a, won, 0, &all, to, e))
		return -1;
	if (all.count > 1) {
		memcpy(found->things, all.things, all.count * sizeof *all.things);
		for (size_t k = 0; k < all.count; k++)
			found->probability[all.things[k]] = all.probability[all.things[k]];
		found->count = all.count;
	}
	return 0;
}

int answering_pair(struct answer_told *t, struct asking_answer *found, struct asking *a, int is_compared,
	const struct report *to, struct err *e)
{
	if (find_pair(t, found, a, to, e))
		return -1;
	answering_need_boxes(t, found);
	return is_compared && found->count ? answer_compared(t, found, a, to, e) : 0;
}

/* Whether a word of size or place is one that two things are compared by. */
int answering_is_comparable(int relation)
{
	static const unsigned by = 1U << PARSE_LEFT | 1U << PARSE_RIGHT | 1U << PARSE_FRONT |
				   1U << PARSE_BEHIND | 1U << PARSE_ABOVE | 1U << PARSE_BELOW |
				   1U << PARSE_NEAR | 1U << PARSE_FAR | 1U << PARSE_LARGER |
				   1U << PARSE_SMALLER | 1U << PARSE_TALLER | 1U << PARSE_SHORTER |
				   1U << PARSE_LONGER | 1U << PARSE_WIDER;

	return relation >= 0 && (by >> relation & 1);
}

size_t answering_nearest(const struct asking *a, size_t object, double *distance)
{
	size_t nearest = ASKING_NONE;

	for (size_t o = 0; o < a->model.lifted.objects; o++) {
		const double *x = a->model.extents[object].turned.centre,
			     *y = a->model.extents[o].turned.centre;
		const double d = hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
		if (o == object || !a->model.extents[o].n || !a->model.extents[object].n ||
			(nearest != ASKING_NONE && d >= *distance))
			continue;
		nearest = o;
		*distance = d;
	}
	return nearest;
}

const char *answering_side(const double centre[3], const double other[3])
{
	static const char *const sides[3][2] = {
		{"to the left of", "to the right of"}, {"in front of", "behind"}, {"below", "above"}};
	int axis = 0;

	for (int k = 1; k < 3; k++)
		axis = fabs(centre[k] - other[k]) > fabs(centre[axis] - other[axis]) ? k : axis;
	return sides[axis][centre[axis] > other[axis]];
}
