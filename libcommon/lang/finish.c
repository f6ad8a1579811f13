#include "lang/finish.h"

#include <string.h>

static const char *const words[FINISHES] = {
	[FINISH_STRIPES] = " striped stripy stripey stripe banded band ringed ring hooped hoop barred lined ",
	[FINISH_SPOTS] =
		" spotted spotty spot dotted dotty dot speckled speckle flecked mottled freckled blotchy blotch ",
	[FINISH_PLAIN] = " plain solid unpatterned uniform unicoloured monochrome ",
	[FINISH_SHINY] = " shiny glossy polished gleaming glittering lustrous sparkling ",
	[FINISH_DULL] = " dull matt matte unpolished lustreless ",
};

int finish_of(const char *lemma)
{
	const size_t length = strlen(lemma);

	for (int k = 0; k < FINISHES && length; k++)
		for (const char *at = words[k]; (at = strstr(at, lemma)); at++)
			if (at > words[k] && at[-1] == ' ' && at[length] == ' ')
				return k;
	return -1;
}

int finish_fits(int a, int b)
{
	if (a < 0 || b < 0)
		return 0;
	return a == b ? 1 : (a < FINISH_SHINY) == (b < FINISH_SHINY) ? -1 : 0;
}
