#include "lang/analysis.h"

int role_is_phrase(enum word_role r)
{
	return r == ROLE_TARGET || r == ROLE_ANCHOR || r == ROLE_ALSO || r == ROLE_EXCEPT || r == ROLE_VIEW ||
	       r == ROLE_MEMBER;
}

void analysis_give_up(struct analysis_word *w)
{
	*w = (struct analysis_word){.role = ROLE_NONE, .head = ROOT};
}

int analysis_is_predicate(const struct analysis *a, int i)
{
	return i >= 0 && i < a->n && a->word[i].role == ROLE_PREDICATE;
}

static int may_hang(const struct analysis *a, int i)
{
	int h = a->word[i].head;
	enum word_role r = a->word[i].role, up = h == ROOT ? ROLE_TARGET : a->word[h].role;

	if (h == i)
		return 0;
	switch (r) {
	case ROLE_NONE:
	case ROLE_TARGET:
	case ROLE_ALSO:
	case ROLE_VIEW:
	case ROLE_MEMBER:
		return h == ROOT;
	case ROLE_ANCHOR:
		return h != ROOT && up == ROLE_PREDICATE;
	case ROLE_EXCEPT:
		return h == ROOT || role_is_phrase(up);
	default:
		return h == ROOT || (role_is_phrase(up) && up != ROLE_TARGET);
	}
}

void analysis_repair(struct analysis *a)
{
	for (int i = 0; i < a->n; i++) {
		int h = a->word[i].head;
		/* the target is ROOT, so that all that is said of it hangs together */
		if (h != ROOT && h != i && a->word[h].role == ROLE_TARGET && a->word[i].role != ROLE_ANCHOR)
			a->word[i].head = ROOT;
		if (!may_hang(a, i)) {
			if (a->word[i].role == ROLE_ANCHOR)
				a->word[i].role = ROLE_NONE;
			a->word[i].head = ROOT;
		}
	}
	for (int i = 0; i < a->n; i++) {
		int steps = 0, at = i;
		while (at != ROOT && steps++ <= a->n)
			at = a->word[at].head;
		if (at != ROOT) {
			if (a->word[i].role == ROLE_ANCHOR)
				a->word[i].role = ROLE_NONE;
			a->word[i].head = ROOT;
		}
	}
	/* what hung on an anchor that is one no more hangs on ROOT, and so on */
	for (int changed = 1; changed;) {
		changed = 0;
		for (int i = 0; i < a->n; i++)
			if (!may_hang(a, i)) {
				if (a->word[i].role == ROLE_ANCHOR)
					a->word[i].role = ROLE_NONE;
				a->word[i].head = ROOT;
				changed = 1;
			}
	}
}

int analysis_has_anchor(const struct analysis *a, int predicate)
{
	for (int i = 0; i < a->n; i++)
		if (a->word[i].role == ROLE_ANCHOR && a->word[i].head == predicate)
			return 1;
	return 0;
}
