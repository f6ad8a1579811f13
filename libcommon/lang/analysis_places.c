/* Another part of what closed-class words settle (analysis_mend.c): places that are said twice, what stands
 * by itself, and what "it" is. */
#include "lang/analysis.h"
#include "lang/closed.h"

/* Words between two predicates of one place. */
enum { PLACE_REACH = 4 };

/* The next predicate that is said of the same thing, with no phrase, pause or "and" before it; or -1. */
static int next_place(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i + 1; j < t->n && j <= i + PLACE_REACH && !t->word[j].before; j++) {
		if (analysis_is_predicate(a, j))
			return a->word[j].head == a->word[i].head && a->word[j].negated == a->word[i].negated
				       ? j
				       : -1;
		if (role_is_phrase(a->word[j].role) || tokens_class(t, j) == CLOSED_CONJUNCTION)
			return -1;
	}
	return -1;
}

static enum parse_relation without_contact(enum parse_relation r)
{
	return r == PARSE_ON ? PARSE_ABOVE : r == PARSE_SUPPORTS ? PARSE_BELOW : r;
}

/* "left of the rightmost one": rightmost is said of the one, which is the anchor of left. */
static void mend_superlative(struct analysis *a, const struct tokens *t)
{
	for (int i = 2; i + 1 < t->n; i++) {
		int noun = i + 1, place = i - 1;
		if (!analysis_is_predicate(a, i) || tokens_class(t, i - 1) != CLOSED_DETERMINER ||
			t->word[i].closed < 0 || closed_words[t->word[i].closed].value != PARSE_MOST)
			continue;
		while (noun + 1 < t->n && !t->word[noun].before && a->word[noun].role == ROLE_ATTRIBUTE)
			noun++;
		while (place > 0 && !t->word[place + 1].before && a->word[place].role == ROLE_NONE)
			place--;
		if (a->word[noun].role != ROLE_ANCHOR || a->word[noun].head != i || t->word[noun].before ||
			!analysis_is_predicate(a, place) || t->word[place + 1].before ||
			analysis_has_anchor(a, place))
			continue;
		a->word[noun].head = place;
		a->word[i].head = noun;
	}
}

/* Relations to the room itself. */
static int is_of_room(enum parse_relation r)
{
	return r == PARSE_CORNER || r == PARSE_WALL || r == PARSE_FLOOR || r == PARSE_MIDDLE;
}

/* "on the very top" is one place, as are "right next to" and "closest to the corner". */
static void mend_doubled(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int j = analysis_is_predicate(a, i) ? next_place(a, t, i) : -1;
		if (j < 0)
			continue;
		const enum parse_relation first = without_contact(a->word[i].relation),
					  second = without_contact(a->word[j].relation);
		const int is_of_both = first == second || (first == PARSE_NEAR && is_of_room(second));
		if (is_of_both && !analysis_has_anchor(a, i))
			analysis_give_up(&a->word[i]);
		else if (first == second && !analysis_has_anchor(a, j))
			analysis_give_up(&a->word[j]);
	}
}

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

int analysis_it_after(const struct analysis *a, const struct tokens *t, int predicate)
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

int analysis_has(const struct tokens *t, int i)
{
	const int class = tokens_class(t, i);

	return class == CLOSED_WITH || class == CLOSED_HAVE || tokens_is(t, i, "without");
}

/* "there is a lamp beside it" too. */
static int is_having(const struct tokens *t, int i)
{
	return analysis_has(t, i) || tokens_is(t, i, "there");
}

/* "with two stools near it", "has a lamp beside it": the phrase is the anchor of the place after it,
 * whatever it was taken for an anchor of. */
static void mend_it(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		int noun = i - 1, with;
		if (!analysis_is_predicate(a, i) || analysis_has_anchor(a, i) ||
			analysis_it_after(a, t, i) < 0)
			continue;
		while (noun > 0 && !role_is_phrase(a->word[noun].role) && !t->word[noun + 1].before &&
			!analysis_is_predicate(a, noun) && !is_having(t, noun))
			noun--;
		for (with = noun; with > 0 && !is_having(t, with) && !t->word[with].before &&
				  (with == noun || !role_is_phrase(a->word[with].role));)
			with--;
		if (a->word[noun].role != ROLE_ANCHOR || t->word[noun + 1].before || !is_having(t, with))
			continue;
		const int before = a->word[noun].head;
		a->word[noun].head = i;
		a->word[i].negated |= before == with && a->word[with].negated;
		if (before == with && !analysis_has_anchor(a, with))
			analysis_give_up(&a->word[with]);
		if (before >= 0 && a->word[before].role != ROLE_NONE && a->word[i].head == noun)
			a->word[i].head = a->word[before].head;
	}
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
			const int it = analysis_it_after(a, t, i);
			if (it >= 0 && tokens_class(t, it + 1) != CLOSED_BE)
				a->word[it] = (struct analysis_word){.role = ROLE_ANCHOR, .head = i};
		}
		/* "the jug I want is over it" may speak of another */
		earlier = a->word[i].role == ROLE_ANCHOR ||
			  (earlier && t->word[i].closed >= 0 && tokens_class(t, i) != CLOSED_GENERIC);
		has |= is_having(t, i);
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

/* Whether a noun is all that its predicate is about, and nothing but what describes it hangs on it. */
static int is_plain(const struct analysis *a, int noun)
{
	for (int i = 0; i < a->n; i++) {
		const struct analysis_word *w = &a->word[i];
		if ((w->role == ROLE_PREDICATE && w->head == noun) ||
			(w->role == ROLE_ANCHOR && w->head == a->word[noun].head && i != noun))
			return 0;
	}
	return 1;
}

/* "on the white wall" is by the wall, as "on the wall" is: no thing that carries another. */
static void mend_wall(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int p = a->word[i].role == ROLE_ANCHOR ? a->word[i].head : -1;
		if (!tokens_is(t, i, "wall") || !analysis_is_predicate(a, p) ||
			a->word[p].relation != PARSE_ON || !is_plain(a, i))
			continue;
		a->word[p].relation = PARSE_WALL;
		analysis_give_up(&a->word[i]);
		for (int j = 0; j < t->n; j++)
			if (a->word[j].head == i)
				analysis_give_up(&a->word[j]);
	}
}

/* The way that a word before "corner" says, or -1: the far corner is at the back. */
static int way_to_corner(const struct tokens *t, int i)
{
	static const char *const back[] = {"far", "back", "rear", "upper", NULL};
	static const char *const front[] = {"near", "front", "nearest", "closest", "lower", NULL};

	return tokens_is_any(t, i, back)    ? PARSE_BEHIND
	       : tokens_is_any(t, i, front) ? PARSE_FRONT
	       : tokens_is(t, i, "left")    ? PARSE_LEFT
	       : tokens_is(t, i, "right")   ? PARSE_RIGHT
					    : -1;
}

/* "in the back right corner" is at the back, on the right and in a corner. */
static void mend_corner(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		const int is_plain = analysis_is_predicate(a, i) && a->word[i].relation == PARSE_CORNER &&
				     !a->word[i].negated;
		for (int j = i - 1; is_plain && j >= 0 && !t->word[j + 1].before; j--) {
			const int way = way_to_corner(t, j);
			if (way < 0 && !tokens_is(t, j, "hand") && !tokens_is(t, j, "most"))
				break;
			if (way >= 0 && !analysis_has_anchor(a, j))
				a->word[j] = (struct analysis_word){
					ROLE_PREDICATE, a->word[i].head, (enum parse_relation)way, 0};
		}
	}
}

void analysis_places(struct analysis *a, const struct tokens *t)
{
	mend_corner(a, t);
	mend_superlative(a, t);
	mend_it(a, t);
	mend_it_again(a, t);
	mend_alone(a, t);
	mend_wall(a, t);
	mend_stranded(a, t);
	mend_doubled(a, t);
}
