/* What closed-class words settle whatever a learnt parser makes of them: sizes before a noun, who looks, and
 * what "not the one" denies. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"

#include <string.h>

static int class_of(const struct tokens *t, int i)
{
	return i < 0 || i >= t->n || t->word[i].closed < 0 ? -1 : (int)closed_words[t->word[i].closed].class;
}

static int is(const struct tokens *t, int i, const char *word)
{
	return i >= 0 && i < t->n && !strcmp(t->word[i].text, word);
}

/* The noun that the words from i on stand before as adjectives do, or -1. */
static int noun_after(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i + 1; j < t->n && !t->word[j].before; j++) {
		enum word_role r = a->word[j].role;
		if (role_is_phrase(r))
			return j;
		if (r != ROLE_ATTRIBUTE && r != ROLE_NAME && class_of(t, j) != CLOSED_SIZE &&
			class_of(t, j) != CLOSED_ATTRIBUTE)
			return -1;
	}
	return -1;
}

/* "the big white plate": big is said of the plate. */
static void mend_sizes(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int noun;
		if (a->word[i].role != ROLE_NONE || class_of(t, i) != CLOSED_SIZE ||
			(noun = noun_after(a, t, i)) < 0)
			continue;
		a->word[i] = (struct analysis_word){ROLE_PREDICATE,
			a->word[noun].role == ROLE_TARGET ? ROOT : noun,
			(enum parse_relation)closed_words[t->word[i].closed].relation, 0};
	}
}

static int is_viewer(const struct tokens *t, int i)
{
	return (class_of(t, i) == CLOSED_PRONOUN && closed_words[t->word[i].closed].value == 1) ||
	       is(t, i, "you");
}

/* "the one closest to us". */
static void mend_viewer(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role != ROLE_NONE || !is_viewer(t, i) ||
			!(is(t, i - 1, "to") || is(t, i - 1, "from") || is(t, i - 1, "between") ||
				is(t, i - 1, "near") || is(t, i - 1, "nearest")))
			continue;
		for (int j = i - 1; j >= 0 && j >= i - 3 && !t->word[j + 1].before; j--)
			if (a->word[j].role == ROLE_PREDICATE &&
				(a->word[j].relation == PARSE_NEAR || a->word[j].relation == PARSE_FAR ||
					a->word[j].relation == PARSE_BETWEEN)) {
				a->word[i] = (struct analysis_word){.role = ROLE_ANCHOR, .head = j};
				break;
			}
	}
}

/* "not the one on the plate" denies "on", unless the one is left out as a whole: then nothing more is denied.
 */
static void mend_negation(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 2 < t->n; i++) {
		if (!is(t, i, "not") || !is(t, i + 1, "the") ||
			!(is(t, i + 2, "one") || is(t, i + 2, "ones")))
			continue;
		int left_out = a->word[i + 2].role == ROLE_EXCEPT;
		for (int j = i + 3; j < t->n && t->word[j].before != PAUSE_STOP; j++) {
			if (a->word[j].role != ROLE_PREDICATE)
				continue;
			if (left_out && a->word[j].head == i + 2)
				a->word[j].negated = 0;
			else if (!left_out && a->word[j].head == ROOT)
				a->word[j].negated = 1;
			break;
		}
	}
}

/* "something orange": a colour without an article is no noun. */
static void mend_colours(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_TARGET && colour_word(t->word[i].text) >= 0 && i > 0 &&
			(class_of(t, i - 1) == CLOSED_BE || class_of(t, i - 1) == CLOSED_GENERIC))
			a->word[i] = (struct analysis_word){.role = ROLE_ATTRIBUTE, .head = ROOT};
}

void analysis_mend(struct analysis *a, const struct tokens *t)
{
	mend_sizes(a, t);
	mend_viewer(a, t);
	mend_negation(a, t);
	mend_colours(a, t);
	analysis_repair(a);
}
