/* Words that point back to what was spoken of last. They are put right in the question's text, so that
 * everything else reads it as if it had been said in full. */
#include "talk/talk_words.h"

#include "lang/closed.h"
#include "lang/tokens.h"

#include <stdio.h>
#include <string.h>

/* What several things are called, one of which has this name: "the bigger one" is one of those. "": no others
 * are. */
static void find_shared(char *const *names, size_t objects, size_t thing, char words[TALK_TEXT])
{
	char other[TALK_TEXT];

	for (int is_noun = 0; is_noun < 2; is_noun++) {
		int n = 0;
		talk_name_words(names[thing], is_noun, words);
		for (size_t o = 0; o < objects; o++) {
			talk_name_words(names[o], is_noun, other);
			n += !strcmp(words, other);
		}
		if (n > 1)
			return;
	}
	*words = 0;
}

/* What "one" is one of. */
static const struct meaning_set *of_one(const struct talk *talk)
{
	return talk->is_several ? &talk->set : &talk->of;
}

/* The same, where words may point to some of the things that were spoken of, and "those" are a set; returns
 * which. */
static const struct meaning_set *put_set(const struct talk *talk, const struct meaning_set *those,
	struct referents *r, const char *question, char understood[QUESTION_TEXT])
{
	static const unsigned of_two = 1U << QUESTION_DISTANCE | 1U << QUESTION_COMPARE |
				       1U << QUESTION_MORE | 1U << QUESTION_EITHER;
	const char *noun = *those->noun ? those->noun : "thing";
	struct question_asked q;

	unsigned to = talk_put_pointed(r, question, understood);
	question_read(&q, understood, 0);
	if (those->n && (!*r->things || !(of_two >> q.kind & 1))) {
		snprintf(r->things, sizeof r->things, "the %s%s", noun, talk_plural_end(noun));
		to = talk_put_pointed(r, question, understood);
		if (to & TO_THINGS)
			return those;
	}
	return of_one(talk)->n && to & TO_NOUN ? of_one(talk) : NULL;
}

/* "no, the other one", "not that one": the words up to a pause that ask for another thing than the last; 0
 * where there are none. */
static int is_other(const struct tokens *t)
{
	static const char words[] =
		"no|nope|not|the|that|this|it|i|mean|meant|other|one|another|thing|wrong|'s|n't|and|what|about";
	int is = 0, i = 0;

	for (; i < t->n && (!is || !t->word[i].before); i++) {
		if (!tokens_is(t, i, words))
			return 0;
		is |= tokens_is(t, i, "other") || tokens_is(t, i, "another") || tokens_is(t, i, "not") ||
		      tokens_is(t, i, "n't");
	}
	while (is && i < t->n && !t->word[i].before)
		i++;
	return is ? i : 0;
}

/* Where the thing begins of "and the kettle?", "what about the kettle?", "and from the kettle?", or of a
 * reply to what was asked back; -1: it is none of these. */
static int find_again(const struct talk *talk, const struct question_asked *last, const struct tokens *t,
	const char *question)
{
	static const unsigned begins = 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE |
				       1U << CLOSED_PLACE | 1U << CLOSED_GENERIC;
	int from = 0, is_and = t->n && tokens_is(t, t->n - 1, "then|too|also");

	while (tokens_is(t, from, "ok|okay|well|fine|good|now|and|or|also|so"))
		is_and |= tokens_is(t, from++, "and|or|also");
	const int about = tokens_is(t, from, "what|how") && tokens_is(t, from + 1, "about");
	from += 2 * about;
	const int class = from < t->n ? tokens_class(t, from) : CLOSED_BE;
	struct question_asked q;

	question_read(&q, question, 0);
	const int may_begin = class < 0 || (begins >> class & 1) ||
			      (last->kind == QUESTION_DISTANCE && tokens_is(t, from, "from|to"));
	return q.kind == QUESTION_WHICH && may_begin && (about || is_and || talk->is_unsure) ? from : -1;
}

/* "How far is it from the mug?" of the thing that is not the one it is from. */
static void ask_distance(const struct question_asked *last, const char *question, const char *thing,
	char understood[QUESTION_TEXT])
{
	const char *at = strstr(question, last->text[0]);
	const int is_from =
		at && at - question > 5 && (!strncmp(at - 5, "from ", 5) || !strncmp(at - 3, "to ", 3));

	snprintf(understood, QUESTION_TEXT, "how far is %.400s %.400s", last->text[is_from], thing);
}

/* The last question of the thing that this one names. */
static void ask_again(const struct question_asked *last, const char *question, const char *thing,
	char understood[QUESTION_TEXT])
{
	struct tokens t;
	char about[QUESTION_TEXT];
	int begin = last->about.begin;
	struct question_asked own;

	tokens_take(&t, thing, NULL, NULL, 0);
	snprintf(understood, QUESTION_TEXT, "%s", thing);
	question_read(&own, thing, 0); /* "the mug's height" */
	if (last->kind == QUESTION_DISTANCE && *last->text[1] && tokens_is(&t, 0, "from|to")) {
		ask_distance(last, question, thing, understood);
		return;
	}
	if (last->kind == QUESTION_WHICH || own.kind != QUESTION_WHICH || last->about.end <= begin)
		return;
	/* "left of the mug" becomes "left of the kettle", but "on the mug" becomes "under the kettle" */
	const int is_place = t.n && tokens_class(&t, 0) == CLOSED_PLACE;
	snprintf(about, sizeof about, "%.*s", last->about.end - begin, question + begin);
	tokens_take(&t, about, NULL, NULL, 0);
	for (int i = 0; i < t.n && !is_place && tokens_class(&t, 0) == CLOSED_PLACE; i++)
		if (tokens_class(&t, i) == CLOSED_DETERMINER) {
			begin += t.word[i].span.begin;
			break;
		}
	snprintf(understood, QUESTION_TEXT, "%.*s%.400s%.400s", begin, question, thing,
		question + last->about.end);
}

/* "Which is bigger?", "how many are red?" and "the smallest", of several that were spoken of: of those.
 * Returns whether it is so; to gets the text up to its pause. */
static int add_those(const struct talk *talk, int is_part, const char *question, char to[QUESTION_TEXT])
{
	char noun[TOKEN_LENGTH];
	struct tokens t;

	tokens_take(&t, question, NULL, NULL, 0);
	int i = tokens_is(&t, 0, "and"), is = talk->of.n && t.n;
	for (int k = 0; k < t.n; k++)
		is &= tokens_class(&t, k) != CLOSED_GENERIC && tokens_class(&t, k) != CLOSED_PRONOUN;
	question_noun(question, noun);
	if (is_part)
		is &= !*noun && tokens_class(&t, 0) == CLOSED_DETERMINER;
	i = is_part ? t.n : tokens_is(&t, i, "which") ? i + 1 : tokens_is(&t, i + 1, "many") ? i + 2 : 0;
	is &= i && (i == t.n || tokens_class(&t, i) == CLOSED_BE || tokens_class(&t, i) == CLOSED_HAVE);
	const int end = i && i <= t.n ? t.word[i - 1].span.end : 0;
	snprintf(to, QUESTION_TEXT, "%.*s%s%.*s", end, question, is ? " of those" : "",
		is_part ? 0 : QUESTION_TEXT - 64 - end, question + end);
	return is;
}

/* The same of another thing: "and the kettle?", "the other one". */
static const struct meaning_set *understand_part(const struct talk *talk, const struct question_asked *last,
	struct referents *r, const char *part, char understood[QUESTION_TEXT])
{
	char of_those[QUESTION_TEXT], thing[QUESTION_TEXT], noun[TOKEN_LENGTH];
	const int is = add_those(talk, 1, part, of_those);
	struct tokens t;

	/* "which mug is the largest? and the smallest?" */
	tokens_take(&t, part, NULL, NULL, 0);
	question_noun(part, noun);
	if (!is && t.n > 1 && !*noun && tokens_class(&t, t.n - 1) == CLOSED_SIZE)
		snprintf(of_those, sizeof of_those, "%.400s %s", part, r->kind);
	/* "how many mugs are left of the tray? and right of it?": of the tray */
	const char *about = talk->question + last->about.begin, *anchor = NULL;
	for (const char *at = about; (at = strstr(at, " the ")) && at < talk->question + last->about.end;
		at++)
		anchor = at + strlen(" the ");
	if (tokens_class(&t, 0) == CLOSED_PLACE && tokens_is(&t, t.n - 1, "it|that") && anchor)
		snprintf(r->name, sizeof r->name, "%.*s", (int)(talk->question + last->about.end - anchor),
			anchor);
	const struct meaning_set *set = put_set(talk, is ? &talk->of : &talk->set, r, of_those, thing);

	/* "what is on the tray? and the thing behind it?" is not what is on that */
	if (last->kind == QUESTION_SET && talk_points(part))
		snprintf(understood, QUESTION_TEXT, "%s", thing);
	else
		ask_again(last, talk->question, thing, understood);
	return set;
}

/* What to call a thing that has its number: "mug 1" beside "mug 2". */
static void find_name(char *const *names, size_t objects, size_t thing, char name[TALK_TEXT])
{
	const size_t n = thing == TALK_NONE ? 0 : strlen(names[thing]);
	int has_other = 0;

	for (size_t o = 0; o < objects && n; o++)
		has_other |= !strncmp(names[o], names[thing], n) && names[o][n] == ' ' &&
			     names[o][n + 1 + strspn(names[o] + n + 1, "0123456789")] == 0;
	snprintf(name, TALK_TEXT, "%s%s", n ? names[thing] : "", has_other ? " 1" : "");
}

/* What words may point to. */
static void find_referents(const struct talk *talk, char *const *names, size_t objects,
	const struct question_asked *last, struct referents *r)
{
	char about[QUESTION_TEXT], noun[TOKEN_LENGTH], other[TALK_TEXT];
	int n = 0;

	snprintf(r->things, sizeof r->things, "%s", talk->things);
	find_name(names, objects, talk->thing, r->name);
	find_name(names, objects, talk->other, r->other);
	find_shared(names, objects, talk->thing, r->noun);
	talk_name_words(names[talk->thing], 1, r->kind);
	snprintf(about, sizeof about, "%.*s", last->about.end - last->about.begin,
		talk->question + last->about.begin);
	question_noun(about, noun);
	const struct meaning_set *of = of_one(talk);
	if (of->n)
		snprintf(noun, sizeof noun, "%s", *of->noun ? of->noun : "thing");
	for (size_t o = 0; o < objects && *noun; o++) {
		talk_name_words(names[o], 1, other);
		n += !strcmp(other, noun);
	}
	if (*noun)
		snprintf(r->kind, sizeof r->kind, "%s", noun);
	if (n > 1 || of->n)
		snprintf(r->noun, sizeof r->noun, "%s", noun);
}

/* The word by which a question compares: "taller". */
static const char *find_more(const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (tokens_class(t, i) == CLOSED_SIZE && closed_words[t->word[i].closed].value == PARSE_MORE)
			return t->word[i].text;
	return NULL;
}

/* "How much taller?", and "by how much?", of the two things that were spoken of; "and how wide?" of the last.
 */
static int ask_how(const struct talk *talk, const struct tokens *t, const struct referents *r,
	char understood[QUESTION_TEXT])
{
	const int i = tokens_is(t, 0, "and|by|so"), is_much = tokens_is(t, i + 1, "much");
	const int is_it =
		t->n == i + 5 && tokens_class(t, i + 3) == CLOSED_BE && tokens_is(t, i + 4, "it|that|he|she");
	const int class = tokens_class(t, i + 1 + is_much);
	const char *word = i + 1 + is_much < t->n ? t->word[i + 1 + is_much].text : NULL;
	struct tokens last;

	if (!tokens_is(t, i, "how") || (t->n > i + 2 + is_much && !is_it))
		return 0;
	tokens_take(&last, talk->question, NULL, NULL, 0);
	if (is_much && !word)
		word = find_more(&last);
	else if (class != CLOSED_SIZE && (class != CLOSED_PLACE || !is_much))
		return 0;
	if (!word || (is_much && !*r->things && !*r->other))
		return 0;
	if (!is_much)
		snprintf(understood, QUESTION_TEXT, "how %s is the %s", word, r->name);
	else if (*r->things)
		snprintf(understood, QUESTION_TEXT, "how much %s is %s", word, r->things);
	else
		snprintf(understood, QUESTION_TEXT, "how much %s is the %s than the %s", word, r->name,
			r->other);
	return 1;
}

const struct meaning_set *talk_understand(const struct talk *talk, char *const *names, size_t objects,
	const char *question, char understood[QUESTION_TEXT])
{
	struct referents r = {0};
	struct question_asked last;
	char of_those[QUESTION_TEXT], of_rest[QUESTION_TEXT];
	struct tokens t;

	if (!talk || !*talk->question || talk->thing == TALK_NONE) {
		talk_put_pointed(&r, question, understood);
		return NULL;
	}
	const int is_rest = talk_put_rest(&talk->rest, question, of_rest);
	question = of_rest;
	tokens_take(&t, question, NULL, NULL, 0);
	question_read(&last, talk->question, 0);
	find_referents(talk, names, objects, &last, &r);
	if (ask_how(talk, &t, &r, understood))
		return NULL;
	const int other = is_other(&t), thing = find_again(talk, &last, &t, question);
	if (other == t.n || thing >= 0) {
		const struct meaning_set *set = understand_part(talk, &last, &r,
			other == t.n ? "the other one" : question + t.word[thing].span.begin, understood);
		return is_rest ? &talk->rest : set;
	}
	if (other && *r.other)
		memcpy(r.name, r.other, sizeof r.name);
	const int is = add_those(talk, 0, question + (other ? t.word[other].span.begin : 0), of_those);
	const struct meaning_set *set = put_set(talk, is ? &talk->of : &talk->set, &r, of_those, understood);
	return is_rest ? &talk->rest : set;
}
