/* The rules of language, each with a name by which it can be left out. lang/rules.def has them. */
#pragma once

#include "base/list.h"

#define RULE(name, what) RULE_##name,
enum rule {
#include "lang/rules.def"
	RULES
};
#undef RULE

/* Whether a rule counts, of those that `without`, a bit 1 << enum rule for each, leaves. */
static inline int rule_counts(unsigned without, enum rule rule)
{
	return !(without >> rule & 1);
}

/* *without of a comma-separated list of names (NULL: none). 0, or -1 and *unknown the first that is none. */
int rules_without(const char *list, unsigned *without, struct list_name *unknown);
