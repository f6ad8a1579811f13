/* Answers about the numbers of two kinds of things: whether there are more of one, as many, and how many
 * more. */
#include "cmd/ask/answering.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

size_t answering_count_kinds(const struct answer_told *t)
{
	char **names = t->asking->model.lifted.names, noun[TALK_TEXT], other[TALK_TEXT];
	const size_t *things = t->answer->things;
	size_t kinds = 0;

	for (size_t k = 0, i; k < t->answer->count; k++) {
		talk_name_words(names[things[k]], 1, noun);
		for (i = 0; i < k; i++) {
			talk_name_words(names[things[i]], 1, other);
			if (!strcmp(noun, other))
				break;
		}
		kinds += i == k;
	}
	return kinds;
}

/* Adds what is not there yet. */
static void add_things(struct asking_answer *to, const struct asking_answer *more)
{
	for (size_t k = 0; k < more->count; k++) {
		size_t i = 0;
		while (i < to->count && to->things[i] != more->things[k])
			i++;
		to->probability[more->things[k]] = more->probability[more->things[k]];
		to->things[i] = more->things[k];
		to->count += i == to->count;
	}
}

/* Sizes of which the larger is less than so much of the smaller are alike. */
static const double same_size = 1.15;

/* A thing's length, or its likeliest colour. */
static double measure(struct answer_told *t, size_t thing, char colour[CALLING_TEXT])
{
	const struct asking_answer *all = t->answer;
	struct asking_answer one = *all;
	const int relation = t->asked.relation;

	one.things = &thing;
	one.count = 1;
	t->answer = &one;
	answer_looks(t, 1, colour, CALLING_TEXT);
	colour[strcspn(colour, " ")] = 0;
	t->answer = all;
	return relation < 0 ? 1
			    : answering_length(t, thing,
				      relation == PARSE_TALLER || relation == PARSE_SHORTER ? QUESTION_HEIGHT
				      : relation == PARSE_WIDER || relation == PARSE_LONGER ? QUESTION_WIDTH
											    : QUESTION_SIZE);
}

int answering_same(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer second = {0};
	char colour[CALLING_TEXT], other[CALLING_TEXT];

	if (asking_ask(a, t->asked.text[0], 0, found, to, e) ||
		(*t->asked.text[1] && asking_ask(a, t->asked.text[1], 0, &second, to, e)))
		return -1;
	add_things(found, &second);
	answering_need_boxes(t, found);
	t->is_yes = found->count > 1;
	*found->reason = found->count > 1 ? 0 : *found->reason;
	for (size_t k = 1; k < found->count; k++) {
		const double x = measure(t, found->things[0], colour),
			     y = measure(t, found->things[k], other);
		t->is_yes &= x < same_size * y && y < same_size * x &&
			     (t->asked.relation >= 0 || !strcmp(colour, other));
	}
	return 0;
}

/* "two to one", "three each" */
static void say_numbers(struct answer_told *t, size_t first, size_t second)
{
	answering_say_number(t, first);
	if (first == second) {
		answering_say(t, " each");
		return;
	}
	answering_say(t, " to ");
	answering_say_number(t, second);
}

/* "all the mugs" as it was asked: "the mugs". */
static const char *asked_for(const char *text)
{
	return strncmp(text, "all ", 4) ? text : text + 4;
}

int answering_counts(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer second = {0};
	const struct question_asked *q = &t->asked;

	if (answering_all(t, q->text[0], found, a, to, e) || answering_all(t, q->text[1], &second, a, to, e))
		return -1;
	const size_t n = found->count, m = second.count;
	t->number = (long)n - (long)m;
	t->is_yes = q->kind == QUESTION_TALLY ? t->number >= q->least : !t->number;
	if (q->kind == QUESTION_SURPLUS) {
		answering_say_number(t, (size_t)labs(t->number));
		answering_say(t, t->number < 0 ? " fewer" : " more");
	} else if (q->kind == QUESTION_MAJORITY) {
		const int is_second = t->number * q->least < 0;
		answering_say(t, "%.100s, ", t->number ? asked_for(q->text[is_second]) : "as many");
		say_numbers(t, is_second ? m : n, is_second ? n : m);
	} else {
		say_numbers(t, n, m);
	}
	add_things(found, &second);
	return 0;
}
