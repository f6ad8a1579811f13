/* The later half of what closed-class words settle (analysis_mend.c): words that were taken for something
 * else, and which of two words a phrase hangs on. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"

#include <string.h>

/* "any jar other than the white one": the white one is left out. */
static void mend_other_than(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 2 < t->n; i++) {
		if (!tokens_is(t, i, "other") || !tokens_is(t, i + 1, "than"))
			continue;
		for (int j = i + 2; j < t->n && j < i + 8; j++)
			if (role_is_phrase(a->word[j].role)) {
				if (a->word[j].role == ROLE_ALSO || a->word[j].role == ROLE_TARGET)
					a->word[j] =
						(struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
				break;
			}
	}
}

/* Where what is left out begins: after "except", "apart from", "just leave", "but the one"; 0 where it does
 * not at word i.
 */
static int exception_at(const struct tokens *t, int i)
{
	static const char *const leave[] = {"leave", "leaving", "minus", NULL};

	if (tokens_is(t, i, "except") || tokens_is(t, i, "excluding") || tokens_is(t, i, "excepting"))
		return i + 1 + tokens_is(t, i + 1, "for");
	if (tokens_is_any(t, i, leave) &&
		(t->word[i].before || tokens_is(t, i - 1, "just") || tokens_is(t, i - 1, "only")))
		return i + 1;
	if ((tokens_is(t, i, "apart") || tokens_is(t, i, "aside")) && tokens_is(t, i + 1, "from"))
		return i + 2;
	if (tokens_is(t, i, "but") && tokens_is(t, i + 1, "the") &&
		(tokens_is(t, i + 2, "one") || tokens_is(t, i + 2, "ones")))
		return i + 1;
	return 0;
}

/* "all lamps except the one that is nearest to the sink": the nearest one is left out. */
static void mend_except(struct analysis *a, const struct tokens *t)
{
	int found = 0, from = 0, out;

	for (int i = 0; i < t->n && !from; i++) {
		from = found ? exception_at(t, i) : 0;
		found |= a->word[i].role == ROLE_TARGET;
	}
	for (out = from; out < t->n && out < from + 6; out++)
		if (role_is_phrase(a->word[out].role) || tokens_is(t, out, "one") ||
			tokens_is(t, out, "ones"))
			break;
	if (!from || out >= t->n || out >= from + 6 || a->word[out].role == ROLE_ANCHOR)
		return;
	a->word[out] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
	if (tokens_is(t, from - 1, "from")) /* "apart" is no place then */
		analysis_give_up(&a->word[from - 2]);
	for (int i = from; i < t->n && t->word[i].before != PAUSE_STOP; i++) {
		const int is_said =
			a->word[i].role == ROLE_PREDICATE || (a->word[i].role == ROLE_ATTRIBUTE && i < out);
		if (i == out || !is_said || (a->word[i].head != ROOT && a->word[i].head != out))
			continue;
		a->word[i].head = out;
		a->word[i].negated = 0;
	}
}

/* Places that are verbs: "where I left it", "pass me over the jug". */
static void mend_verbs(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i + 1 < t->n; i++) {
		const int before = tokens_class(t, i - 1);
		if (a->word[i].role != ROLE_PREDICATE || analysis_has_anchor(a, i))
			continue;
		if (tokens_is(t, i, "left") && before == CLOSED_PRONOUN &&
			(tokens_class(t, i + 1) == CLOSED_DETERMINER ||
				tokens_class(t, i + 1) == CLOSED_PRONOUN))
			analysis_give_up(&a->word[i]);
		if (tokens_is(t, i, "over") &&
			(before == CLOSED_REQUEST || tokens_is(t, i - 1, "me") || tokens_is(t, i - 1, "us")))
			analysis_give_up(&a->word[i]);
	}
}

/* "a lamp on its left and a clock on its right": the clock is on the right. */
static void mend_both_sides(struct analysis *a, const struct tokens *t)
{
	int is_turned = 0;

	for (int i = 2; i < t->n; i++) {
		int anchor = i - 1, other = 0;
		if (a->word[i].role != ROLE_PREDICATE || a->word[i].head != ROOT ||
			!tokens_is(t, i - 1, "its") || analysis_has_anchor(a, i))
			continue;
		while (anchor > 0 && !role_is_phrase(a->word[anchor].role) &&
			a->word[anchor].role != ROLE_PREDICATE)
			anchor--;
		for (int j = 0; j < anchor; j++)
			other |= a->word[j].role == ROLE_ANCHOR && a->word[j].head == a->word[anchor].head;
		if (a->word[anchor].role == ROLE_ANCHOR && other && a->word[anchor].head < anchor)
			a->word[anchor].head = i;
	}
	for (int i = 1; i < t->n; i++) {
		if (a->word[i].role != ROLE_PREDICATE || !tokens_is(t, i - 1, "its") ||
			tokens_class(t, i) != CLOSED_PLACE)
			continue;
		const enum parse_relation r = (enum parse_relation)closed_words[t->word[i].closed].relation;
		if (is_turned)
			a->word[i].relation = closed_inverse(r);
		is_turned |= analysis_has_anchor(a, i) && a->word[i].relation == closed_inverse(r) &&
			     r != closed_inverse(r);
	}
}

/* Whether the words from a predicate to its anchor say that it is there: "on its left is the jar". */
static int is_stated(const struct tokens *t, int predicate, int anchor)
{
	for (int i = predicate; i < anchor; i++)
		if (tokens_class(t, i) == CLOSED_BE || tokens_class(t, i) == CLOSED_RELATIVE)
			return 1;
	return tokens_is(t, predicate - 1, "its");
}

/* "right of the lamp" is right of it: no anchor that comes after is meant the other way round. */
static void mend_direction(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int is_direct = analysis_has_anchor(a, i);
		if (a->word[i].role != ROLE_PREDICATE || tokens_class(t, i) != CLOSED_PLACE)
			continue;
		for (int j = 0; j < t->n; j++)
			if (a->word[j].role == ROLE_ANCHOR && a->word[j].head == i)
				is_direct &= j > i && !is_stated(t, i, j);
		const enum parse_relation r = (enum parse_relation)closed_words[t->word[i].closed].relation;
		if (is_direct && r <= PARSE_BELOW && a->word[i].relation == closed_inverse(r))
			a->word[i].relation = r;
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

/* "neither on the shelf nor by the door": what comes after "nor" is said of the same thing. */
static void mend_nor(struct analysis *a, const struct tokens *t)
{
	int first = -1;

	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role == ROLE_PREDICATE && first < 0 && a->word[i].negated)
			first = i;
		if (!tokens_is(t, i, "nor") || first < 0)
			continue;
		for (int j = i + 1; j < t->n && j <= i + 4; j++)
			if (a->word[j].role == ROLE_PREDICATE) {
				a->word[j].head = a->word[first].head;
				a->word[j].negated = 1;
				break;
			}
	}
}

/* "neither red nor green": red is left out too. */
static void mend_neither(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int nor = i + 1, out, is_bare = 1;
		while (nor < t->n && nor < i + 5 && !tokens_is(t, nor, "nor"))
			nor++;
		for (out = nor + 1; out < t->n && out < nor + 4 && a->word[out].role != ROLE_EXCEPT;)
			out++;
		if (!tokens_is(t, i, "neither") || !tokens_is(t, nor, "nor") || nor < i + 2 || out >= t->n ||
			a->word[out].role != ROLE_EXCEPT)
			continue;
		for (int j = i + 1; j < nor; j++)
			is_bare &= a->word[j].role == ROLE_NONE || a->word[j].role == ROLE_ATTRIBUTE;
		if (is_bare)
			a->word[nor - 1] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
	}
}

/* "left of the grey one": grey is said of what comes right after it. */
static void mend_attributes(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 1 < t->n; i++) {
		const enum word_role next = a->word[i + 1].role;
		if (a->word[i].role == ROLE_ATTRIBUTE && !t->word[i + 1].before && role_is_phrase(next) &&
			tokens_class(t, i) != CLOSED_RELATIVE)
			a->word[i].head = next == ROLE_TARGET ? ROOT : i + 1;
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

/* "the nearest lamp to the door": "to" by itself places nothing. */
static void mend_to(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		int p = i - 1;
		if (a->word[i].role != ROLE_PREDICATE || (!tokens_is(t, i, "to") && !tokens_is(t, i, "from")))
			continue;
		while (p > 0 &&
			!(a->word[p].role == ROLE_PREDICATE &&
				(a->word[p].relation == PARSE_NEAR || a->word[p].relation == PARSE_FAR)))
			p--;
		if (a->word[p].role != ROLE_PREDICATE || analysis_has_anchor(a, p) || p == i ||
			a->word[p].head != a->word[i].head)
			continue;
		for (int j = i + 1; j < t->n; j++)
			if (a->word[j].role == ROLE_ANCHOR && a->word[j].head == i)
				a->word[j].head = p;
		analysis_give_up(&a->word[i]);
	}
}

static void mean(struct analysis *a, int target)
{
	a->word[target] = (struct analysis_word){.role = ROLE_TARGET, .head = ROOT};
	for (int i = 0; i < a->n; i++)
		if (a->word[i].head == target)
			a->word[i].head = ROOT;
}

/* "not the mug, the other cup": the second of two things that are left out is meant, where nothing with a
 * name is. */
static void mend_left_out(struct analysis *a, const struct tokens *t)
{
	int first = -1, last = -1, pause;

	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role == ROLE_TARGET && tokens_class(t, i) != CLOSED_GENERIC)
			return;
		if (a->word[i].role == ROLE_EXCEPT) {
			first = first < 0 ? i : first;
			last = i;
		}
	}
	for (pause = last; pause > first && !t->word[pause].before; pause--)
		;
	if (last == first || pause == first)
		return;
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_TARGET)
			analysis_give_up(&a->word[i]);
	mean(a, last);
}

/* Whether an article stands before a word, with only attributes between. */
static int has_article(const struct analysis *a, const struct tokens *t, int i)
{
	while (i > 0 && !t->word[i].before && a->word[i - 1].role == ROLE_ATTRIBUTE)
		i--;
	return i > 0 && !t->word[i].before && tokens_class(t, i - 1) == CLOSED_DETERMINER;
}

/* "the goat asleep": where nothing is meant, the noun that the grammar means, though it looked like an
 * adjective.
 */
static void mend_no_target(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_TARGET)
			return;
	for (int i = 0; i < t->n; i++)
		if (grammar->word[i].role == ROLE_TARGET && t->word[i].closed < 0 &&
			(a->word[i].role == ROLE_ATTRIBUTE || a->word[i].role == ROLE_NAME) &&
			a->word[i].head == ROOT && has_article(a, t, i) && colour_word(t->word[i].text) < 0) {
			mean(a, i);
			return;
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

static int ends_in(const char *w, const char *end)
{
	const size_t n = strlen(w), m = strlen(end);

	return n > m + 2 && !strcmp(w + n - m, end);
}

/* "brighter than the rest" is no place. */
static void mend_comparatives(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_PREDICATE && t->word[i].closed < 0 &&
			a->word[i].relation >= PARSE_LARGER && a->word[i].relation <= PARSE_WIDER &&
			!analysis_has_anchor(a, i) &&
			(ends_in(t->word[i].text, "er") || ends_in(t->word[i].text, "est")))
			a->word[i].role = ROLE_ATTRIBUTE;
}

/* "behind the lamp there is a jar": the jar is meant, where nothing else is. */
static void mend_there_is(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_TARGET)
			return;
	for (int i = 1; i + 1 < t->n; i++) {
		const int is_stated = tokens_class(t, i) == CLOSED_BE && tokens_is(t, i - 1, "there");
		for (int j = i + 1; is_stated && j < t->n && !t->word[j].before; j++) {
			if (a->word[j].role == ROLE_ANCHOR) {
				a->word[j] = (struct analysis_word){.role = ROLE_TARGET, .head = ROOT};
				return;
			}
			if (a->word[j].role == ROLE_PREDICATE)
				break;
		}
	}
}

void analysis_reread(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	mend_other_than(a, t);
	mend_except(a, t);
	mend_verbs(a, t);
	mend_both_sides(a, t);
	mend_direction(a, t);
	mend_grounds(a, t);
	mend_nor(a, t);
	mend_neither(a, t);
	mend_there_is(a, t);
	mend_attributes(a, t);
	mend_over_by(a, t);
	mend_to(a, t);
	mend_left_out(a, t);
	mend_no_target(a, grammar, t);
	mend_between(a, t);
	mend_comparatives(a, t);
	analysis_lists(a, t);
}
