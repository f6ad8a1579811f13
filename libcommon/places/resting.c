#include "places/resting.h"

#include "places/pairs.h"
#include "lang/wordnet.h"

#include <math.h>
#include <string.h>

/* Of the things' feet: where most of them stand, and how much higher, in shares of the spacing, what rests on
 * something stands. How far a shelf goes on from what stands on it. */
static const double ground_share = 0.4, raised_least = 0.25, raised_soft = 0.05, holder_reach = 0.5;
/* How true a relation to something unknown is; the same of what stands on a shelf without a name, or below
 * it, and of what does not, where something does. */
static const double unknown_relation = 0.5, held_worth = 0.85, held_else = 0.2;

int resting_holds(const char *lemma)
{
	static const char *const holders[] = {
		"shelf", "ledge", "rack", "sill", "bracket", "pedestal", "cabinet", "bookcase", "wall", NULL};
	struct wordnet_noun word, holder;

	wordnet_find(&word, lemma);
	for (const char *const *h = holders; *h; h++) {
		wordnet_find(&holder, *h);
		if (!strcmp(lemma, *h) || wordnet_is_above(&holder, &word))
			return 1;
	}
	return 0;
}

/* The height that most things stand at, or the lower one of two. */
static double ground(const struct arrangement *a)
{
	size_t n = 0;

	for (size_t o = 0; o < a->n; o++)
		if (a->objects[o].is_there)
			a->along[n++] = (struct quantile_item){a->objects[o].low[2], 1};
	return n ? quantile_weighted(a->along, n, ground_share) : 0;
}

void resting_find(struct arrangement *a)
{
	const double level = ground(a);

	for (size_t o = 0; o < a->n; o++) {
		struct arranged *p = &a->objects[o];
		const double height = (p->low[2] - level) / a->spacing;
		p->raised = p->is_there ? 1 / (1 + exp((raised_least - height) / raised_soft)) : 0;
		for (size_t i = 0; i < a->n && p->raised > 0; i++)
			if (i != o && a->objects[i].is_there)
				p->raised *= 1 - pair_stands_on(a, p, &a->objects[i]);
	}
}

/* How far something raised is over o: what holds that may well reach as far. */
static double under_raised(const struct arrangement *a, size_t o)
{
	const struct arranged *p = &a->objects[o];
	double most = 0;

	for (size_t i = 0; i < a->n; i++) {
		const struct arranged *q = &a->objects[i];
		const double away = hypot(p->centre[0] - q->centre[0], p->centre[1] - q->centre[1]);
		most = fmax(most, q->raised * exp(-away / (holder_reach * a->spacing)));
	}
	return most * (1 - p->raised);
}

void resting_relate(const struct arrangement *a, enum parse_relation kind, double *out)
{
	const int is_on = kind == PARSE_ON, is_below = kind == PARSE_BELOW;
	double any = 0;

	for (size_t o = 0; o < a->n && (is_on || is_below); o++)
		any = fmax(any, a->objects[o].raised);
	for (size_t o = 0; o < a->n; o++) {
		const double so = is_on ? a->objects[o].raised : is_below ? under_raised(a, o) : 0;
		out[o] = (1 - any) * unknown_relation + any * (held_else + (held_worth - held_else) * so);
	}
}
