#include "lang/question_forms.h"

#include "lang/closed.h"
#include "lang/question_match.h"
#include "lang/wordnet.h"

#include <stdio.h>
#include <string.h>

enum { ITEMS = 8 }; /* of a list that is chosen from */

/* From one token up to another. */
struct part {
	int begin, end;
};

struct asked {
	const struct tokens *t;
	const char *text;
	char *to;
	size_t size, n;
};

static int is_class(const struct tokens *t, int i, enum closed_class class)
{
	return tokens_class(t, i) == (int)class;
}

static int is_content(const struct tokens *t, int i)
{
	return i < t->n && tokens_class(t, i) < 0 && wordnet_is_noun(t->word[i].lemma) &&
	       !tokens_is(t, i, "make|makes|come|comes|lay|laid");
}

static void put(struct asked *q, const char *words)
{
	const size_t n = strlen(words);

	if (q->n + n < q->size) {
		memcpy(q->to + q->n, words, n + 1);
		q->n += n;
	}
}

static void put_part(struct asked *q, struct part p)
{
	const int begin = q->t->word[p.begin].span.begin, end = q->t->word[p.end - 1].span.end;

	if (q->n + (size_t)(end - begin) < q->size) {
		memcpy(q->to + q->n, q->text + begin, (size_t)(end - begin));
		q->n += (size_t)(end - begin);
		q->to[q->n] = 0;
	}
}

/* The end of the part of a sentence that begins at a token. */
static int end_of(const struct asked *q, int begin)
{
	int end = begin + 1;

	while (end < q->t->n && !question_is_break(q->t, q->text, end))
		end++;
	return end;
}

static int begin_of(const struct asked *q, int i)
{
	while (i > 0 && !question_is_break(q->t, q->text, i))
		i--;
	return i;
}

/* Whether a token asks for a number: "how many", "what number", "the total of", or at an end: "qty", "boxes:
 * count?" */
static int is_cue(const struct asked *q, int i)
{
	static const char nouns[] = "number|count|quantity|qty|total|tally|sum|figure|headcount|units";
	const struct tokens *t = q->t;

	if (tokens_is(t, i, "many|much"))
		return tokens_is(t, i - 1, "how") && !is_class(t, i + 1, CLOSED_SIZE) &&
		       !is_class(t, i + 1, CLOSED_PLACE);
	if (tokens_is(t, i, "tot"))
		return tokens_is(t, i + 1, "up");
	if (!tokens_is(t, i, nouns) || tokens_is(t, i + 1, "from|along") ||
		is_class(t, i + 1, CLOSED_NUMBER) || is_class(t, i + 1, CLOSED_ORDINAL))
		return 0; /* "count from the left", "number two" */
	const int is_end = i + 1 == end_of(q, i) && !is_class(t, i - 1, CLOSED_DETERMINER);
	return is_end || begin_of(q, i) == i || tokens_is(t, i - 1, "what") ||
	       (tokens_is(t, i + 1, "of|for") && tokens_is(t, i - 1, "the|a|what|head"));
}

static int has_content(const struct tokens *t, struct part p)
{
	for (int i = p.begin; i < p.end; i++)
		if (is_content(t, i) || is_class(t, i, CLOSED_GENERIC) || tokens_is(t, i, "everything"))
			return 1;
	return 0;
}

static int begins_thing(const struct tokens *t, int i)
{
	static const unsigned of_thing = 1U << CLOSED_DETERMINER | 1U << CLOSED_NUMBER |
					 1U << CLOSED_GENERIC | 1U << CLOSED_SIZE | 1U << CLOSED_ATTRIBUTE;
	const int class = tokens_class(t, i);

	return class < 0 ? is_content(t, i) || wordnet_is_adjective(t->word[i].lemma) : of_thing >> class & 1;
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

static int say_number(struct asked *q)
{
	const struct tokens *t = q->t;
	int cue = 0;

	while (cue < t->n && !is_cue(q, cue))
		cue++;
	if (cue == t->n)
		return 0;
	const int begin = begin_of(q, cue), end = end_of(q, cue);
	const struct part places[] = {{cue + 1, end}, {begin, cue}, {0, begin}, {end, t->n}};
	for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
		const struct part rest = trim(t, places[k]);
		if (rest.begin >= rest.end || !has_content(t, rest))
			continue;
		const int is_all = tokens_is(t, rest.begin, "everything|whatever");
		put(q, is_all ? "how many things " : "how many ");
		if (rest.begin + is_all < rest.end)
			put_part(q, (struct part){rest.begin + is_all, rest.end});
		return 1;
	}
	return 0;
}

/* The things of a list, from a token on; returns how many. */
static int take_list(const struct asked *q, int at, struct part items[ITEMS])
{
	static const unsigned of_thing = 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE;
	const struct tokens *t = q->t;
	int n = 0;

	while (n < ITEMS) {
		int end = at;
		while (end < t->n && (tokens_class(t, end) < 0 || of_thing >> tokens_class(t, end) & 1) &&
			(end == at || (!question_is_break(t, q->text, end) &&
					      !is_class(t, end, CLOSED_DETERMINER))) &&
			!tokens_is(t, end, "vs|versus|or|and"))
			end++;
		if (end == at || !is_content(t, end - 1))
			break;
		items[n++] = (struct part){at, end};
		at = end + tokens_is(t, end, "and|or|vs|versus");
		if (at == end && !(end < t->n && q->text[t->word[end - 1].span.end] == ','))
			break;
	}
	return n;
}

/* By what is chosen, and which in that order. */
struct order {
	const char *word; /* "tallest"; NULL: none */
	char made[TOKEN_LENGTH];
	int at, place;	    /* its token, -1; the second, 0: the first */
	struct part anchor; /* of "nearer to the mug" */
};

/* "Greatest height": tallest. */
static const char *by_noun(const struct tokens *t, int noun)
{
	static const char *const words[][3] = {{"height", "tallest", "shortest"},
		{"width", "widest", "narrowest"}, {"length", "longest", "shortest"},
		{"size", "largest", "smallest"}};
	int is_least = 0;

	for (int i = 0; i < t->n; i++)
		is_least |=
			tokens_is(t, i, "least|lowest|smallest|shortest|less|lower|smaller|shorter|minimum");
	for (size_t k = 0; k < sizeof words / sizeof *words; k++)
		if (tokens_is(t, noun, words[k][0]))
			return words[k][1 + is_least];
	return NULL;
}

/* What something is nearer to: "nearer to the mug", "the mug's nearer neighbour". */
static struct part find_anchor(const struct asked *q, int at, struct part list)
{
	const struct tokens *t = q->t;
	int i = at;

	if (tokens_is(t, at + 1, "to|from")) {
		const int end = end_of(q, at);
		return (struct part){at + 2, at < list.begin && list.begin < end ? list.begin : end};
	}
	if (!tokens_is(t, at - 1, "'s"))
		return (struct part){0, 0};
	while (i > 0 && !is_class(t, i, CLOSED_DETERMINER) && !is_class(t, i - 1, CLOSED_BE))
		i--;
	return (struct part){i, at - 1};
}

static struct order find_order(const struct asked *q, struct part list)
{
	const struct tokens *t = q->t;
	struct order o = {.at = -1};

	for (int i = 0; i < t->n; i++) {
		if (i >= list.begin && i < list.end)
			continue;
		const int class = tokens_class(t, i);
		const struct closed_word *w = class < 0 ? NULL : &closed_words[t->word[i].closed];
		const char *noun = by_noun(t, i);
		if (class == CLOSED_ORDINAL && w->value > 1)
			o.place = w->value;
		if (tokens_is(t, i, "middle"))
			o.place = 2;
		if (noun)
			o.word = noun;
		else if ((class == CLOSED_SIZE || class == CLOSED_PLACE) && w->value != PARSE_PLAIN &&
			 !o.word) {
			o.word = t->word[i].text;
			o.at = i;
		}
	}
	if (o.at >= 0 && o.word == t->word[o.at].text)
		o.anchor = find_anchor(q, o.at, list);
	return o;
}

/* "Taller" is "tallest", of more than two. */
static void put_most(struct asked *q, const char *word)
{
	const size_t n = strlen(word);

	put(q, word);
	if (n > 3 && !strcmp(word + n - 2, "er") && q->n >= 2) {
		q->n -= 2;
		put(q, "est");
	}
}

static void put_list(struct asked *q, const struct part *items, int n, const char *last)
{
	for (int k = 0; k < n; k++) {
		put(q, !k ? "" : k + 1 < n ? ", " : last);
		if (!is_class(q->t, items[k].begin, CLOSED_DETERMINER))
			put(q, "the ");
		put_part(q, items[k]);
	}
}

static int say_choice(struct asked *q)
{
	static const char order_verbs[] = "rank|order|sort|compare|arrange|put|line|list|take";
	struct part items[ITEMS], best[ITEMS];
	int n = 0, is_asked = strpbrk(q->text, "?:") != NULL;

	for (int at = 0; at < q->t->n; at++) {
		is_asked |= tokens_is(q->t, at, order_verbs);
		const int k = tokens_is(q->t, at, order_verbs) ? 0 : take_list(q, at, items);
		if (k > n)
			memcpy(best, items, sizeof best);
		n = k > n ? k : n;
	}
	if (n < 2 || !is_asked)
		return 0;
	const struct order o = find_order(q, (struct part){best[0].begin, best[n - 1].end});
	const int is_near = o.at >= 0 && (closed_words[q->t->word[o.at].closed].relation == PARSE_NEAR ||
						 closed_words[q->t->word[o.at].closed].relation == PARSE_FAR);
	if (!o.word || (is_near && o.anchor.begin >= o.anchor.end))
		return 0;
	if (n > 2 || o.place) {
		static const char *const places[] = {"", "", "second ", "third ", "fourth ", "fifth "};
		put(q, "the ");
		put(q, o.place < 6 ? places[o.place] : "");
		put_most(q, o.word);
		put(q, " of ");
		put_list(q, best, n, " and ");
		return !is_near;
	}
	put(q, "which is ");
	put(q, o.word);
	put(q, tokens_is(q->t, o.at + 1, "up|down") ? " up" : "");
	if (is_near) {
		put(q, " to ");
		put_part(q, o.anchor);
	}
	put(q, ", ");
	put_list(q, best, n, " or ");
	return 1;
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

	for (*tags = 0; p.end; p.end = begin_of(q, p.end - 1)) {
		const int begin = begin_of(q, p.end - 1);
		tag = begin ? is_tag(q->t, (struct part){begin, p.end}) : 0;
		if (!tag)
			break;
		*tags |= 1U << tag;
	}
	p.begin = begin_of(q, p.end - 1);
	if (p.begin && (tag = is_tag(q->t, (struct part){0, end_of(q, 0)})))
		*tags |= 1U << tag;
	return p;
}

/* "There's no cat, is there?", "you have a cat?": is there a cat? "The cat is black?": is the cat black? */
static int say_statement(struct asked *q)
{
	static const unsigned other = 1U << CLOSED_RELATIVE | 1U << CLOSED_AUXILIARY;
	const struct tokens *t = q->t;
	unsigned tags;
	struct part p = find_statement(q, &tags);
	int is_told = 0, is_ours = 0, is_asked = tags || (!p.begin && p.end == t->n && strchr(q->text, '?'));

	for (; p.begin < p.end && !tokens_is(t, p.begin, "there|none|not") &&
		(tokens_is(t, p.begin, "surely|that") || question_is_idle(t, p.begin));
		p.begin++) {
		is_told |= tokens_is(t, p.begin, "tell|say|know|wonder|check|see");
		is_asked |= is_told && tokens_is(t, p.begin, "if|whether");
		is_ours |= is_class(t, p.begin, CLOSED_PRONOUN);
	}
	int verb = p.begin;
	while (verb < p.end && !is_class(t, verb, CLOSED_BE) &&
		!(is_ours && verb == p.begin && is_class(t, verb, CLOSED_HAVE)))
		verb++;
	const int is_owned = is_class(t, verb, CLOSED_HAVE);
	const int is_there = is_owned || tokens_is(t, verb - 1, "there");
	if (!is_asked || verb >= p.end - 1 || (!is_there && !has_content(t, (struct part){p.begin, verb})))
		return 0;
	for (int i = p.begin; i < p.end; i++)
		if (tokens_class(t, i) >= 0 && other >> tokens_class(t, i) & 1 &&
			(i < verb || !tokens_is(t, i, "that")))
			return 0;
	int rest = verb + 1 + (is_owned && tokens_is(t, verb + 1, "got"));
	while (tags & 2 && rest < p.end && tokens_is(t, rest, "not|n't|no"))
		rest++;
	if (rest >= p.end)
		return 0;
	put(q, is_there && !tokens_is(t, verb, "are|'re|were") ? "is there "
		: is_there				       ? "are there "
							       : "is ");
	if (!is_there && tokens_is(t, p.begin, "not")) {
		put(q, "none");
		p.begin += 1 + tokens_is(t, p.begin + 1, "one|a");
	}
	if (!is_there && p.begin < verb) {
		put(q, tokens_is(t, p.begin, "of") ? " " : "");
		put_part(q, (struct part){p.begin, verb});
		put(q, " ");
	}
	put_part(q, (struct part){rest, p.end});
	return 1;
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
	if (say_choice(&q))
		return 1;
	q.n = 0;
	return say_statement(&q);
}
