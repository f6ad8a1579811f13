/* "The two cups next to each other", "the cups standing side by side": of all that fit, those that are
 * nearest to one another. */
#include "ask/meaning_private.h"

#include "ask/constants.h"
#include "places/pairs.h"

#include <string.h>

static int are(const struct parse *p, int word, const char *const *words)
{
	for (; *words; word++, words++)
		if (word >= p->word_count || strcmp(p->words[word].text, *words) != 0)
			return 0;
	return 1;
}

int meaning_is_mutual(const struct parse *p)
{
	static const char *const each[] = {"each", "other", NULL}, *const one[] = {"one", "another", NULL},
				 *const side[] = {"side", "by", "side", NULL};

	if (p->phrases[0].count != 2 && p->phrases[0].count >= 0)
		return 0;
	for (int i = 0; i < p->word_count; i++)
		if (are(p, i, each) || are(p, i, one) || are(p, i, side))
			return 1;
	return 0;
}

/* 1 where something is said to be far from each other. */
static int is_far(const struct parse *p)
{
	for (int k = 0; k < p->phrases[0].clauses.n; k++)
		if (p->clauses[p->phrases[0].clauses.item[k]].relation == PARSE_FAR)
			return 1;
	return 0;
}

static double apart(const struct arrangement *a, size_t i, size_t k)
{
	return pair_gap(&a->objects[i], &a->objects[k]) / a->spacing;
}

/* Marks the two that fit about as well as any and are nearest, or farthest; returns how far apart they are.
 */
static double mark_pair(const struct arrangement *a, const double *fit, double least, int far, double *marked)
{
	size_t first = 0, second = 0;
	double found = 0;

	for (size_t i = 0; i < a->n; i++)
		for (size_t k = 0; k < i; k++) {
			const double d = apart(a, i, k);
			if (fit[i] <= least || fit[k] <= least)
				continue;
			if (first == second || (far ? d > found : d < found)) {
				first = i;
				second = k;
				found = d;
			}
		}
	marked[first] = marked[second] = first != second;
	return found;
}

/* What is as near to one of them stands with them. */
static void mark_more(
	const struct arrangement *a, const double *fit, double least, double found, double *marked)
{
	for (int grown = 1; grown;) {
		grown = 0;
		for (size_t i = 0; i < a->n; i++)
			for (size_t k = 0; k < a->n && !marked[i] && fit[i] > least; k++)
				if (marked[k] && apart(a, i, k) <= found + TOUCHING)
					grown = marked[i] = 1;
	}
}

void meaning_keep_mutual(struct meaning *m, double *fit, double *marked)
{
	const struct arrangement *a = m->arrangement;
	const struct parse *p = m->sentence->parse;
	const double least = SEVERAL_SHARE * largest(fit, a->n);
	const int far = is_far(p);

	if (!meaning_is_mutual(p))
		return;
	memset(marked, 0, a->n * sizeof *marked);
	const double found = mark_pair(a, fit, least, far, marked);
	if (p->phrases[0].count != 2 && !far)
		mark_more(a, fit, least, found, marked);
	for (size_t o = 0; o < a->n; o++)
		fit[o] *= marked[o] ? 1 : GROUP_ELSE;
}
