/* What is spoken of after an answer. */
#include "talk/talk_words.h"

#include "lang/closed.h"
#include "lang/tokens.h"

#include <stdio.h>
#include <string.h>

int talk_is_of_looks(const struct talk *talk)
{
	struct tokens t;
	int are = 0, is = 0;

	tokens_take(&t, talk->question, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++) {
		are |= talk_says_look(&t, i) && tokens_is(&t, i - 1, "are");
		is |= tokens_class(&t, i) == CLOSED_PLACE;
	}
	return are && !is;
}

/* The one thing of a kind besides it, or else the likeliest other one. */
static size_t find_other(const struct talk *talk, const struct talk_answer *a, size_t thing)
{
	const size_t objects = a->objects;
	char *const *names = a->names;
	char own[TALK_TEXT], words[TALK_TEXT];
	size_t other = TALK_NONE;
	int n = 0;

	for (size_t o = 0; o < objects && talk->of.n; o++)
		if (o < MEANING_SET && talk->of.is[o] && o != thing) {
			other = o;
			n++;
		}
	for (int is_noun = 0; is_noun < 2 && n != 1; is_noun++) {
		talk_name_words(names[thing], is_noun, own);
		n = 0;
		for (size_t o = 0; o < objects; o++) {
			talk_name_words(names[o], is_noun, words);
			if (o == thing || strcmp(own, words) != 0)
				continue;
			other = o;
			n++;
		}
	}
	return n == 1 ? other : a->runner_up;
}

/* The noun that all of a set's names end in, or else the one that the question asked for. */
static void find_noun(struct meaning_set *set, const struct talk_answer *a)
{
	const struct parse_span about = a->asked->about;
	char *const *names = a->names, noun[TALK_TEXT], other[TALK_TEXT];

	talk_name_words(names[a->things[0]], 1, noun);
	for (size_t k = 1; k < a->count && *noun; k++) {
		talk_name_words(names[a->things[k]], 1, other);
		*noun = strcmp(noun, other) ? 0 : *noun;
	}
	snprintf(set->noun, sizeof set->noun, "%s", noun);
	snprintf(other, sizeof other, "%.*s", about.end - about.begin, a->understood + about.begin);
	if (!*noun)
		question_noun(other, set->noun);
}

/* The others that are called as the answer's things are, or what was asked for. */
static void take_rest(struct talk *talk, const struct talk_answer *a, int is_within)
{
	const struct parse_span about = a->asked->about;
	struct meaning_set rest = {0};
	char noun[TALK_TEXT], asked[TALK_TEXT];

	find_noun(&rest, a);
	snprintf(asked, sizeof asked, "%.*s", about.end - about.begin, a->understood + about.begin);
	question_noun(asked, noun);
	const int is_any = !*noun && question_is_open(asked);
	*rest.noun = is_any ? 0 : *rest.noun;
	for (size_t o = 0; o < a->objects && o < MEANING_SET; o++) {
		talk_name_words(a->names[o], 1, noun);
		rest.is[o] =
			(is_any || !strcmp(noun, rest.noun)) && (!is_within || !talk->of.n || talk->of.is[o]);
	}
	for (size_t k = 0; k < a->count; k++)
		if (a->things[k] < MEANING_SET)
			rest.is[a->things[k]] = 0;
	for (size_t o = 0; o < MEANING_SET; o++)
		rest.n += rest.is[o] != 0;
	talk->rest = rest;
}

static void take_set(struct talk *talk, const struct talk_answer *a, int is_within)
{

	talk->is_several = a->count > 1;
	if (a->count > 1) {
		talk->set = (struct meaning_set){.n = a->count};
		for (size_t k = 0; k < a->count; k++)
			if (a->things[k] < MEANING_SET)
				talk->set.is[a->things[k]] = 1;
		find_noun(&talk->set, a);
	}
	if (!is_within)
		talk->of = a->count > 1 ? talk->set : (struct meaning_set){0};
}

/* "the mug and the cup": of an answer of two, and of a question about two. */
static void take_things(struct talk *talk, const struct talk_answer *a, int is_within)
{
	const int kind = a->asked->kind;

	*talk->things = 0;
	if (kind == QUESTION_WHETHER || kind == QUESTION_MORE || kind == QUESTION_COMPARE) {
		const char *second = a->asked->text[1];
		const char *at = kind == QUESTION_WHETHER ? strstr(second, " the ") : second;
		const size_t length = strlen(a->asked->text[0]);
		if (kind == QUESTION_WHETHER && !strncmp(second, a->asked->text[0], length))
			at = strstr(second + length, " the ");
		if (at && length + strlen(at) + 8 < sizeof talk->things)
			snprintf(talk->things, TALK_TEXT, "%.100s and %.100s", a->asked->text[0],
				at + (*at == ' '));
		if (!is_within)
			talk->set = talk->of = (struct meaning_set){0};
		return;
	}
	char *const *names = a->names;
	if (a->count == 2)
		snprintf(talk->things, TALK_TEXT, "the %.100s and the %.100s", names[a->things[0]],
			names[a->things[1]]);
	take_set(talk, a, is_within);
}

void talk_take(struct talk *talk, const struct talk_answer *a, int is_within)
{

	if (!a->count)
		return;
	const size_t thing = a->things[0], before[2] = {talk->thing, talk->other};
	const int was_unsure = talk->is_unsure;
	talk->thing = thing;
	talk->is_unsure = a->is_unsure;
	talk->other = a->count == 2	   ? a->things[1]
		      : a->is_unsure	   ? a->runner_up
		      : !was_unsure	   ? find_other(talk, a, thing)
		      : thing == before[0] ? before[1]
		      : thing == before[1] ? before[0]
					   : find_other(talk, a, thing);
	take_rest(talk, a, is_within);
	take_things(talk, a, is_within || (*talk->things && strstr(a->understood, talk->things)));
	snprintf(talk->question, sizeof talk->question, "%s", a->understood);
}
