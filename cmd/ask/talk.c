/* Words that point back to what was spoken of last. They are put right in the question's text, so that
 * everything else reads it as if it had been said in full. */
#include "cmd/ask/reply.h"

#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/tokens.h"

#include <string.h>

/* Whether a thing is named in the question before word i, which then points to that: "the plate with nothing
 * on it", but not "is the plate larger than it?". Its words are *of, up to a pause, where there is one
 * between. */
static int is_named_before(const struct tokens *t, int i, struct parse_span *of)
{
	static const unsigned clauses = 1U << CLOSED_WITH | 1U << CLOSED_HAVE | 1U << CLOSED_RELATIVE |
					1U << CLOSED_NEGATION | 1U << CLOSED_CONJUNCTION;
	int is_definite = 0, is = 0, begin = 0, is_clause = 0;

	*of = (struct parse_span){0};
	for (int k = 0; k < i; k++) {
		const int class = tokens_class(t, k);
		is_clause |= is && class >= 0 && clauses >> class & 1;
		if (is && t->word[k].before && !of->end)
			*of = (struct parse_span){t->word[begin].span.begin, t->word[k - 1].span.end};
		if (!is && class == CLOSED_DETERMINER) {
			is_definite = 1;
			begin = k;
		} else if ((class < 0 || tokens_is(t, k, "one")) && is_definite) {
			is = 1;
		} else if (class >= 0 && class != CLOSED_SIZE && class != CLOSED_ATTRIBUTE &&
			   class != CLOSED_ORDINAL) {
			is_definite = 0;
		}
	}
	if (is && t->word[i].before && !of->end)
		*of = (struct parse_span){t->word[begin].span.begin, t->word[i - 1].span.end};
	return is && (is_clause || of->end);
}

/* The words of a name but for numbers; with is_noun the last of them alone. */
static void find_words(const char *name, int is_noun, char words[CALLING_TEXT])
{
	struct tokens t;
	size_t n = 0;

	*words = 0;
	tokens_take(&t, name, NULL, NULL, 0);
	for (int i = 0; i < t.n && n < CALLING_TEXT; i++)
		if (strspn(t.word[i].text, "0123456789") < strlen(t.word[i].text)) {
			n = is_noun ? 0 : n;
			n += (size_t)snprintf(
				words + n, CALLING_TEXT - n, "%s%s", n ? " " : "", t.word[i].lemma);
		}
}

/* What several things are called, one of which has this name: "the bigger one" is one of those. "": no others
 * are. */
static void find_shared(char *const *names, size_t objects, size_t thing, char words[CALLING_TEXT])
{
	char other[CALLING_TEXT];

	for (int is_noun = 0; is_noun < 2; is_noun++) {
		int n = 0;
		find_words(names[thing], is_noun, words);
		for (size_t o = 0; o < objects; o++) {
			find_words(names[o], is_noun, other);
			n += !strcmp(words, other);
		}
		if (n > 1)
			return;
	}
	*words = 0;
}

/* What a word points back to. */
struct pointed {
	const char *article, *to, *tail; /* "the ", "mug", "'s"; to is NULL: nothing */
	int end;			 /* the word behind it */
};

/* What words of a question may point to; "" where there is no such thing. */
struct referents {
	char name[CALLING_TEXT], other[CALLING_TEXT], things[CALLING_TEXT];
	char noun[CALLING_TEXT], kind[CALLING_TEXT]; /* of "the left one", and of "the red one" */
};

static struct pointed point(const char *article, const char *to, const char *tail, int end)
{
	return (struct pointed){article, to, tail, end};
}

/* "the other one", "that one", "the two": how many words from word i on are the whole of that. */
static int other_length(const struct tokens *t, int i)
{
	const int from = tokens_is(t, i, "the") ? i + 1 : i;

	if (!tokens_is(t, from, "other") && (from > i || !tokens_is(t, from, "another")))
		return 0;
	const int class = tokens_class(t, from + 1);
	const int is_one = tokens_is(t, from + 1, "one") || tokens_is(t, from + 1, "thing");
	return is_one || (class != CLOSED_GENERIC && class >= 0) || from + 1 == t->n ? from + 1 + is_one - i
										     : 0;
}

static int two_length(const struct tokens *t, int i)
{
	static const char those[] = "the|those|these";
	static const char them[] = "them";
	const int is_two = tokens_is(t, i, those) && tokens_is(t, i + 1, "two");

	if (!is_two || (i + 2 < t->n && tokens_class(t, i + 2) < 0))
		return 0;
	return tokens_is(t, i + 2, "of") && tokens_is(t, i + 3, them) ? 4 : 2;
}

/* Whether the word before "one" says a look, by which another thing of the kind is meant. */
static int says_look(const struct tokens *t, int i)
{
	return tokens_class(t, i - 1) == CLOSED_ATTRIBUTE || colour_word(t->word[i - 1].text) >= 0;
}

/* ", isn't it?": nothing but such words since a pause. */
static int is_tag(const struct tokens *t, int i)
{
	static const unsigned words = 1U << CLOSED_BE | 1U << CLOSED_NEGATION | 1U << CLOSED_AUXILIARY;
	int k = i;

	while (k > 0 && !t->word[k].before && tokens_class(t, k - 1) >= 0 &&
		words >> tokens_class(t, k - 1) & 1)
		k--;
	return i + 1 == t->n && k < i && t->word[k].before;
}

static const char *plural_end(const char *noun)
{
	const size_t n = strlen(noun);

	return n && strchr("sxh", noun[n - 1]) ? "es" : "s";
}

/* topic is where a thing is written that the question begins with: "the mug, how tall is it?" */
static struct pointed points_to(const struct tokens *t, int i, const struct referents *r,
	char topic[CALLING_TEXT], const char *question)
{
	static const char it[] = "it|him|her|he|she";
	static const char that[] = "that|this";
	static const char those[] = "they|them|those|these";
	struct parse_span of;
	const int is_one = tokens_is(t, i + 1, "one") || tokens_is(t, i + 1, "thing");
	const int class = tokens_class(t, i + 1), before = i ? tokens_class(t, i - 1) : CLOSED_CONJUNCTION;
	/* behind a noun, as of "everything that is red", a clause begins */
	const int may_stand = before == CLOSED_CONJUNCTION || before == CLOSED_BE ||
			      before == CLOSED_PREPOSITION || before == CLOSED_PLACE;
	const int is_end = i + 1 == t->n || tokens_is(t, i - 1, "of") ||
			   (may_stand && (class == CLOSED_BE || class == CLOSED_CONJUNCTION)) ||
			   (before == CLOSED_BE && (class == CLOSED_PREPOSITION || class == CLOSED_PLACE));

	if (other_length(t, i) && *r->other)
		return point("the ", r->other, "", i + other_length(t, i));
	if (two_length(t, i) && *r->things)
		return point("", r->things, "", i + two_length(t, i));
	if (is_named_before(t, i, &of)) {
		snprintf(topic, CALLING_TEXT, "%.*s", of.end - of.begin, question + of.begin);
		const int is_topic =
			!is_tag(t, i) && (tokens_is(t, i, it) || (tokens_is(t, i, that) && is_end));
		return (struct pointed){"", is_topic && of.end ? topic : NULL, "", i + 1};
	}
	if (tokens_is(t, i, "its"))
		return point("the ", r->name, "'s", i + 1);
	if (tokens_is(t, i, it))
		return point("the ", r->name, "", i + 1);
	if (tokens_is(t, i, that) && (is_one || is_end))
		return point("the ", r->name, "", i + 1 + is_one);
	if (*r->things && tokens_is(t, i, those) &&
		(is_end || class == CLOSED_NUMBER || tokens_is(t, i, "they")))
		return point("", r->things, "", i + 1 + (class == CLOSED_NUMBER));
	const int is_noun = i && tokens_is(t, i, "one|ones") && !tokens_is(t, i + 1, "of");
	const char *noun = !is_noun ? "" : says_look(t, i) ? r->kind : r->noun;
	return (struct pointed){
		"", *noun ? noun : NULL, tokens_is(t, i, "ones") ? plural_end(noun) : "", i + 1};
}

/* What words pointed to, as bits. */
enum { TO_THINGS = 1, TO_NOUN = 2 };

/* The question with what its words point back to in their place. Returns what they point to. */
static unsigned put_pointed(const struct referents *r, const char *question, char understood[QUESTION_TEXT])
{
	char topic[CALLING_TEXT];
	struct question_asked q;
	struct tokens t;
	size_t n = 0;
	unsigned to = 0;
	int from = 0;

	*understood = 0;
	question_read(&q, question, 0);
	tokens_take(&t, question, NULL, NULL, 0);
	for (int i = 0, end; i < t.n && n < QUESTION_TEXT; i = end) {
		const struct pointed p = points_to(&t, i, r, topic, question);
		end = p.end;
		if (!p.to || !*p.to || (p.to == topic && q.kind == QUESTION_WHICH))
			continue;
		to |= p.to == r->things ? TO_THINGS : p.to == r->noun || p.to == r->kind ? TO_NOUN : 0;
		n += (size_t)snprintf(understood + n, QUESTION_TEXT - n, "%.*s%s%s%s",
			t.word[i].span.begin - from, question + from, p.article, p.to, p.tail);
		from = t.word[end - 1].span.end;
	}
	if (n < QUESTION_TEXT)
		snprintf(understood + n, QUESTION_TEXT - n, "%s", question + from);
	return to;
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

	unsigned to = put_pointed(r, question, understood);
	question_read(&q, understood, 0);
	if (those->n && (!*r->things || !(of_two >> q.kind & 1))) {
		snprintf(r->things, sizeof r->things, "the %s%s", noun, plural_end(noun));
		to = put_pointed(r, question, understood);
		if (to & TO_THINGS)
			return those;
	}
	return of_one(talk)->n && to & TO_NOUN ? of_one(talk) : NULL;
}

int talk_points(const char *question)
{
	const struct referents nothing = {0};
	char topic[CALLING_TEXT];
	struct tokens t;

	tokens_take(&t, question, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++)
		if (points_to(&t, i, &nothing, topic, question).to)
			return 1;
	return 0;
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
	const int about = tokens_is(t, 1, "about") && (tokens_is(t, 0, "what") || tokens_is(t, 0, "how"));
	const int is_and = tokens_is(t, 0, "and"), from = about ? 2 : is_and;
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

	tokens_take(&t, thing, NULL, NULL, 0);
	snprintf(understood, QUESTION_TEXT, "%s", thing);
	if (last->kind == QUESTION_DISTANCE && *last->text[1] && tokens_is(&t, 0, "from|to")) {
		ask_distance(last, question, thing, understood);
		return;
	}
	if (last->kind == QUESTION_WHICH || last->about.end <= begin)
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
	is &= i && (i == t.n || tokens_class(&t, i) == CLOSED_BE);
	const int end = i && i <= t.n ? t.word[i - 1].span.end : 0;
	snprintf(to, QUESTION_TEXT, "%.*s%s%.*s", end, question, is ? " of those" : "",
		is_part ? 0 : QUESTION_TEXT - 64 - end, question + end);
	return is;
}

/* The same of another thing: "and the kettle?", "the other one". */
static const struct meaning_set *understand_part(const struct talk *talk, const struct question_asked *last,
	struct referents *r, const char *part, char understood[QUESTION_TEXT])
{
	char of_those[QUESTION_TEXT], thing[QUESTION_TEXT];
	const int is = add_those(talk, 1, part, of_those);
	const struct meaning_set *set = put_set(talk, is ? &talk->of : &talk->set, r, of_those, thing);

	/* "what is on the tray? and the thing behind it?" is not what is on that */
	if (last->kind == QUESTION_SET && talk_points(part))
		snprintf(understood, QUESTION_TEXT, "%s", thing);
	else
		ask_again(last, talk->question, thing, understood);
	return set;
}

/* What to call a thing that has its number: "mug 1" beside "mug 2". */
static void find_name(char *const *names, size_t objects, size_t thing, char name[CALLING_TEXT])
{
	const size_t n = thing == ASKING_NONE ? 0 : strlen(names[thing]);
	int has_other = 0;

	for (size_t o = 0; o < objects && n; o++)
		has_other |= !strncmp(names[o], names[thing], n) && names[o][n] == ' ' &&
			     names[o][n + 1 + strspn(names[o] + n + 1, "0123456789")] == 0;
	snprintf(name, CALLING_TEXT, "%s%s", n ? names[thing] : "", has_other ? " 1" : "");
}

/* What words may point to. */
static void find_referents(const struct talk *talk, char *const *names, size_t objects,
	const struct question_asked *last, struct referents *r)
{
	char about[QUESTION_TEXT], noun[TOKEN_LENGTH], other[CALLING_TEXT];
	int n = 0;

	snprintf(r->things, sizeof r->things, "%s", talk->things);
	find_name(names, objects, talk->thing, r->name);
	find_name(names, objects, talk->other, r->other);
	find_shared(names, objects, talk->thing, r->noun);
	find_words(names[talk->thing], 1, r->kind);
	snprintf(about, sizeof about, "%.*s", last->about.end - last->about.begin,
		talk->question + last->about.begin);
	question_noun(about, noun);
	const struct meaning_set *of = of_one(talk);
	if (of->n)
		snprintf(noun, sizeof noun, "%s", *of->noun ? of->noun : "thing");
	for (size_t o = 0; o < objects && *noun; o++) {
		find_words(names[o], 1, other);
		n += !strcmp(other, noun);
	}
	if (*noun)
		snprintf(r->kind, sizeof r->kind, "%s", noun);
	if (n > 1 || of->n)
		snprintf(r->noun, sizeof r->noun, "%s", noun);
}

const struct meaning_set *talk_understand(const struct talk *talk, char *const *names, size_t objects,
	const char *question, char understood[QUESTION_TEXT])
{
	struct referents r = {0};
	struct question_asked last;
	char of_those[QUESTION_TEXT];
	struct tokens t;

	tokens_take(&t, question, NULL, NULL, 0);
	if (!talk || !*talk->question || talk->thing == ASKING_NONE) {
		put_pointed(&r, question, understood);
		return NULL;
	}
	question_read(&last, talk->question, 0);
	find_referents(talk, names, objects, &last, &r);
	const int other = is_other(&t), thing = find_again(talk, &last, &t, question);
	if (other == t.n || thing >= 0)
		return understand_part(talk, &last, &r,
			other == t.n ? "the other one" : question + t.word[thing].span.begin, understood);
	if (other && *r.other)
		memcpy(r.name, r.other, sizeof r.name);
	const int is = add_those(talk, 0, question + (other ? t.word[other].span.begin : 0), of_those);
	return put_set(talk, is ? &talk->of : &talk->set, &r, of_those, understood);
}

/* The one thing of a kind besides it, or else the likeliest other one. */
static size_t find_other(const struct talk *talk, const struct answer_told *t, size_t thing)
{
	const size_t objects = t->asking->model.lifted.objects;
	char *const *names = t->asking->model.lifted.names;
	char own[CALLING_TEXT], words[CALLING_TEXT];
	size_t other = ASKING_NONE;
	int n = 0;

	for (size_t o = 0; o < objects && talk->of.n; o++)
		if (o < MEANING_SET && talk->of.is[o] && o != thing) {
			other = o;
			n++;
		}
	for (int is_noun = 0; is_noun < 2 && n != 1; is_noun++) {
		find_words(names[thing], is_noun, own);
		n = 0;
		for (size_t o = 0; o < objects; o++) {
			find_words(names[o], is_noun, words);
			if (o == thing || strcmp(own, words) != 0)
				continue;
			other = o;
			n++;
		}
	}
	return n == 1 ? other : t->answer->runner_up;
}

/* The noun that all of a set's names end in, or else the one that the question asked for. */
static void find_noun(struct meaning_set *set, const struct answer_told *t)
{
	const struct asking_answer *a = t->answer;
	const struct parse_span about = t->asked.about;
	char *const *names = t->asking->model.lifted.names, noun[CALLING_TEXT], other[CALLING_TEXT];

	find_words(names[a->things[0]], 1, noun);
	for (size_t k = 1; k < a->count && *noun; k++) {
		find_words(names[a->things[k]], 1, other);
		*noun = strcmp(noun, other) ? 0 : *noun;
	}
	snprintf(set->noun, sizeof set->noun, "%s", noun);
	snprintf(other, sizeof other, "%.*s", about.end - about.begin, t->understood + about.begin);
	if (!*noun)
		question_noun(other, set->noun);
}

static void take_set(struct talk *talk, const struct answer_told *t, int is_within)
{
	const struct asking_answer *a = t->answer;

	talk->is_several = a->count > 1;
	if (a->count > 1) {
		talk->set = (struct meaning_set){.n = a->count};
		for (size_t k = 0; k < a->count; k++)
			if (a->things[k] < MEANING_SET)
				talk->set.is[a->things[k]] = 1;
		find_noun(&talk->set, t);
	}
	if (!is_within)
		talk->of = a->count > 1 ? talk->set : (struct meaning_set){0};
}

/* "the mug and the cup": of an answer of two, and of a question about two. */
static void take_things(struct talk *talk, const struct answer_told *t, int is_within)
{
	const struct asking_answer *a = t->answer;
	const int kind = t->asked.kind;

	*talk->things = 0;
	if (kind == QUESTION_WHETHER || kind == QUESTION_MORE || kind == QUESTION_COMPARE) {
		const char *second = t->asked.text[1];
		const char *at = kind == QUESTION_WHETHER ? strstr(second, " the ") : second;
		const size_t length = strlen(t->asked.text[0]);
		if (kind == QUESTION_WHETHER && !strncmp(second, t->asked.text[0], length))
			at = strstr(second + length, " the ");
		if (at && length + strlen(at) + 8 < sizeof talk->things)
			snprintf(talk->things, CALLING_TEXT, "%.100s and %.100s", t->asked.text[0],
				at + (*at == ' '));
		if (!is_within)
			talk->set = talk->of = (struct meaning_set){0};
		return;
	}
	char *const *names = t->asking->model.lifted.names;
	if (a->count == 2)
		snprintf(talk->things, CALLING_TEXT, "the %.100s and the %.100s", names[a->things[0]],
			names[a->things[1]]);
	take_set(talk, t, is_within);
}

void talk_take(struct talk *talk, const struct answer_told *t, int is_within)
{
	const struct asking_answer *a = t->answer;

	if (!a->count)
		return;
	const size_t thing = a->things[0], before[2] = {talk->thing, talk->other};
	const int was_unsure = talk->is_unsure;
	talk->thing = thing;
	talk->is_unsure = t->is_unsure;
	talk->other = a->count == 2	   ? a->things[1]
		      : t->is_unsure	   ? a->runner_up
		      : !was_unsure	   ? find_other(talk, t, thing)
		      : thing == before[0] ? before[1]
		      : thing == before[1] ? before[0]
					   : find_other(talk, t, thing);
	take_things(talk, t, is_within || (*talk->things && strstr(t->understood, talk->things)));
	memcpy(talk->question, t->understood, sizeof talk->question);
}
