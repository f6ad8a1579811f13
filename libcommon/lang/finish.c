#include "lang/finish.h"

#include <string.h>

enum { STRIPES, SPOTS, PLAIN, SHINY, DULL, FINISHES };

static const char *const words[FINISHES] = {
	[STRIPES] = " striped stripy stripey stripe banded band ringed ring hooped hoop barred lined ",
	[SPOTS] = " spotted spotty spot dotted dotty dot speckled speckle flecked fleck mottled freckled freckle "
		  "dappled blotchy blotch splotchy patchy polka-dot ",
	[PLAIN] = " plain solid unpatterned uniform unicoloured monochrome ",
	[SHINY] = " shiny glossy polished gleaming glittering lustrous sparkling ",
	[DULL] = " dull matt matte unpolished lustreless ",
};

/* STRIPES ..., or -1. */
static int find(const char *lemma)
{
	const size_t length = strlen(lemma);

	for (int k = 0; k < FINISHES && length; k++)
		for (const char *at = words[k]; (at = strstr(at, lemma)); at++)
			if (at > words[k] && at[-1] == ' ' && at[length] == ' ')
				return k;
	return -1;
}

int finish_fits(const char *a, const char *b)
{
	const int i = find(a), k = find(b);

	if (i < 0 || k < 0)
		return 0;
	return i == k ? 1 : (i < SHINY) == (k < SHINY) ? -1 : 0;
}
