/* The other half of what closed-class words settle (analysis_mend.c): places. */
#include "lang/analysis.h"
#include "lang/closed.h"

/* Words between two predicates of one place. */
enum { PLACE_REACH = 4 };

static int is_viewer(const struct tokens *t, int i)
{
	return (tokens_class(t, i) == CLOSED_PRONOUN && closed_words[t->word[i].closed].value == 1) ||
	       tokens_is(t, i, "you");
}

/* "the one closest to us". */
static void mend_viewer(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role != ROLE_NONE || !is_viewer(t, i) ||
			!(tokens_is(t, i - 1, "to") || tokens_is(t, i - 1, "from") ||
				tokens_is(t, i - 1, "between") || tokens_is(t, i - 1, "near") ||
				tokens_is(t, i - 1, "nearest")))
			continue;
		for (int j = i - 1; j >= 0 && j >= i - 3 && !t->word[j + 1].before; j--)
			if (a->word[j].role == ROLE_PREDICATE &&
				(a->word[j].relation == PARSE_NEAR || a->word[j].relation == PARSE_FAR ||
					a->word[j].relation == PARSE_BETWEEN)) {
				a->word[i] = (struct analysis_word){.role = ROLE_ANCHOR, .head = j};
				break;
			}
	}
}

/* The predicate of words i to i + 4, or -1. */
static int predicate_from(const struct analysis *a, int i)
{
	for (int j = i; j < a->n && j <= i + 4; j++)
		if (a->word[j].role == ROLE_PREDICATE)
			return j;
	return -1;
}

/* Takes over a predicate of the grammar's, with its anchors and what describes them. */
static void take_predicate(struct analysis *a, const struct analysis *grammar, int predicate)
{
	a->word[predicate] = grammar->word[predicate];
	for (int i = predicate + 1; i < a->n; i++) {
		const struct analysis_word *w = &grammar->word[i];
		if (w->head == predicate || (w->head > predicate && w->role != ROLE_PREDICATE &&
						    grammar->word[w->head].head == predicate))
			a->word[i] = *w;
	}
}

/* "the greatest distance to the sofa" is farthest from it, whatever became of the words. */
static void mend_ways(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	static const char *const far[] = {
		"longest", "greatest", "largest", "biggest", "furthest", "farthest"};
	static const char *const near[] = {"shortest", "least", "smallest"};

	for (int i = 0; i + 1 < t->n; i++) {
		int r = -1, at;
		if (!tokens_is(t, i + 1, "way") && !tokens_is(t, i + 1, "distance"))
			continue;
		for (size_t k = 0; k < sizeof far / sizeof *far; k++)
			r = tokens_is(t, i, far[k]) ? PARSE_FAR : r;
		for (size_t k = 0; k < sizeof near / sizeof *near; k++)
			r = tokens_is(t, i, near[k]) ? PARSE_NEAR : r;
		if (r >= 0 && predicate_from(a, i) < 0 && (at = predicate_from(grammar, i)) >= 0)
			take_predicate(a, grammar, at);
		at = r >= 0 ? predicate_from(a, i) : -1;
		if (at < 0)
			continue;
		const struct analysis_word predicate = a->word[at];
		analysis_give_up(&a->word[at]);
		a->word[i] = predicate;
		a->word[i].relation = (enum parse_relation)r;
		for (int j = 0; j < t->n; j++)
			if (a->word[j].role == ROLE_ANCHOR && a->word[j].head == at)
				a->word[j].head = i;
	}
}

/* "in the background" is at the back, and "in the foreground" in front. */
static void mend_grounds(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		struct analysis_word *w = &a->word[i];
		const int is_back = tokens_is(t, i, "background");
		if ((!is_back && !tokens_is(t, i, "foreground")) ||
			(w->role != ROLE_NONE && w->role != ROLE_PREDICATE))
			continue;
		if (w->role == ROLE_NONE)
			*w = (struct analysis_word){.role = ROLE_PREDICATE, .head = ROOT};
		w->relation = is_back ? PARSE_BEHIND : PARSE_FRONT;
	}
}

/* The last predicate between words i and j with nothing but words that say nothing after it, or -1. */
static int last_predicate(const struct analysis *a, const struct tokens *t, int i, int j)
{
	while (--j > i && !t->word[j + 1].before && !role_is_phrase(a->word[j].role))
		if (a->word[j].role == ROLE_PREDICATE)
			return j;
	return -1;
}

/* "over by the sink" is by it. */
static void mend_over_by(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int first = a->word[i].role == ROLE_ANCHOR ? a->word[i].head : i;
		const int last = first < i ? last_predicate(a, t, first, i) : -1;
		if (last < 0 || tokens_class(t, last) != CLOSED_PLACE || analysis_has_anchor(a, last) ||
			a->word[last].head != a->word[first].head)
			continue;
		a->word[i].head = last;
		if (!analysis_has_anchor(a, first) &&
			(tokens_is(t, first, "over") || tokens_is(t, first, "up") ||
				tokens_is(t, first, "down")))
			analysis_give_up(&a->word[first]);
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

/* "in the middle between the jug and the bowl", "in the middle, between them": is between the two. */
static void mend_between(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		int p = i - 1;
		if (a->word[i].role != ROLE_PREDICATE || a->word[i].relation != PARSE_BETWEEN ||
			!analysis_has_anchor(a, i))
			continue;
		while (p > 0 && a->word[p].role == ROLE_NONE)
			p--;
		if (a->word[p].role != ROLE_PREDICATE || a->word[p].head != a->word[i].head)
			continue;
		for (int j = i + 1; j < t->n && p == i - 1; j++)
			if (a->word[j].role == ROLE_ANCHOR && a->word[j].head == p)
				a->word[j].head = i;
		if (a->word[p].relation == PARSE_MIDDLE && !analysis_has_anchor(a, p))
			analysis_give_up(&a->word[p]);
	}
}

void analysis_places(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	mend_ways(a, grammar, t);
	mend_viewer(a, t);
	mend_grounds(a, t);
	mend_over_by(a, t);
	mend_between(a, t);
	mend_corner(a, t);
	mend_doubled(a, t);
}
