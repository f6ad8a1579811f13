/* Questions in other forms than those of the table of kinds. */
#pragma once

#include "lang/tokens.h"

/* Says a question again as the table has it: a number that is not asked for by "how many" at the start ("grey
 * boxes: what's the total?"), a choice from a list ("mug, jug, tin: the smallest?"), a statement to be
 * confirmed
 * ("there's no cat, is there?"). `to` holds `size` bytes. Returns 0 where it has none of these forms.
 * English. */
int question_say_again(char *to, size_t size, const struct tokens *t, const char *text);

/* The things whose number is asked for, where they are told among those of a list: of "mug, jug, tray: how
 * many of them are red?" "the mug, the jug and the tray that are red". */
int question_say_list(char *to, size_t size, const struct tokens *t, const char *text);
