#include "lang/rules.h"

int rules_without(const char *list, unsigned *without, struct list_name *unknown)
{
#define RULE(name, what) #name,
	static const char *const names[RULES] = {
#include "lang/rules.def"
	};
#undef RULE

	*without = 0;
	while (list_next(&list, unknown)) {
		int r = 0;
		while (r < RULES && !list_name_is(unknown, names[r]))
			r++;
		if (r == RULES)
			return -1;
		*without |= 1U << r;
	}
	return 0;
}
