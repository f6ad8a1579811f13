/* Looks that are compared: "the darkest", "the second shiniest", "greener than the mat". */
#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "places/relate.h"
#include "lang/compared.h"
#include "lang/finish.h"

#include <string.h>

int meaning_compares_looks(const struct parse *p, const struct parse_clause *c)
{
	char base[COMPARED_LENGTH];
	const char *word = c->words.n == 1 ? p->words[c->words.item[0]].text : "";

	return c->relation == PARSE_OTHER && c->degree != PARSE_PLAIN &&
	       (compared_of(word, base) != PARSE_PLAIN || compared_look(word) != COMPARED_NONE);
}

/* How much an object looks as a word says, in units of what is told apart; 0 where such looks do not count.
 */
static double look_of(
	const struct meaning *m, const struct arranged *o, enum compared_look look, const char *base)
{
	if (look == COMPARED_FINISH ? !m->has_surfaces : m->without >> MEANING_COLOUR & 1)
		return 0;
	switch (look) {
	case COMPARED_DARK:
		return -o->lab[0] / COMPARED_LIGHTNESS;
	case COMPARED_BRIGHT:
		return o->lab[0] / COMPARED_LIGHTNESS;
	case COMPARED_COLOURFUL:
		return hypot(o->lab[1], o->lab[2]) / COMPARED_LIGHTNESS;
	case COMPARED_FINISH:
		return surface_fits(&o->surface, finish_of(base)) / COMPARED_SHARE;
	default:
		return 0;
	}
}

/* key (O): the less, the more an object looks so; what sentences say of it where that cannot be seen. */
static void find_keys(struct meaning *m, int word, double *key)
{
	char base[COMPARED_LENGTH];
	const char *text = m->sentence->parse->words[word].text;
	const char *adjective = compared_of(text, base) == PARSE_PLAIN ? text : base;
	const enum compared_look look = compared_look(adjective);

	if (look == COMPARED_COLOUR)
		vocabulary_colour(m->vocabulary, m->arrangement, adjective, key);
	else if (look == COMPARED_NONE || look == COMPARED_FINISH)
		vocabulary_attribute(m->vocabulary, m->sentence, word, key);
	else
		memset(key, 0, objects_of(m) * sizeof *key);
	m->unknown += look == COMPARED_NONE && largest(key, objects_of(m)) < 0.5;
	for (size_t o = 0; o < objects_of(m); o++)
		key[o] = -key[o] / COMPARED_SHARE - look_of(m, &m->arrangement->objects[o], look, adjective);
}

void meaning_judge_compared(
	struct meaning *m, const struct parse_clause *c, int place, const double *fit, double *value)
{
	const size_t n = objects_of(m);
	const int anchor = c->anchors.n && m->known[c->anchors.item[0]] >= 0.5 ? c->anchors.item[0] : -1;
	const double *than = anchor < 0 || c->degree == PARSE_MOST ? NULL : fit_of(m, anchor);
	double *key = m->scratch + 3 * n;

	find_keys(m, c->words.item[0], key);
	if (!than || meaning_is_other(m->sentence->parse, &m->sentence->parse->phrases[anchor])) {
		relate_rank_by(m->arrangement, key, place, fit, value);
		return;
	}
	const size_t best = best_of(than, n);
	for (size_t o = 0; o < n; o++)
		value[o] = o == best ? 0 : 1 / (1 + exp(fmin(key[o] - key[best] + 1, 40)));
}
