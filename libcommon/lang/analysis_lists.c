/* Lists of three things or more: "the cup, the plate and the jug". */
#include "lang/analysis.h"
#include "lang/closed.h"

/* Whether word i may stand before the noun of a thing in a list. */
static int is_description(const struct tokens *t, int i)
{
	const int kind = tokens_class(t, i);

	return kind < 0 || kind == CLOSED_DETERMINER || kind == CLOSED_NUMBER || kind == CLOSED_SIZE ||
	       kind == CLOSED_ATTRIBUTE;
}

/* Whether the words from..to-1 are a thing of a list and no more. */
static int is_item(const struct analysis *a, const struct tokens *t, int from, int to)
{
	if (from >= to || to - from > 5)
		return 0;
	for (int i = from; i < to; i++)
		if (!is_description(t, i) || (i > from && t->word[i].before))
			return 0;
	const enum word_role last = a->word[to - 1].role;
	return tokens_class(t, to - 1) < 0 && last != ROLE_ANCHOR && last != ROLE_PREDICATE;
}

/* The noun before word `end` is meant, or also meant, and what describes it is said of it. */
static void mean_item(struct analysis *a, const struct tokens *t, int from, int end, enum word_role role)
{
	const int noun = end - 1;

	a->word[noun] = (struct analysis_word){.role = role, .head = ROOT};
	for (int i = from; i < noun; i++) {
		struct analysis_word *w = &a->word[i];
		if (role_is_phrase(w->role) || (w->role == ROLE_NONE && tokens_class(t, i) < 0))
			*w = (struct analysis_word){.role = ROLE_ATTRIBUTE};
		if (w->role != ROLE_NONE)
			w->head = role == ROLE_TARGET ? ROOT : noun;
	}
}

/* The noun that comes after "and" at word i, as far as only descriptions are between, or -1. */
static int noun_after(const struct analysis *a, const struct tokens *t, int i)
{
	for (i++; i < t->n && !t->word[i].before && is_description(t, i); i++)
		if (role_is_phrase(a->word[i].role))
			return i;
	return -1;
}

/* Where the list begins whose last two things "and" at word i is between; starts (most) gets the first word
 * of each further thing before it, the last one first. */
static int find_items(const struct analysis *a, const struct tokens *t, int i, int *starts, int most)
{
	int n = 0;

	for (int end = i, from; n < most; end = from, n++) {
		for (from = end - 1; from > 0 && !t->word[from].before; from--)
			;
		if (from <= 0 || t->word[from].before != PAUSE_COMMA || !is_item(a, t, from, end))
			break;
		starts[n] = from;
	}
	return n;
}

/* The first thing of a list ends before word `end`: where its words begin, or -1 where no such thing stands
 * there. */
static int first_item(const struct analysis *a, const struct tokens *t, int end, int is_told)
{
	const enum word_role last = a->word[end - 1].role;
	int from = end - 1;

	if (last != ROLE_TARGET && last != ROLE_ALSO && last != ROLE_NAME &&
		!(is_told && last == ROLE_ATTRIBUTE))
		return -1;
	while (from > 0 && !t->word[from].before && is_description(t, from - 1))
		from--;
	for (int i = 0; i < from; i++)
		if (a->word[i].role == ROLE_PREDICATE || role_is_phrase(a->word[i].role))
			return -1;
	return tokens_class(t, end - 1) < 0 ? from : -1;
}

void analysis_lists(struct analysis *a, const struct tokens *t)
{
	int starts[8], first, n, last;

	for (int i = 2; i + 1 < t->n; i++) {
		if (tokens_class(t, i) != CLOSED_CONJUNCTION || (last = noun_after(a, t, i)) < 0 ||
			(a->word[last].role != ROLE_ALSO && a->word[last].role != ROLE_TARGET) ||
			!(n = find_items(a, t, i, starts, 8)))
			continue;
		/* an article before a thing tells that it is one, and no more adjectives */
		const int is_told = tokens_class(t, starts[n - 1]) == CLOSED_DETERMINER;
		if ((first = first_item(a, t, starts[n - 1], is_told)) < 0)
			continue;
		mean_item(a, t, first, starts[n - 1], ROLE_TARGET);
		for (int k = 0; k < n; k++)
			mean_item(a, t, starts[k], k ? starts[k - 1] : i, ROLE_ALSO);
		mean_item(a, t, i + 1, last + 1, ROLE_ALSO);
		return;
	}
}
