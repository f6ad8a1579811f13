/* What closed-class words settle whatever a learnt parser makes of them: sizes before a noun, who looks, what
 * "not the one" denies, what two things are the anchors of, and what is said of a part of something. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"

#include <string.h>

/* The noun that the words from i on stand before as adjectives do, or -1. */
static int noun_after(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i + 1; j < t->n && !t->word[j].before; j++) {
		enum word_role r = a->word[j].role;
		if (role_is_phrase(r))
			return j;
		if (r != ROLE_ATTRIBUTE && r != ROLE_NAME && tokens_class(t, j) != CLOSED_SIZE &&
			tokens_class(t, j) != CLOSED_ATTRIBUTE)
			return -1;
	}
	return -1;
}

/* "the big white plate": big is said of the plate. */
static void mend_sizes(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int noun;
		if (a->word[i].role != ROLE_NONE || tokens_class(t, i) != CLOSED_SIZE ||
			(noun = noun_after(a, t, i)) < 0)
			continue;
		a->word[i] = (struct analysis_word){ROLE_PREDICATE,
			a->word[noun].role == ROLE_TARGET ? ROOT : noun,
			(enum parse_relation)closed_words[t->word[i].closed].relation, 0};
	}
}

static int is_viewer(const struct tokens *t, int i)
{
	return (tokens_class(t, i) == CLOSED_PRONOUN && closed_words[t->word[i].closed].value == 1) ||
	       tokens_is(t, i, "you");
}

/* "the one closest to us". */
static void mend_viewer(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role != ROLE_NONE || !is_viewer(t, i) ||
			!(tokens_is(t, i - 1, "to") || tokens_is(t, i - 1, "from") ||
				tokens_is(t, i - 1, "between") || tokens_is(t, i - 1, "near") ||
				tokens_is(t, i - 1, "nearest")))
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
		if (!tokens_is(t, i, "not") || !tokens_is(t, i + 1, "the") ||
			!(tokens_is(t, i + 2, "one") || tokens_is(t, i + 2, "ones")))
			continue;
		int left_out = a->word[i + 2].role == ROLE_EXCEPT;
		for (int j = i + 3; j < t->n && t->word[j].before != PAUSE_STOP; j++) {
			if (a->word[j].role != ROLE_PREDICATE)
				continue;
			if (left_out && (a->word[j].head == i + 2 || a->word[j].head == ROOT)) {
				a->word[j].head = i + 2;
				a->word[j].negated = 0;
			} else if (!left_out && a->word[j].head == ROOT)
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
			(tokens_class(t, i - 1) == CLOSED_BE || tokens_class(t, i - 1) == CLOSED_GENERIC))
			a->word[i] = (struct analysis_word){.role = ROLE_ATTRIBUTE, .head = ROOT};
}

/* The predicate of a place that "and" before a phrase joins it to, or -1: "behind the lamp and the vase". */
static int predicate_joined(const struct analysis *a, const struct tokens *t, int noun)
{
	static const unsigned takes_two = 1U << PARSE_LEFT | 1U << PARSE_RIGHT | 1U << PARSE_FRONT |
					  1U << PARSE_BEHIND | 1U << PARSE_ABOVE | 1U << PARSE_BELOW |
					  1U << PARSE_NEAR | 1U << PARSE_FAR | 1U << PARSE_BETWEEN;
	int i = noun - 1;

	while (i > 0 && !tokens_is(t, i, "and") && !t->word[i + 1].before && !role_is_phrase(a->word[i].role))
		i--;
	if (i < 1 || !tokens_is(t, i, "and") || t->word[i].before || a->word[i - 1].role != ROLE_ANCHOR)
		return -1;
	const int p = a->word[i - 1].head;
	return p >= 0 && a->word[p].head == ROOT && takes_two >> a->word[p].relation & 1 ? p : -1;
}

static int has_clause(const struct analysis *a, int noun)
{
	for (int i = 0; i < a->n; i++)
		if (a->word[i].role == ROLE_PREDICATE && a->word[i].head == noun && i > noun)
			return 1;
	return 0;
}

/* "the thing behind the lamp and the vase" is behind both. */
static void mend_pairs(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role != ROLE_ALSO || has_clause(a, i))
			continue;
		const int p = predicate_joined(a, t, i);
		if (p >= 0)
			a->word[i] = (struct analysis_word){.role = ROLE_ANCHOR, .head = p};
	}
}

/* "under the oak top of the desk": oak is not the target, which comes before. */
static void mend_parts(struct analysis *a, const struct tokens *t)
{
	int found = 0;

	for (int i = 0; i < t->n; i++) {
		found |= a->word[i].role == ROLE_TARGET;
		if (!found || a->word[i].role != ROLE_ATTRIBUTE || a->word[i].head != ROOT ||
			tokens_class(t, i - 1) != CLOSED_DETERMINER || i < 2 ||
			a->word[i - 2].role != ROLE_PREDICATE)
			continue;
		int anchor = i + 1;
		while (anchor < t->n && !tokens_is(t, anchor, "of") && a->word[anchor].head != i - 2)
			anchor++;
		a->word[i].head = anchor;
		if (anchor >= t->n || tokens_is(t, anchor, "of"))
			analysis_give_up(&a->word[i]);
	}
}

/* The predicate of words i to i + 4, or -1. */
static int predicate_from(const struct analysis *a, int i)
{
	for (int j = i; j < a->n && j <= i + 4; j++)
		if (a->word[j].role == ROLE_PREDICATE)
			return j;
	return -1;
}

/* Takes over a predicate of the grammar's, with its anchors and what describes them. */
static void take_predicate(struct analysis *a, const struct analysis *grammar, int predicate)
{
	a->word[predicate] = grammar->word[predicate];
	for (int i = predicate + 1; i < a->n; i++) {
		const struct analysis_word *w = &grammar->word[i];
		if (w->head == predicate || (w->head > predicate && w->role != ROLE_PREDICATE &&
						    grammar->word[w->head].head == predicate))
			a->word[i] = *w;
	}
}

/* "the greatest distance to the sofa" is farthest from it, whatever became of the words. */
static void mend_ways(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	static const char *const far[] = {
		"longest", "greatest", "largest", "biggest", "furthest", "farthest"};
	static const char *const near[] = {"shortest", "least", "smallest"};

	for (int i = 0; i + 1 < t->n; i++) {
		int r = -1, at;
		if (!tokens_is(t, i + 1, "way") && !tokens_is(t, i + 1, "distance"))
			continue;
		for (size_t k = 0; k < sizeof far / sizeof *far; k++)
			r = tokens_is(t, i, far[k]) ? PARSE_FAR : r;
		for (size_t k = 0; k < sizeof near / sizeof *near; k++)
			r = tokens_is(t, i, near[k]) ? PARSE_NEAR : r;
		if (r >= 0 && predicate_from(a, i) < 0 && (at = predicate_from(grammar, i)) >= 0)
			take_predicate(a, grammar, at);
		at = r >= 0 ? predicate_from(a, i) : -1;
		if (at < 0)
			continue;
		const struct analysis_word predicate = a->word[at];
		analysis_give_up(&a->word[at]);
		a->word[i] = predicate;
		a->word[i].relation = (enum parse_relation)r;
		for (int j = 0; j < t->n; j++)
			if (a->word[j].role == ROLE_ANCHOR && a->word[j].head == at)
				a->word[j].head = i;
	}
}

/* "the door that isn't brown": brown ones are left out. */
static void mend_isnt(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 1 < t->n; i++) {
		const int next = tokens_class(t, i + 1) == CLOSED_ADVERB ? i + 2 : i + 1;
		if (tokens_class(t, i) == CLOSED_NEGATION && !tokens_is(t, i, "no") &&
			!tokens_is(t, i, "without") && next < t->n && !t->word[next].before &&
			a->word[next].role == ROLE_ATTRIBUTE && a->word[next].head < next &&
			noun_after(a, t, next) < 0)
			a->word[next].role = ROLE_EXCEPT;
	}
}

int analysis_has_anchor(const struct analysis *a, int predicate)
{
	for (int i = 0; i < a->n; i++)
		if (a->word[i].role == ROLE_ANCHOR && a->word[i].head == predicate)
			return 1;
	return 0;
}

/* The predicate without an anchor right before a phrase that begins at `begin`, or after the phrase with
 * "its" before it; or -1. */
static int predicate_for(const struct analysis *a, const struct tokens *t, int begin, int end)
{
	int i = begin - 1;

	while (tokens_is(t, i, "of") || tokens_is(t, i, "to") || tokens_is(t, i, "from") ||
		tokens_is(t, i, "than"))
		i--;
	if (i >= 0 && a->word[i].role == ROLE_PREDICATE && a->word[i].head == ROOT &&
		!analysis_has_anchor(a, i))
		return i;
	for (i = end + 1; i < t->n && i <= end + 5 && !t->word[i].before; i++)
		if (a->word[i].role == ROLE_PREDICATE && a->word[i].head == ROOT &&
			tokens_is(t, i - 1, "its"))
			return analysis_has_anchor(a, i) ? -1 : i;
	return -1;
}

/* "the chair beside the grey one": grey is the anchor. */
static void mend_ones(struct analysis *a, const struct tokens *t)
{
	int found = 0;

	for (int i = 0; i < t->n; i++) {
		const int is_free = a->word[i].role == ROLE_NONE || (found && a->word[i].role == ROLE_TARGET);
		int begin = i;
		if (tokens_is(t, i, "one") && found && is_free) {
			while (begin > 0 && a->word[begin - 1].role == ROLE_ATTRIBUTE &&
				a->word[begin - 1].head == ROOT)
				begin--;
			if (tokens_is(t, begin - 1, "the") && begin < i) {
				const int p = predicate_for(a, t, begin - 1, i);
				for (int j = begin; j < i && p >= 0; j++)
					a->word[j].head = i;
				if (p >= 0)
					a->word[i] = (struct analysis_word){.role = ROLE_ANCHOR, .head = p};
			}
		}
		found |= a->word[i].role == ROLE_TARGET;
	}
}

/* "the nails of the left wheel": the noun that "of" before a phrase hangs it on, as a part of it, or -1. */
static int part_before(const struct analysis *a, const struct tokens *t, int noun)
{
	int i = noun - 1;

	while (i > 0 && !tokens_is(t, i, "of") && !t->word[i + 1].before && !role_is_phrase(a->word[i].role))
		i--;
	return i > 0 && tokens_is(t, i, "of") && a->word[i - 1].role == ROLE_ANCHOR ? i - 1 : -1;
}

/* "by the hinge of the gate on the left of the barn": it is the gate that is by it, and on the left. */
static void mend_part_of(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int part = a->word[i].role == ROLE_ANCHOR ? part_before(a, t, i) : -1;
		if (part < 0 || a->word[i].head < i)
			continue;
		a->word[i].head = a->word[part].head;
		analysis_give_up(&a->word[part]);
		for (int j = 0; j < t->n; j++)
			if (a->word[j].head == part)
				a->word[j].head = i;
	}
}

/* "near the gate, left of the barn": the gate is no anchor of what comes after it, where what comes before it
 * has none. */
static void mend_later(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		int p = i - 1;
		if (a->word[i].role != ROLE_ANCHOR || a->word[i].head < i)
			continue;
		while (p > 0 && !t->word[p + 1].before && a->word[p].role != ROLE_PREDICATE &&
			!role_is_phrase(a->word[p].role))
			p--;
		if (a->word[p].role == ROLE_PREDICATE && tokens_class(t, p) == CLOSED_PLACE &&
			!t->word[p + 1].before && !analysis_has_anchor(a, p) &&
			a->word[p].relation != PARSE_SUPPORTS)
			a->word[i].head = p;
	}
}

/* "the jug plus the bowl by the door" are two. */
static void mend_plus(struct analysis *a, const struct tokens *t)
{
	int found = 0;

	for (int i = 0; i < t->n; i++) {
		int begin = i;
		while (begin > 0 && !role_is_phrase(a->word[begin - 1].role) &&
			!tokens_is(t, begin - 1, "plus"))
			begin--;
		if (found && role_is_phrase(a->word[i].role) && begin > 0 && tokens_is(t, begin - 1, "plus"))
			a->word[i] = (struct analysis_word){.role = ROLE_ALSO, .head = ROOT};
		found |= a->word[i].role == ROLE_TARGET;
	}
}

void analysis_mend(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	mend_ones(a, t);
	mend_part_of(a, t);
	mend_later(a, t);
	mend_plus(a, t);
	mend_parts(a, t);
	mend_ways(a, grammar, t);
	mend_isnt(a, t);
	mend_sizes(a, t);
	mend_viewer(a, t);
	mend_negation(a, t);
	mend_colours(a, t);
	mend_pairs(a, t);
	analysis_reread(a, grammar, t);
	analysis_places(a, t);
	analysis_talk(a, t);
	analysis_sentences(a, t);
	analysis_repair(a);
}
