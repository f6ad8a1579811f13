/* Sentences that say what a thing is for, or does, and not what it is: "what you drink from". */
#pragma once

#include "lang/parse.h"

/* Whether the sentence has the form of one, by its closed-class words. Nouns of such a sentence are what the
 * thing is used with ("paper"), so that a noun that names something here speaks against it. */
int purpose_is_said(const struct parse *p);

/* Whether a word of it tells of the purpose: none of grammar, place or colour. */
int purpose_is_content(const struct parse *p, int word);
