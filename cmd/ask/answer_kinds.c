/* Answers by the kind of question (lang/question_kinds.h). */
#include "cmd/ask/answering.h"

#include "base/mem.h"
#include "lang/colours.h"

#include <math.h>
#include <string.h>

/* The less likely of two that are as likely, against the other. */
static const double as_likely = 0.6;
/* A part of a question that holds of a thing, rather than not. */
static const double holds = 0.5;
/* The same of what is counted or there: what stands on another thing is on the table, if not directly. */
static const double nearly_holds = 0.45;
/* The same of what touches, or hardly does. */
static const double is_at = 0.35;
/* The same by what sentences say, where what it is told by is nothing here. */
static const double is_said = 0.6;
/* One thing rather than another, and rather than all that fit. */
static const double sure = 0.5, sure_alone = 0.9;

void answering_say(struct answer_told *t, const char *format, ...)
{
	const size_t n = strlen(t->value);
	va_list args;

	va_start(args, format);
	vsnprintf(t->value + n, sizeof t->value - n, format, args);
	va_end(args);
}

/* Whether the one thing of an answer is no more likely than not, or another is nearly as likely. */
int answering_is_unsure(const struct asking_answer *a)
{
	const double p = a->count == 1 ? a->probability[a->things[0]] : 1;

	return a->count == 1 && a->runner_up != ASKING_NONE && !a->is_by_purpose && a->there >= sure &&
	       (p < sure || a->probability[a->runner_up] >= as_likely * p);
}

void answering_say_number(struct answer_told *t, size_t n)
{
	static const char *const words[] = {"none", "one", "two", "three", "four", "five", "six", "seven",
		"eight", "nine", "ten", "eleven", "twelve"};

	if (n < sizeof words / sizeof *words)
		answering_say(t, "%s", words[n]);
	else
		answering_say(t, "%zu", n);
}

/* Which of two the first thing is. */
static int answer_either(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer first = {0};
	SCOPED_BY(asking_answer_free) struct asking_answer second = {0};
	static const char is[] = " that is ";

	if (asking_ask(a, t->asked.text[0], 0, found, to, e) ||
		asking_ask(a, t->asked.text[1], 0, &first, to, e) ||
		asking_ask(a, t->asked.text[2], 0, &second, to, e))
		return -1;
	if (!found->count)
		return 0;
	const size_t thing = found->things[0];
	const char *said = t->asked.text[1 + (second.holds[thing] > first.holds[thing])];
	const char *word = strstr(said + strlen(t->asked.text[0]), is);
	answering_say(t, "%s", word ? word + strlen(is) : said);
	return 0;
}

/* Everything that was lifted, whatever the question's words mean: they tell only from where it is asked. */
static int list(struct answer_told *t, struct asking_answer *found, struct asking *a, const struct report *to,
	struct err *e)
{
	if (asking_ask(a, t->understood, 0, found, to, e))
		return -1;
	found->is_guess = 0;
	found->count = 0;
	found->runner_up = ASKING_NONE;
	for (size_t o = 0; o < a->model.lifted.objects; o++) {
		found->probability[o] = a->model.extents[o].n > 0;
		if (a->model.extents[o].n)
			found->things[found->count++] = o;
	}
	found->there = found->count > 0;
	snprintf(found->reason, sizeof found->reason, "the model has no objects");
	answering_say_number(t, found->count);
	answering_say(t, " thing%s", found->count == 1 ? "" : "s");
	return 0;
}

/* Whether an object is one of an answer's, and all that the question says holds of it. */
static int is_of(const struct asking_answer *a, size_t object)
{
	size_t k = 0;

	while (k < a->count && a->things[k] != object)
		k++;
	return k < a->count && a->holds[object] >= holds;
}

static const char unknown_place[] = "nothing here is known as what it names";

/* Nothing is at a thing that is not here, unless sentences say so of the thing. */
static int is_at_nothing(const struct asking_answer *a, size_t thing)
{
	return a->is_anchor_unknown && a->holds[thing] < is_said;
}

static void drop_at_nothing(const struct answer_told *t, struct asking_answer *found)
{
	if (found->count ? !is_at_nothing(found, found->things[0]) : !found->is_anchor_unknown)
		return;
	if (found->count && t->asked.kind == QUESTION_SET && t->asking->options->is_always) {
		found->is_guess = 1;
		return;
	}
	snprintf(found->reason, sizeof found->reason, "%s", unknown_place);
	found->count = 0;
}

/* Only what the question surely holds of, if anything: "is anything on the box?" asks that. */
static void keep_holding(struct asking_answer *a, int is_number, const char *phrase)
{
	const double least = strstr(phrase, "directly") || strstr(phrase, "itself") ? holds : nearly_holds;
	size_t n = 0;

	for (size_t k = 0; k < a->count; k++)
		if (a->holds[a->things[k]] >= least || a->is_by_purpose)
			a->things[n++] = a->things[k];
	a->count = n || !is_number ? n : a->count;
}

int answering_all(const struct answer_told *t, const char *phrase, struct asking_answer *found,
	struct asking *a, const struct report *to, struct err *e)
{
	if (asking_ask(a, phrase, 1, found, to, e))
		return -1;
	keep_holding(found, 1, phrase);
	drop_at_nothing(t, found);
	return 0;
}

/* Whether the first things, which are there, are what the second question says; whether any is, of "any", "a
 * mug" and "one of the mugs". */
static int answer_whether(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer second = {0};

	if (question_is_any(t->asked.text[0])) {
		static const char one_of[] = "one of ";
		const char *text = t->asked.text[1];
		t->asked.kind = QUESTION_THERE;
		t->asked.least = 0;
		return asking_ask(a, text + (strncmp(text, one_of, strlen(one_of)) ? 0 : strlen(one_of)), 1,
			found, to, e);
	}
	if (asking_ask(a, t->asked.text[0], 0, found, to, e) ||
		asking_ask(a, t->asked.text[1], 1, &second, to, e))
		return -1;
	if (!found->count)
		return 0;
	size_t k = 0;
	const enum answer_look look = answer_look(t, found->things[0]);
	if (look == LOOK_NONE ? second.unknown > found->unknown && !second.is_anchor_unknown
			      : look == LOOK_UNTOLD) {
		t->asked.kind = QUESTION_UNTOLD;
		return 0;
	}
	while (k < found->count && (look == LOOK_NONE ? is_of(&second, found->things[k]) &&
								!is_at_nothing(&second, found->things[k])
						      : answer_look(t, found->things[k]) == LOOK_YES))
		k++;
	size_t more = 0;
	for (size_t i = 0; i < second.count; i++)
		more += is_of(&second, second.things[i]);
	t->is_yes = k == found->count && (!t->asked.least || more <= k);
	*found->reason = 0;
	if (!t->is_yes && second.is_anchor_unknown)
		snprintf(found->reason, sizeof found->reason, "%s", unknown_place);
	else if (!t->is_yes && found->count == 1 && !second.count)
		memcpy(found->reason, second.reason, sizeof found->reason);
	else if (!t->is_yes && (found->count > 1 || (second.count && second.things[0] != found->things[0])))
		snprintf(found->reason, sizeof found->reason,
			found->count > 1 ? "not %.200s" : "that is %.200s",
			a->model.lifted.names[found->count > 1 ? found->things[k] : second.things[0]]);
	return 0;
}

/* All that fit in place of the one thing. */
static int answer_all(const char *question, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer all = {0};

	if (asking_ask(a, question, 1, &all, to, e))
		return -1;
	if (!all.count)
		return 0;
	const struct asking_answer one = *found;
	*found = all;
	all = one;
	return 0;
}

/* Nothing is on, in or under a thing, where that hardly holds of anything. */
static void drop_apart(const struct answer_told *t, struct asking_answer *found)
{
	static const unsigned contact = 1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_BELOW;
	size_t k = 0;

	while (k < found->count && found->holds[found->things[k]] < is_at)
		k++;
	if (k == found->count && t->asked.relation >= 0 && contact >> t->asked.relation & 1)
		found->count = 0;
}

/* What stands in a relation: where no one thing is likely to be meant alone, all that does. Of what lies to
 * one side of a thing, one is told sooner. */
static int answer_set(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	const int relation = t->asked.relation;
	const int is_side = relation >= 0 && (relation <= PARSE_BELOW || relation == PARSE_BETWEEN) &&
			    !question_is_half(t->understood);

	if (asking_ask(a, t->asked.text[0], 0, found, to, e))
		return -1;
	drop_at_nothing(t, found);
	drop_apart(t, found);
	if (found->count != 1 || found->is_anchor_unknown || t->asked.most ||
		found->probability[found->things[0]] >= (is_side ? sure : sure_alone))
		return 0;
	return answer_all(t->asked.text[0], found, a, to, e);
}

/* What a thing is for may be said of several: "what can I drink from?", but not "which cup?". */
static int answer_one(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	const int is_all = t->asked.kind == QUESTION_THERE,
		  is_what = t->asked.kind == QUESTION_WHICH && question_is_open(t->understood);

	if (asking_ask(a, t->asked.text[0], is_all, found, to, e))
		return -1;
	return found->is_by_purpose && is_what ? answer_all(t->asked.text[0], found, a, to, e) : 0;
}

/* The things that a question of this kind is about. */
static int find_things(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	switch (t->asked.kind) {
	case QUESTION_LIST:
		return list(t, found, a, to, e);
	case QUESTION_DISTANCE:
		return answering_pair(t, found, a, 0, to, e);
	case QUESTION_COMPARE:
	case QUESTION_MORE:
		return answering_pair(t, found, a, 1, to, e);
	case QUESTION_EITHER:
		return answer_either(t, found, a, to, e);
	case QUESTION_WHETHER:
		return answer_whether(t, found, a, to, e);
	case QUESTION_SET:
		return answer_set(t, found, a, to, e);
	case QUESTION_NUMBER:
		return answering_all(t, t->asked.text[0], found, a, to, e);
	case QUESTION_TALLY:
	case QUESTION_EVEN:
	case QUESTION_MAJORITY:
	case QUESTION_SURPLUS:
		return answering_counts(t, found, a, to, e);
	case QUESTION_SAME:
		return answering_same(t, found, a, to, e);
	case QUESTION_COLOUR:
		return answering_colour(t, found, a, to, e);
	default:
		return answer_one(t, found, a, to, e);
	}
}

/* Of two things as likely none is answered. */
static void ask_back(struct answer_told *t, struct asking_answer *found, size_t thing, size_t other)
{
	t->is_unsure = 1;
	found->count = 1;
	found->things[0] = thing;
	found->runner_up = other;
}

/* What two things would be the answer, or what it is told by, if any. */
static void check_sure(struct answer_told *t, struct asking_answer *found)
{
	static const unsigned of_one = 1U << QUESTION_WHICH | 1U << QUESTION_COLOUR | 1U << QUESTION_LOOK |
				       1U << QUESTION_HEIGHT | 1U << QUESTION_WIDTH | 1U << QUESTION_SIZE;
	static const unsigned of_anchor =
		1U << QUESTION_SET | 1U << QUESTION_DISTANCE | 1U << QUESTION_COMPARE | 1U << QUESTION_MORE;

	const int is_one = of_one >> t->asked.kind & 1 ||
			   (t->asked.kind == QUESTION_SET && found->probability[found->things[0]] < sure);

	if (is_one && answering_is_unsure(found))
		ask_back(t, found, found->things[0], found->runner_up);
	if (!(of_anchor >> t->asked.kind & 1) || found->unclear[0] == ASKING_NONE)
		return;
	for (int k = 0; k < 2 && t->asked.kind == QUESTION_SET; k++)
		found->probability[found->unclear[k]] = found->there / 2;
	ask_back(t, found, found->unclear[0], found->unclear[1]);
}

/* Whether t->asked is about time, and of what kind it is where the scene or the question is not. */
static void take_motion(struct answer_told *t, struct asking_answer *found)
{
	static const char *const unknown[QUESTION_KINDS] = {[QUESTION_WHEN] = "when that is, is not known",
		[QUESTION_THEN] = "where things are at another time, --time tells",
		[QUESTION_UNTOLD] = "a scene does not tell that"};
	const int is_moving = t->asking->model.tracks.times > 0;

	if (t->asked.kind == QUESTION_WHICH && found->is_motion && question_is_yes_or_no(t->understood)) {
		t->asked.kind = QUESTION_THERE;
		t->is_yes = found->count > 0;
	}
	if (t->asked.kind == QUESTION_THEN && !is_moving)
		t->asked.kind = QUESTION_WHICH;
	if (!unknown[t->asked.kind])
		return;
	if (t->asked.kind != QUESTION_WHEN || !found->is_motion) {
		found->count = 0;
		snprintf(found->reason, sizeof found->reason, "%s", unknown[t->asked.kind]);
		answering_say(t, "not known");
	}
	if (!found->count)
		return;
	if (found->motion == MOTION_STARTS || found->motion == MOTION_STOPS)
		answering_say(t, "at %.4g", found->when[found->motion == MOTION_STOPS]);
	else
		answering_say(t, "from %.4g to %.4g", found->when[0], found->when[1]);
}

/* Whether as many are there as is asked. */
static int is_there(const struct question_asked *q, int n)
{
	return (n >= q->least && (n > 0 || q->most) && (!q->most || n <= q->most)) != q->is_denied;
}

int kinds_answer(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	const int is_compared = t->asked.kind == QUESTION_COMPARE || t->asked.kind == QUESTION_MORE;

	if (is_compared && !answering_is_comparable(t->asked.relation)) {
		t->asked = (struct question_asked){.relation = -1};
		memcpy(t->asked.text[0], t->understood, sizeof t->asked.text[0]);
	}
	const enum question_kind kind = t->asked.kind;

	if (find_things(t, found, a, to, e))
		return -1;
	if (t->asked.kind == QUESTION_THERE) {
		keep_holding(found, 0, t->asked.text[0]);
		drop_at_nothing(t, found);
	}
	if (t->asked.kind == QUESTION_THERE && question_is_of_thing(t->asked.text[0]) && found->unknown &&
		!found->is_anchor_unknown)
		t->asked.kind = QUESTION_UNTOLD;
	if (t->asked.kind == QUESTION_THERE)
		t->is_yes = is_there(&t->asked, (int)found->count);
	*found->reason = t->asked.most && found->count ? 0 : *found->reason;
	take_motion(t, found);
	if (kind == QUESTION_NUMBER || kind == QUESTION_LIST)
		t->number = (long)(t->asked.least ? answering_count_kinds(t) : found->count);
	if (kind == QUESTION_NUMBER)
		answering_say_number(t, (size_t)t->number);
	if (kind >= QUESTION_HEIGHT && kind <= QUESTION_SIZE)
		answering_need_boxes(t, found);
	if (!found->count)
		return 0;
	check_sure(t, found);
	if (t->is_unsure)
		*t->value = 0;
	else if (kind == QUESTION_DISTANCE)
		answering_measure_distance(t);
	else if ((kind == QUESTION_COLOUR && !*t->value) || kind == QUESTION_LOOK)
		answer_looks(t, kind == QUESTION_COLOUR, t->value, sizeof t->value);
	else if (kind >= QUESTION_HEIGHT && kind <= QUESTION_SIZE)
		answering_say_size(t);
	return 0;
}
