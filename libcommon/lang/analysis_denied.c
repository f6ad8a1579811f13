/* What is denied: how something does not look, and which one is not meant. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"

/* The noun that the words from i on stand before as adjectives do, or -1. */
static int noun_after(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i + 1; j < t->n && !t->word[j].before; j++) {
		enum word_role r = a->word[j].role;
		if (role_is_phrase(r))
			return j;
		if (r != ROLE_ATTRIBUTE && r != ROLE_NAME && tokens_class(t, j) != CLOSED_SIZE &&
			tokens_class(t, j) != CLOSED_ATTRIBUTE)
			return -1;
	}
	return -1;
}

/* "the door that isn't brown": brown ones are left out. */
static void mend_isnt(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 1 < t->n; i++) {
		const int next = tokens_class(t, i + 1) == CLOSED_ADVERB ? i + 2 : i + 1;
		if (tokens_class(t, i) == CLOSED_NEGATION && !tokens_is(t, i, "no") &&
			!tokens_is(t, i, "without") && next < t->n && !t->word[next].before &&
			a->word[next].role == ROLE_ATTRIBUTE && a->word[next].head < next &&
			noun_after(a, t, next) < 0)
			a->word[next].role = ROLE_EXCEPT;
	}
}

/* Whether a word says how a thing looks, and no noun comes after it of which it says so. */
static int is_look_alone(const struct analysis *a, const struct tokens *t, int i)
{
	const int is_look = i < t->n && !t->word[i].before &&
			    (colour_word(t->word[i].text) >= 0 || tokens_class(t, i) == CLOSED_ATTRIBUTE);

	return is_look && (i + 1 == t->n || t->word[i + 1].before || a->word[i + 1].role == ROLE_NONE);
}

/* "the can that isn't orange or red": what is orange is left out, and what is red. */
static void mend_denied_looks(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int j = i + 1;
		while (tokens_class(t, j) == CLOSED_ADVERB)
			j++;
		if (tokens_class(t, i) != CLOSED_NEGATION || !is_look_alone(a, t, j))
			continue;
		if (a->word[j].role == ROLE_NONE)
			a->word[j] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
		if (a->word[j].role == ROLE_EXCEPT &&
			(tokens_is(t, j + 1, "or") || tokens_is(t, j + 1, "nor")) &&
			is_look_alone(a, t, j + 2))
			a->word[j + 2] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
	}
}

/* Whether a negation is among words from..to-1. */
static int is_denied(const struct tokens *t, int from, int to)
{
	for (int i = from; i < to; i++)
		if (tokens_class(t, i) == CLOSED_NEGATION)
			return 1;
	return 0;
}

/* "not the one under the shelf": the one that is under it is left out, and nothing more is denied. */
static void mend_negation(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int out = a->word[i].role == ROLE_PREDICATE ? a->word[i].head : -1;
		if (out >= 0 && a->word[out].role == ROLE_EXCEPT && !is_denied(t, out + 1, i))
			a->word[i].negated = 0;
	}
}

/* The word of "the other" or "the other one" at the end of a clause after word i that stands for a thing, or
 * -1.
 */
static int other_after(const struct tokens *t, int i)
{
	for (int k = i + 2; k < t->n; k++) {
		const int last = tokens_is(t, k + 1, "one") && !t->word[k + 1].before ? k + 1 : k;
		if (tokens_is(t, k, "other") && tokens_is(t, k - 1, "the") &&
			(last + 1 == t->n || t->word[last + 1].before))
			return last;
	}
	return -1;
}

/* Where "not the" stands before noun i with what is said of it before, the word "not"; or -1. */
static int denied_from(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i - 1; j >= 0 && !t->word[j + 1].before; j--) {
		const enum word_role r = a->word[j].role;
		if (tokens_is(t, j, "not"))
			return tokens_is(t, j + 1, "the") || tokens_is(t, j + 1, "that") ? j : -1;
		if (r != ROLE_ATTRIBUTE && r != ROLE_NAME && r != ROLE_PREDICATE &&
			tokens_class(t, j) != CLOSED_DETERMINER)
			break;
	}
	return -1;
}

/* "Not the orange plate, the other one": the plate is left out. */
static void mend_other(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int from = a->word[i].role == ROLE_TARGET ? denied_from(a, t, i) : -1;
		const int other = from >= 0 ? other_after(t, i) : -1;
		if (other < 0 || role_is_phrase(a->word[other].role))
			continue;
		for (int j = from; j < i; j++)
			a->word[j].head =
				a->word[j].head == ROOT && a->word[j].role != ROLE_NONE ? i : a->word[j].head;
		a->word[i] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
		a->word[other] = (struct analysis_word){.role = ROLE_TARGET, .head = ROOT};
		return;
	}
}

void analysis_denied(struct analysis *a, const struct tokens *t)
{
	mend_other(a, t);
	mend_isnt(a, t);
	mend_negation(a, t);
	mend_denied_looks(a, t);
}
