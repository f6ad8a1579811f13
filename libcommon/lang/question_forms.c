#include "lang/question_forms.h"

#include "lang/question_said.h"
#include "lang/wordnet.h"

#include <string.h>

/* Whether a token asks for a number: "how many", "what number", "the total of", or at an end: "qty", "boxes:
 * count?" */
static int is_cue(const struct asked *q, int i)
{
	static const char nouns[] = "number|count|quantity|qty|nr|total|tally|sum|figure|headcount|units";
	const struct tokens *t = q->t;

	if (tokens_is(t, i, "many|much"))
		return tokens_is(t, i - 1, "how") && !is_class(t, i + 1, CLOSED_SIZE) &&
		       !is_class(t, i + 1, CLOSED_PLACE);
	if (tokens_is(t, i, "tot"))
		return tokens_is(t, i + 1, "up");
	if (!tokens_is(t, i, nouns) || tokens_is(t, i + 1, "from|along") ||
		is_class(t, i + 1, CLOSED_NUMBER) || is_class(t, i + 1, CLOSED_ORDINAL))
		return 0; /* "count from the left", "number two" */
	const int is_end = i + 1 == asked_end_of(q, i) && !is_class(t, i - 1, CLOSED_DETERMINER);
	return is_end || asked_begin_of(q, i) == i || tokens_is(t, i - 1, "what") ||
	       (tokens_is(t, i + 1, "of|for") && tokens_is(t, i - 1, "the|a|what|head"));
}

static int begins_thing(const struct tokens *t, int i)
{
	static const unsigned of_thing = 1U << CLOSED_DETERMINER | 1U << CLOSED_NUMBER |
					 1U << CLOSED_GENERIC | 1U << CLOSED_SIZE | 1U << CLOSED_ATTRIBUTE;
	const int class = tokens_class(t, i);

	return class < 0 ? asked_is_content(t, i) || wordnet_is_adjective(t->word[i].lemma)
			 : of_thing >> class & 1;
}

/* Without words at its ends that say nothing of the things: "add the mugs and cups together". */
static struct part trim(const struct tokens *t, struct part p)
{
	static const char before[] = "of|for|up|add|take|the|all",
			  after[] = "together|up|please|what|that|altogether|is|'s|the";

	while (p.begin < p.end &&
		(tokens_is(t, p.begin, before) || question_is_idle(t, p.begin) || !begins_thing(t, p.begin)))
		p.begin++;
	while (p.end > p.begin && (tokens_is(t, p.end - 1, after) || question_is_idle(t, p.end - 1)))
		p.end--;
	return p;
}

/* "Mug, jug, tin: how many of them are blue?" */
static int say_number_of(struct asked *q, struct part rest)
{
	struct part items[ITEMS];
	static const unsigned idle = 1U << CLOSED_AUXILIARY | 1U << CLOSED_PRONOUN | 1U << CLOSED_HAVE;
	const int n = asked_list(q, items);

	while (rest.begin < rest.end && (is_class(q->t, rest.begin, CLOSED_BE) ||
						tokens_is(q->t, rest.begin, "of|them|these|those|the|there")))
		rest.begin++;
	const int class = rest.begin < rest.end ? tokens_class(q->t, rest.begin) : -1;
	if (n < 2 || rest.begin >= rest.end || items[n - 1].end > rest.begin ||
		(class >= 0 && idle >> class & 1))
		return 0; /* "do you get" */
	asked_put_list(q, items, n, " and ");
	asked_put(q, " that are ");
	asked_put_part(q, rest);
	return 1;
}

static int say_number(struct asked *q)
{
	const struct tokens *t = q->t;
	int cue = 0;

	while (cue < t->n && !is_cue(q, cue))
		cue++;
	if (cue == t->n)
		return 0;
	const int begin = asked_begin_of(q, cue), end = asked_end_of(q, cue);
	const struct part places[] = {{cue + 1, end}, {begin, cue}, {0, begin}, {end, t->n}};
	for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
		const struct part rest = trim(t, places[k]);
		if (rest.begin >= rest.end || !asked_has_content(t, rest))
			continue;
		const int is_all = tokens_is(t, rest.begin, "everything|whatever");
		asked_put(q, is_all ? "how many things " : "how many ");
		if (rest.begin + is_all < rest.end)
			asked_put_part(q, (struct part){rest.begin + is_all, rest.end});
		return 1;
	}
	return 0;
}

/* Whether a part of a question only asks whether the rest is so: "is there?", 1; "true or false?", "is that
 * correct?", 2. */
static int is_tag(const struct tokens *t, struct part p)
{
	const int verb = p.begin + tokens_is(t, p.begin, "or|and");
	int is_judged = 0, is_asked = 0;

	for (int i = p.begin; i < p.end; i++) {
		is_judged |= tokens_is(t, i, "true|false|right|wrong|correct|hold|holds|yes|no|fact");
		is_asked |= is_class(t, i, CLOSED_PRONOUN);
	}
	is_asked &= is_class(t, verb, CLOSED_BE) || is_class(t, verb, CLOSED_AUXILIARY) ||
		    is_class(t, verb, CLOSED_HAVE);
	return p.end - p.begin > 5 ? 0 : is_judged ? 2 : is_asked;
}

/* The sentence that is to be confirmed, without its tags; *tags: those of is_tag. */
static struct part find_statement(const struct asked *q, unsigned *tags)
{
	struct part p = {0, q->t->n};
	int tag;

	for (*tags = 0; p.end; p.end = asked_begin_of(q, p.end - 1)) {
		const int begin = asked_begin_of(q, p.end - 1);
		tag = begin ? is_tag(q->t, (struct part){begin, p.end}) : 0;
		if (!tag)
			break;
		*tags |= 1U << tag;
	}
	p.begin = asked_begin_of(q, p.end - 1);
	if (p.begin && (tag = is_tag(q->t, (struct part){0, asked_end_of(q, 0)})))
		*tags |= 1U << tag;
	return p;
}

/* What is said, by which verb, behind which thing: "the mug", "stands" and "on the tray". */
struct statement {
	struct part of;
	int verb, rest; /* where what is said begins; verb is of.end where there is none */
	enum { SAID_BE, SAID_THERE, SAID_HAVE } by;
};

/* Where a statement's thing ends that has no verb: "kettle left of the laptop, right?" */
static int find_place(const struct tokens *t, struct part p)
{
	int i = p.begin;

	while (i < p.end && !is_class(t, i, CLOSED_PLACE))
		i++;
	return asked_has_content(t, (struct part){p.begin, i}) ? i : p.end;
}

/* is_ours: of what we have or see; tags: of find_statement, by which it is to be confirmed. */
static int find_verb(struct statement *s, const struct tokens *t, int is_ours, unsigned tags)
{
	static const char poses[] =
		"stand|stands|sit|sits|lie|lies|hang|hangs|rest|rests|lean|leans|stay|stays";
	const struct part p = s->of;
	const int is_sure = tags != 0;
	int i = p.begin;

	if (is_ours && (is_class(t, i, CLOSED_HAVE) || (is_sure && tokens_is(t, i, "see|spot|notice")))) {
		*s = (struct statement){{i, i}, i, i + 1 + tokens_is(t, i + 1, "got"), SAID_THERE};
		return 1;
	}
	while (i < p.end && !is_class(t, i, CLOSED_BE) &&
		!(is_sure && i > p.begin && (tokens_is(t, i, poses) || is_class(t, i, CLOSED_HAVE))))
		i++;
	s->by = is_class(t, i, CLOSED_HAVE) ? SAID_HAVE : tokens_is(t, i - 1, "there") ? SAID_THERE : SAID_BE;
	s->rest = i + 1;
	if (i == p.end && tags & 4)
		s->rest = i = find_place(t, p);
	s->of.end = s->verb = i;
	return i < p.end && s->rest < p.end &&
	       (s->by == SAID_THERE || asked_has_content(t, (struct part){p.begin, i}));
}

/* "There's no cat, is there?", "you have a cat?": is there a cat? "The cat is black?": is the cat black? */
static int say_statement(struct asked *q)
{
	static const unsigned other = 1U << CLOSED_RELATIVE | 1U << CLOSED_AUXILIARY;
	const struct tokens *t = q->t;
	unsigned tags;
	struct part p = find_statement(q, &tags);
	int is_told = 0, is_ours = 0, is_asked = tags || (!p.begin && p.end == t->n && strchr(q->text, '?'));
	struct statement s;

	for (; p.begin < p.end && !tokens_is(t, p.begin, "there|none|not") &&
		(tokens_is(t, p.begin, "surely|that") || question_is_idle(t, p.begin)) &&
		!(is_ours && tokens_is(t, p.begin, "see"));
		p.begin++) {
		is_told |= tokens_is(t, p.begin, "tell|say|know|wonder|check|see");
		is_asked |= is_told && tokens_is(t, p.begin, "if|whether");
		is_ours |= is_class(t, p.begin, CLOSED_PRONOUN);
	}
	s.of = p;
	if (!is_asked || !find_verb(&s, t, is_ours, tags))
		return 0;
	for (int i = p.begin; i < p.end; i++)
		if (tokens_class(t, i) >= 0 && other >> tokens_class(t, i) & 1 &&
			(i < s.verb || !tokens_is(t, i, "that")))
			return 0;
	while (tags & 2 && s.rest < p.end && tokens_is(t, s.rest, "not|n't|no"))
		s.rest++;
	if (s.rest >= p.end)
		return 0;
	asked_put(q, s.by == SAID_HAVE			    ? "does "
		     : s.by == SAID_BE			    ? "is "
		     : tokens_is(t, s.verb, "are|'re|were") ? "are there "
							    : "is there ");
	if (s.by != SAID_THERE && tokens_is(t, s.of.begin, "not")) {
		asked_put(q, "none");
		s.of.begin += 1 + tokens_is(t, s.of.begin + 1, "one|a");
	}
	if (s.by != SAID_THERE && s.of.begin < s.of.end) {
		asked_put(q, tokens_is(t, s.of.begin, "of") ? " " : "");
		asked_put_part(q, s.of);
		asked_put(q, s.by == SAID_HAVE ? " have " : " ");
	}
	asked_put_part(q, (struct part){s.rest, p.end});
	return 1;
}

int question_say_list(char *to, size_t size, const struct tokens *t, const char *text)
{
	struct asked q = {t, text, to, size, 0};
	int cue = 0;

	*to = 0;
	while (cue < t->n && !is_cue(&q, cue))
		cue++;
	return cue < t->n && say_number_of(&q, (struct part){cue + 1, asked_end_of(&q, cue)});
}

int question_say_again(char *to, size_t size, const struct tokens *t, const char *text)
{
	struct asked q = {t, text, to, size, 0};

	*to = 0;
	if (!t->n)
		return 0;
	if (say_number(&q))
		return 1;
	if (question_wants_yes(t, text))
		return 0;
	q.n = 0;
	if (asked_say_choice(&q))
		return 1;
	q.n = 0;
	return say_statement(&q);
}
