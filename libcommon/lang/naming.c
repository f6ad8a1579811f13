#include "lang/naming.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* What is known is sometimes not what is said: of WordNet's synonyms, of names in one line, and of sorts. */
static const double of_wordnet = 0.95, of_line = 0.85;

static void find(struct naming *to, const char *lemma, void (*noun)(struct wordnet_noun *, const char *))
{
	char joined[128];

	snprintf(joined, sizeof joined, "%s", lemma);
	for (char *p = joined; (p = strchr(p, ' '));)
		*p = '_';
	noun(&to->noun, joined);
	to->lemma = lemma;
	things_find(&to->things, lemma);
	kinds_find(&to->kinds, lemma);
	snprintf(joined + strlen(joined), sizeof joined - strlen(joined),
		"s"); /* "clothes", whose lemma is no word */
	if (!to->noun.n)
		noun(&to->noun, joined);
	if (!to->kinds.bits[0][0] && !to->kinds.bits[0][1] && !to->kinds.bits[0][2])
		kinds_find(&to->kinds, joined);
}

void naming_of_word(struct naming *to, const char *lemma)
{
	find(to, lemma, wordnet_find);
}

void naming_of_thing(struct naming *to, const char *lemma)
{
	find(to, lemma, wordnet_find_thing);
}

int naming_is_known(const struct naming *n)
{
	return n->noun.n || n->things.n || kinds_have(n->lemma);
}

double naming_fits(const struct naming *word, const struct naming *known, int is_general)
{
	const double x = of_wordnet * wordnet_fits(&word->noun, &known->noun);

	if (is_general)
		return x;
	return fmax(
		x, things_share(&word->things, &known->things) || kinds_are_of(&word->kinds, &known->kinds)
			   ? of_line
			   : kinds_share(&word->kinds, &known->kinds));
}
