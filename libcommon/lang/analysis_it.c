/* What closed-class words settle besides (analysis_mend.c): what "it" is, what stands by itself, and from
 * which of two things a place is said. */
#include "lang/analysis.h"
#include "lang/closed.h"

/* Words between a place and "it". */
enum { PLACE_REACH = 4 };

/* "everything" after "from", as in "away from everything else"; or -1. */
static int everything_after(const struct tokens *t, int predicate)
{
	static const char *const all[] = {"everything", "anything", NULL};

	for (int i = predicate + 1; i < predicate + 3; i++)
		if (tokens_is(t, i, "from") && tokens_is_any(t, i + 1, all))
			return i + 1;
	return -1;
}

/* 1 where a predicate is "near" nothing or "far" from everything, but for the words that turn it round. */
static int is_alone(const struct analysis *a, const struct tokens *t, int i)
{
	static const char *const by[] = {"itself", "themselves", "alone", NULL};
	const int all = everything_after(t, i);

	if (a->word[i].relation == PARSE_FAR && all >= 0)
		return !analysis_has_anchor(a, i) || a->word[all].head == i;
	return a->word[i].relation == PARSE_NEAR && !analysis_has_anchor(a, i) &&
	       (tokens_is_any(t, i, by) || tokens_is_any(t, i + 1, by));
}

/* "by itself", "all alone", "isolated", "far from everything else": near nothing. */
static void mend_alone(struct analysis *a, const struct tokens *t)
{
	static const char *const lone[] = {"isolated", "solitary", "secluded", NULL};

	for (int i = 0; i < t->n; i++) {
		struct analysis_word *w = &a->word[i];
		int negated = 1;
		if ((w->role == ROLE_ATTRIBUTE || w->role == ROLE_NAME) && tokens_is_any(t, i, lone)) {
			*w = (struct analysis_word){ROLE_PREDICATE, w->head, PARSE_NEAR, 1};
			continue;
		}
		if (!analysis_is_predicate(a, i) || !is_alone(a, t, i))
			continue;
		for (int j = i - 1; j >= 0 && j >= i - 3 && !t->word[j + 1].before; j--)
			negated &= tokens_class(t, j) != CLOSED_NEGATION;
		if (analysis_has_anchor(a, i))
			analysis_give_up(&a->word[everything_after(t, i)]);
		w->relation = PARSE_NEAR;
		w->negated = negated;
	}
}

/* "it" after a place without an anchor: "to the side of it"; or -1. */
static int it_after(const struct analysis *a, const struct tokens *t, int predicate)
{
	for (int i = predicate + 1; i < t->n && i <= predicate + PLACE_REACH && !t->word[i].before; i++) {
		if (tokens_is(t, i, "it") || tokens_is(t, i, "them"))
			return a->word[i].role == ROLE_NONE ? i : -1;
		if (a->word[i].role != ROLE_NONE || tokens_class(t, i) == CLOSED_BE ||
			tokens_class(t, i) == CLOSED_VIEW)
			return -1;
	}
	return -1;
}

/* Whether a word says that something has something. */
static int is_having(const struct tokens *t, int i)
{
	const int class = tokens_class(t, i);

	return class == CLOSED_WITH || class == CLOSED_HAVE || tokens_is(t, i, "without");
}

/* "near the sink but not over it": the sink, unless what comes between has something, which would be what
 * "it" is. parse_settle finds the sink's words. */
static void mend_it_again(struct analysis *a, const struct tokens *t)
{
	int earlier = 0, has = 0;

	for (int i = 0; i < t->n; i++) {
		has = t->word[i].before ? 0 : has;
		if (earlier && !has && analysis_is_predicate(a, i) && tokens_class(t, i) == CLOSED_PLACE &&
			!analysis_has_anchor(a, i) && a->word[i].relation != PARSE_SUPPORTS) {
			const int it = it_after(a, t, i);
			if (it >= 0 && tokens_class(t, it + 1) != CLOSED_BE)
				a->word[it] = (struct analysis_word){.role = ROLE_ANCHOR, .head = i};
		}
		/* "the jug I want is over it" may speak of another */
		earlier = a->word[i].role == ROLE_ANCHOR ||
			  (earlier && t->word[i].closed >= 0 && tokens_class(t, i) != CLOSED_GENERIC);
		has |= is_having(t, i) || tokens_is(t, i, "there");
	}
}

/* "which ball has a book just behind it and a cup on its left?" is in front of the book, right of the cup. */
static void mend_has_it(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		const enum parse_relation said =
			tokens_class(t, i) == CLOSED_PLACE
				? (enum parse_relation)closed_words[t->word[i].closed].relation
				: PARSE_OTHER;
		int has, anchor = -1;
		const int is_of_it = tokens_is(t, i - 1, "its") || tokens_is(t, i + 1, "it") ||
				     (tokens_is(t, i + 1, "of") && tokens_is(t, i + 2, "it"));
		if (!analysis_is_predicate(a, i) || said > PARSE_ON || a->word[i].relation != said ||
			!is_of_it)
			continue;
		for (int j = 0; j < i; j++)
			anchor = a->word[j].role == ROLE_ANCHOR && a->word[j].head == i ? j : anchor;
		for (has = anchor; has > 0 && !(is_having(t, has) || tokens_is(t, has, "no")); has--)
			if (t->word[has].before == PAUSE_STOP || a->word[has].role == ROLE_TARGET)
				break;
		if (anchor > 0 && (is_having(t, has) || tokens_is(t, has, "no")))
			a->word[i].relation = closed_inverse(said);
	}
}

/* Whether a word of the class is among from..to-1. */
static int has_class(const struct tokens *t, int from, int to, enum closed_class class)
{
	for (int i = from; i < to; i++)
		if (tokens_class(t, i) == (int)class)
			return 1;
	return 0;
}

/* The last phrase before word i, or -1. */
static int phrase_before(const struct analysis *a, int i)
{
	for (i--; i >= 0; i--)
		if (role_is_phrase(a->word[i].role))
			return i;
	return -1;
}

/* Whether a place ends a clause that says where its anchor is: "that the box is under". */
static int is_stranded(const struct analysis *a, const struct tokens *t, int predicate)
{
	const int noun = phrase_before(a, predicate);

	return tokens_class(t, predicate) == CLOSED_PLACE && a->word[predicate].head == ROOT &&
	       (predicate + 1 >= t->n || t->word[predicate + 1].before) && noun >= 0 &&
	       a->word[noun].role == ROLE_ANCHOR && a->word[noun].head == predicate &&
	       has_class(t, noun, predicate, CLOSED_BE) &&
	       has_class(t, phrase_before(a, noun) + 1, noun, CLOSED_RELATIVE);
}

/* "the mug that the box is under" is above the box. */
static void mend_stranded(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (analysis_is_predicate(a, i) && is_stranded(a, t, i))
			a->word[i].relation =
				closed_inverse((enum parse_relation)closed_words[t->word[i].closed].relation);
}

void analysis_it(struct analysis *a, const struct tokens *t)
{
	mend_it_again(a, t);
	mend_alone(a, t);
	mend_stranded(a, t);
	mend_has_it(a, t);
}
