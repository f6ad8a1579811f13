#include "lang/compared.h"

#include "base/list.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/finish.h"
#include "lang/wordnet.h"

#include <string.h>

enum compared_look compared_look(const char *adjective)
{
	return list_has("dark|dim|dusky|gloomy", adjective)			 ? COMPARED_DARK
	       : list_has("bright|fair|light|pale", adjective)			 ? COMPARED_BRIGHT
	       : list_has("colorful|colourful|gaudy|saturated|vivid", adjective) ? COMPARED_COLOURFUL
	       : colour_word(adjective) >= 0					 ? COMPARED_COLOUR
	       : finish_of(adjective) >= 0					 ? COMPARED_FINISH
										 : COMPARED_NONE;
}

/* Adjectives of size and place. */
static int is_measure(const char *base)
{
	static const char measures[] =
		"bulky|chubby|chunky|close|deep|far|fat|few|flat|heavy|high|lofty|low|narrow|"
		"near|plump|shallow|skinny|slight|slim|stout|tall|thick|thin";

	return list_has(measures, base) || closed_is(base, CLOSED_SIZE) || closed_is(base, CLOSED_PLACE);
}

enum adjective { NONE, MEASURE, LOOK, OTHER };

static enum adjective adjective_of(const char *base)
{
	if (is_measure(base))
		return MEASURE;
	if (compared_look(base) != COMPARED_NONE)
		return LOOK;
	return wordnet_is_adjective(base) ? OTHER : NONE;
}

/* What is left of a word without -er or -est becomes an adjective: "shini" shiny, "pal" pale, "redd" red. */
static enum adjective find_base(char *base)
{
	const size_t n = strlen(base);
	enum adjective found;

	if (base[n - 1] == 'i')
		base[n - 1] = 'y';
	found = adjective_of(base);
	if (found == NONE) {
		memcpy(base + n, "e", 2);
		found = adjective_of(base);
	}
	if (found == NONE && base[n - 1] == base[n - 2]) {
		base[n - 1] = 0;
		found = adjective_of(base);
	}
	return found;
}

enum parse_degree compared_of(const char *word, char *base)
{
	const size_t n = strlen(word);
	const int is_most = n > 5 && !strcmp(word + n - 3, "est"),
		  is_more = n > 4 && !strcmp(word + n - 2, "er");

	if ((!is_most && !is_more) || n >= COMPARED_LENGTH - 1 || closed_find(word) >= 0 ||
		colour_word(word) >= 0)
		return PARSE_PLAIN;
	memcpy(base, word, n);
	base[n - (is_most ? 3 : 2)] = 0;
	const enum adjective found = find_base(base);
	if (found == LOOK)
		return is_most ? PARSE_MOST : PARSE_MORE;
	/* "modest" is no more of "mod", and no forest is fore */
	return found == OTHER && is_most && !wordnet_is_adjective(word) && !wordnet_is_noun(word)
		       ? PARSE_MOST
		       : PARSE_PLAIN;
}

enum parse_degree compared_at(const struct tokens *t, int i)
{
	char base[COMPARED_LENGTH];
	const enum parse_degree own = compared_of(t->word[i].text, base);

	if (own != PARSE_PLAIN || t->word[i].before || compared_look(t->word[i].text) == COMPARED_NONE)
		return own;
	return tokens_is(t, i - 1, "most")   ? PARSE_MOST
	       : tokens_is(t, i - 1, "more") ? PARSE_MORE
					     : PARSE_PLAIN;
}
