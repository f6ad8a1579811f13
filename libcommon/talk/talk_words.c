#include "talk/talk_words.h"

#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/tokens.h"

#include <stdio.h>
#include <string.h>

void talk_name_words(const char *name, int is_noun, char words[TALK_TEXT])
{
	struct tokens t;
	size_t n = 0;

	*words = 0;
	tokens_take(&t, name, NULL, NULL, 0);
	for (int i = 0; i < t.n && n < TALK_TEXT; i++)
		if (strspn(t.word[i].text, "0123456789") < strlen(t.word[i].text)) {
			n = is_noun ? 0 : n;
			n += (size_t)snprintf(
				words + n, TALK_TEXT - n, "%s%s", n ? " " : "", t.word[i].lemma);
		}
}

/* Whether a thing is named in the question before word i, which then points to that: "the plate with nothing
 * on it", but not "is the plate larger than it?". Its words are *of, up to a pause, where there is one
 * between. */
static int is_named_before(const struct tokens *t, int i, struct parse_span *of)
{
	static const unsigned clauses = 1U << CLOSED_WITH | 1U << CLOSED_HAVE | 1U << CLOSED_RELATIVE |
					1U << CLOSED_NEGATION | 1U << CLOSED_CONJUNCTION;
	int is_definite = 0, is_the = 0, is = 0, begin = 0, is_clause = 0;

	*of = (struct parse_span){0};
	for (int k = 0; k < i; k++) {
		const int class = tokens_class(t, k);
		is_clause |= is && class >= 0 && clauses >> class & 1;
		if (is && t->word[k].before && !of->end && is_the)
			*of = (struct parse_span){t->word[begin].span.begin, t->word[k - 1].span.end};
		if (!is && (class == CLOSED_DETERMINER || tokens_is(t, k, "which|many"))) {
			is_definite = 1;
			is_the = class == CLOSED_DETERMINER;
			begin = k;
		} else if ((class < 0 || tokens_is(t, k, "one")) && is_definite) {
			is = 1;
		} else if (class >= 0 && class != CLOSED_SIZE && class != CLOSED_ATTRIBUTE &&
			   class != CLOSED_ORDINAL) {
			is_definite = 0;
		}
	}
	if (is && t->word[i].before && !of->end && is_the)
		*of = (struct parse_span){t->word[begin].span.begin, t->word[i - 1].span.end};
	return is && (is_clause || of->end);
}

/* What a word points back to. */
struct pointed {
	const char *article, *to, *tail; /* "the ", "mug", "'s"; to is NULL: nothing */
	int end;			 /* the word behind it */
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

int talk_says_look(const struct tokens *t, int i)
{
	return tokens_class(t, i) == CLOSED_ATTRIBUTE ||
	       (i >= 0 && i < t->n && colour_word(t->word[i].text) >= 0);
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

const char *talk_plural_end(const char *noun)
{
	const size_t n = strlen(noun);

	return n && strchr("sxh", noun[n - 1]) ? "es" : "s";
}

/* topic is where a thing is written that the question begins with: "the mug, how tall is it?" */
static struct pointed points_to(
	const struct tokens *t, int i, const struct referents *r, char topic[TALK_TEXT], const char *question)
{
	static const char it[] = "it|him|her|he|she";
	static const char that[] = "that|this";
	static const char those[] = "they|them|those|these";
	struct parse_span of;
	const int class = tokens_class(t, i + 1), before = i ? tokens_class(t, i - 1) : CLOSED_CONJUNCTION;
	/* behind a noun, as of "everything that is red" and "that one can lift", a clause begins */
	const int is_who =
		(before < 0 || before == CLOSED_GENERIC) && tokens_class(t, i + 2) == CLOSED_AUXILIARY;
	const int is_one = (tokens_is(t, i + 1, "one") || tokens_is(t, i + 1, "thing")) && !is_who;
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
		snprintf(topic, TALK_TEXT, "%.*s", of.end - of.begin, question + of.begin);
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
	const char *noun = !is_noun ? "" : talk_says_look(t, i - 1) ? r->kind : r->noun;
	return (struct pointed){
		"", *noun ? noun : NULL, tokens_is(t, i, "ones") ? talk_plural_end(noun) : "", i + 1};
}

unsigned talk_put_pointed(const struct referents *r, const char *question, char understood[QUESTION_TEXT])
{
	char topic[TALK_TEXT];
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

/* "how many don't?", "which ones aren't?": what it asks for of the others, with a %s for them; NULL. */
static const char *find_denied(const struct tokens *t)
{
	static const unsigned verbs = 1U << CLOSED_BE | 1U << CLOSED_HAVE | 1U << CLOSED_AUXILIARY;
	int i = tokens_is(t, 0, "and|but|so");
	const int is_many = tokens_is(t, i, "how") && tokens_is(t, i + 1, "many");

	if (!is_many && !tokens_is(t, i, "which|what"))
		return NULL;
	i += is_many ? 2 : 1 + tokens_is(t, i + 1, "one|ones");
	i += 2 * (tokens_is(t, i, "of") && tokens_is(t, i + 1, "them|those|these"));
	if (i + 2 != t->n || tokens_class(t, i) < 0 || !(verbs >> tokens_class(t, i) & 1) ||
		!tokens_is(t, i + 1, "not|n't"))
		return NULL;
	return is_many ? "how many %s%s are there" : "the %s%s";
}

/* "the rest", "the others", "the remaining two of them", "any others": how many words from word i on are the
 * whole of it but for "any". */
static int rest_length(const struct tokens *t, int i)
{
	const int is_the = tokens_is(t, i, "the");
	const int is_more = is_the && tokens_is(t, i + 1, "other|remaining") &&
			    tokens_is(t, i + 2, "ones|two|three|four");
	const int n = is_more  ? 3
		      : is_the ? 2 * tokens_is(t, i + 1, "rest|others")
			       : tokens_is(t, i, "others");

	return n && tokens_is(t, i + n, "of") && tokens_is(t, i + n + 1, "them|those|these") ? n + 2 : n;
}

/* "How many?" and "how many are there?" */
static int is_bare_count(const struct tokens *t)
{
	const int i = tokens_is(t, 0, "and|so");
	const int is_there = tokens_is(t, i + 2, "are") && tokens_is(t, i + 3, "there");

	return tokens_is(t, i, "how") && tokens_is(t, i + 1, "many") && t->n == i + 2 + 2 * is_there;
}

int talk_put_rest(const struct meaning_set *rest, const char *question, char to[QUESTION_TEXT])
{
	const char *noun = *rest->noun ? rest->noun : "thing",
		   *plural = rest->n > 1 ? talk_plural_end(noun) : "";
	struct tokens t;
	int i = 0;

	tokens_take(&t, question, NULL, NULL, 0);
	snprintf(to, QUESTION_TEXT, "%s", is_bare_count(&t) ? "how many of those are there?" : question);
	const char *denied = rest->n ? find_denied(&t) : NULL;
	if (denied) {
		snprintf(to, QUESTION_TEXT, denied, noun, *denied == 'h' ? talk_plural_end(noun) : plural);
		return 1;
	}
	while (i < t.n && !rest_length(&t, i))
		i++;
	if (i == t.n || !rest->n)
		return 0;
	snprintf(to, QUESTION_TEXT, "%.*s%s%s%s%s", t.word[i].span.begin, question,
		tokens_is(&t, i, "the") ? "the " : "", noun, plural,
		question + t.word[i + rest_length(&t, i) - 1].span.end);
	return 1;
}

int talk_points(const char *question)
{
	const struct referents nothing = {0};
	char topic[TALK_TEXT];
	struct tokens t;

	tokens_take(&t, question, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++)
		if (points_to(&t, i, &nothing, topic, question).to)
			return 1;
	return 0;
}
