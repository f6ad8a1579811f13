/* Answers by the kind of question (lang/question_kinds.h). */
#include "cmd/ask/reply.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

/* The less likely of two that are as likely, against the other. */
static const double as_likely = 0.6;
/* A part of a question that holds of a thing, rather than not. */
static const double holds = 0.5;
/* What one thing means rather than several that fit. */
static const double sure = 0.5;

__attribute__((format(printf, 2, 3))) static void say(struct answer_told *t, const char *format, ...)
{
	const size_t n = strlen(t->value);
	va_list args;

	va_start(args, format);
	vsnprintf(t->value + n, sizeof t->value - n, format, args);
	va_end(args);
}

static void say_number(struct answer_told *t, size_t n)
{
	static const char *const words[] = {"none", "one", "two", "three", "four", "five", "six", "seven",
		"eight", "nine", "ten", "eleven", "twelve"};

	if (n < sizeof words / sizeof *words)
		say(t, "%s", words[n]);
	else
		say(t, "%zu", n);
}

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
		if (asking_ask(a, q->text[k], &p->of[k], to, e))
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
	if (!(p->probability > 0)) {
		say_why(p, q, a, answer->reason);
		return 0;
	}
	for (int k = 0; k < 2; k++) {
		answer->things[k] = p->ends[k];
		answer->probability[p->ends[k]] = p->of[p->count == 2 ? k : 0].probability[p->ends[k]];
	}
	answer->count = 2;
	return 0;
}

/* The two things of a question, of the ways to read it by the one in which both are likeliest. */
static int answer_pair(struct answer_told *t, struct asking_answer *found, struct asking *a,
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

static void measure_distance(struct answer_told *t)
{
	const struct box *x = box_of(t, t->answer->things[0]), *y = box_of(t, t->answer->things[1]);

	t->distance.gap = box_gap(x, y);
	t->distance.centres = hypot(
		hypot(x->centre[0] - y->centre[0], x->centre[1] - y->centre[1]), x->centre[2] - y->centre[2]);
}

/* The length that a kind of question is about: the height of a box, its longer side, or their mean. */
static double length_of(const struct answer_told *t, size_t object, enum question_kind kind)
{
	const double *half = box_of(t, object)->half;

	if (kind == QUESTION_HEIGHT)
		return 2 * half[2];
	return 2 * (kind == QUESTION_WIDTH ? fmax(half[0], half[1]) : cbrt(half[0] * half[1] * half[2]));
}

static const char *length_name(enum question_kind kind)
{
	return kind == QUESTION_HEIGHT ? "height" : kind == QUESTION_WIDTH ? "width" : "size";
}

/* How large the thing is, and beside the other thing that is most like it in that. */
static void say_size(struct answer_told *t)
{
	const struct asking *a = t->asking;
	const size_t thing = t->answer->things[0];
	const double own = length_of(t, thing, t->asked.kind), *half = box_of(t, thing)->half;
	char text[3][LENGTH_TEXT];
	size_t like = ASKING_NONE;
	double least = INFINITY;

	for (size_t o = 0; o < a->model.lifted.objects; o++) {
		const double off = fabs(log(length_of(t, o, t->asked.kind) / own));
		if (o != thing && a->model.extents[o].n && off < least) {
			like = o;
			least = off;
		}
	}
	if (t->asked.kind == QUESTION_SIZE)
		say(t, "%s x %s x %s high", answer_length(a, 2 * half[0], text[0]),
			answer_length(a, 2 * half[1], text[1]), answer_length(a, 2 * half[2], text[2]));
	else
		say(t, "%s %s", answer_length(a, own, text[0]),
			t->asked.kind == QUESTION_HEIGHT ? "high" : "wide");
	if (like != ASKING_NONE)
		say(t, ", %.2g times the %s of %s", own / length_of(t, like, t->asked.kind),
			length_name(t->asked.kind), a->model.lifted.names[like]);
}

/* By what two things are compared: the more of it, the more so. *kind becomes that of a length, else
 * QUESTION_WHICH. */
static double compared_by(const struct answer_told *t, size_t object, enum question_kind *kind)
{
	const double *centre = t->answer->centres[object];
	const int relation = t->asked.relation;
	const int is_less = relation == PARSE_SMALLER || relation == PARSE_SHORTER ||
			    relation == PARSE_BELOW || relation == PARSE_LEFT || relation == PARSE_FRONT ||
			    relation == PARSE_NEAR;
	double x = centre[relation == PARSE_LEFT || relation == PARSE_RIGHT ? 0 : 1];

	*kind = QUESTION_WHICH;
	if (relation == PARSE_LARGER || relation == PARSE_SMALLER)
		*kind = QUESTION_SIZE;
	else if (relation == PARSE_TALLER || relation == PARSE_SHORTER)
		*kind = QUESTION_HEIGHT;
	else if (relation == PARSE_LONGER || relation == PARSE_WIDER)
		*kind = QUESTION_WIDTH;
	else if (relation == PARSE_ABOVE || relation == PARSE_BELOW)
		x = centre[2];
	if (*kind != QUESTION_WHICH)
		x = length_of(t, object, *kind);
	return is_less ? -x : x;
}

/* The winner of two comes first, and stays alone. */
static void compare(struct answer_told *t, struct asking_answer *found)
{
	char text[LENGTH_TEXT];
	enum question_kind kind;
	const double x = compared_by(t, found->things[0], &kind), y = compared_by(t, found->things[1], &kind);
	const int is_second = y > x;
	const size_t loser = found->things[!is_second];

	found->things[0] = found->things[is_second];
	found->count = 1;
	found->runner_up = loser;
	if (kind == QUESTION_WHICH)
		say(t, "by %s", answer_length(t->asking, fabs(x - y), text));
	else
		say(t, "%.2g times the %s of %s", fabs(is_second ? y / x : x / y), length_name(kind),
			t->asking->model.lifted.names[loser]);
}

/* Everything that was lifted, whatever the question's words mean: they tell only from where it is asked. */
static int list(struct answer_told *t, struct asking_answer *found, struct asking *a, const struct report *to,
	struct err *e)
{
	if (asking_ask(a, t->understood, found, to, e))
		return -1;
	found->count = 0;
	found->runner_up = ASKING_NONE;
	for (size_t o = 0; o < a->model.lifted.objects; o++) {
		found->probability[o] = a->model.extents[o].n > 0;
		if (a->model.extents[o].n)
			found->things[found->count++] = o;
	}
	found->there = found->count > 0;
	snprintf(found->reason, sizeof found->reason, "the model has no objects");
	say_number(t, found->count);
	say(t, " thing%s", found->count == 1 ? "" : "s");
	return 0;
}

/* Whether a word of size or place is one that two things are compared by. */
static int is_comparable(int relation)
{
	static const unsigned by = 1U << PARSE_LEFT | 1U << PARSE_RIGHT | 1U << PARSE_FRONT |
				   1U << PARSE_BEHIND | 1U << PARSE_ABOVE | 1U << PARSE_BELOW |
				   1U << PARSE_NEAR | 1U << PARSE_FAR | 1U << PARSE_LARGER |
				   1U << PARSE_SMALLER | 1U << PARSE_TALLER | 1U << PARSE_SHORTER |
				   1U << PARSE_LONGER | 1U << PARSE_WIDER;

	return relation >= 0 && (by >> relation & 1);
}

/* Nothing is measured of a thing that has no Gaussians. */
static void need_boxes(const struct answer_told *t, struct asking_answer *found)
{
	for (size_t k = 0; k < found->count; k++)
		if (!t->asking->model.extents[found->things[k]].n) {
			snprintf(found->reason, sizeof found->reason, "nothing is seen of %.200s",
				t->asking->model.lifted.names[found->things[k]]);
			found->count = 0;
		}
}

/* Whether the first thing, which is there, is what the second question says. */
static int answer_whether(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer first = {0};

	if (asking_ask(a, t->asked.text[0], &first, to, e) || asking_ask(a, t->asked.text[1], found, to, e))
		return -1;
	const size_t thing = first.count ? first.things[0] : ASKING_NONE;
	size_t at = 0;
	while (at < found->count && found->things[at] != thing)
		at++;
	t->is_yes = first.count && at < found->count && found->holds[thing] >= holds;
	if (t->is_yes || !first.count) {
		snprintf(found->reason, sizeof found->reason, "%s", first.count ? "" : first.reason);
		found->count = first.count ? found->count : 0;
		return 0;
	}
	if (found->count)
		snprintf(found->reason, sizeof found->reason, "that is %.200s",
			a->model.lifted.names[found->things[0]]);
	const struct asking_answer second = *found;
	*found = first;
	memcpy(found->reason, second.reason, sizeof found->reason);
	first = second;
	return 0;
}

/* What stands in a relation, where no one thing is likely to be meant alone. */
static int answer_set(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer all = {0};

	if (asking_ask(a, t->asked.text[0], found, to, e))
		return -1;
	if (found->count != 1 || found->probability[found->things[0]] >= sure)
		return 0;
	if (asking_ask(a, t->asked.text[1], &all, to, e))
		return -1;
	if (!all.count)
		return 0;
	const struct asking_answer one = *found;
	*found = all;
	all = one;
	return 0;
}

/* Whether the one thing of an answer is no more likely than not, or another is nearly as likely. */
static int is_unsure(const struct asking_answer *a)
{
	const double p = a->count == 1 ? a->probability[a->things[0]] : 1;

	return a->count == 1 && a->runner_up != ASKING_NONE && !a->is_by_purpose && a->there >= sure &&
	       (p < sure || a->probability[a->runner_up] >= as_likely * p);
}

int kinds_answer(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	if (t->asked.kind == QUESTION_COMPARE && !is_comparable(t->asked.relation)) {
		t->asked = (struct question_asked){.relation = -1};
		memcpy(t->asked.text[0], t->understood, sizeof t->asked.text[0]);
	}
	const enum question_kind kind = t->asked.kind;
	const int is_pair = kind == QUESTION_DISTANCE || kind == QUESTION_COMPARE;

	if (kind == QUESTION_LIST)
		return list(t, found, a, to, e);
	const int bad = is_pair			   ? answer_pair(t, found, a, to, e)
			: kind == QUESTION_WHETHER ? answer_whether(t, found, a, to, e)
			: kind == QUESTION_SET	   ? answer_set(t, found, a, to, e)
						   : asking_ask(a, t->asked.text[0], found, to, e);
	if (bad)
		return -1;
	if (kind == QUESTION_THERE)
		t->is_yes = found->count > 0;
	if (kind == QUESTION_NUMBER)
		say_number(t, found->count);
	if (is_pair || (kind >= QUESTION_HEIGHT && kind <= QUESTION_SIZE))
		need_boxes(t, found);
	if (!found->count)
		return 0;
	if (kind == QUESTION_DISTANCE)
		measure_distance(t);
	else if (kind == QUESTION_COMPARE)
		compare(t, found);
	else if (kind == QUESTION_COLOUR || kind == QUESTION_LOOK)
		answer_looks(t, kind == QUESTION_COLOUR, t->value, sizeof t->value);
	else if (kind >= QUESTION_HEIGHT && kind <= QUESTION_SIZE)
		say_size(t);
	else if (kind != QUESTION_NUMBER && kind != QUESTION_THERE && kind != QUESTION_WHETHER)
		t->is_unsure = is_unsure(found);
	return 0;
}
