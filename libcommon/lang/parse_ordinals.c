/* "The second from the left": which of those that fit, told from the closed-class words around. */
#include "lang/parse_private.h"

/* "from the left", "from left", "left to right", "start at the left-hand end". */
static enum parse_relation counted_from(struct build *b)
{
	const struct tokens *t = b->t;

	for (int i = 0; i < t->n; i++) {
		if (build_is_way(t, i))
			return build_end(t, i);
		if (!tokens_is(t, i, "from|at"))
			continue;
		int j = i + 1;
		while (tokens_is(t, j, "the|very|far"))
			j++;
		if (build_end(t, j) != PARSE_OTHER && !tokens_is(t, j + 1, "of")) {
			b->from = b->a->word[j].role == ROLE_PREDICATE ? j : b->from;
			return build_end(t, j);
		}
	}
	return PARSE_OTHER;
}

/* Words that go on with an ordinal by itself: "third from", "second in". */
static int goes_on(const struct tokens *t, int i)
{
	return tokens_is(t, i, "from|fae|frae|along|down|up|in|on|of");
}

/* Whether word j is called like the target: "a row of cars, the third car". */
static int is_called_so(const struct build *b, int j)
{
	return b->noun >= 0 && !strcmp(b->t->word[j].lemma, b->t->word[b->noun].lemma);
}

/* What an ordinal before other words counts: the phrase of the next noun, or of the thing that the next
 * predicate is said of ("second nearest to the door"); -1 where that is nothing that is meant ("last
 * Friday"), or where no word goes on with it (*is_alone). */
static int counted_by(const struct build *b, int i, int *is_alone)
{
	const struct tokens *t = b->t;
	int is_named = 0; /* words that say something have come */

	if (goes_on(t, i + 1) && b->a->word[i + 1].role != ROLE_PREDICATE) {
		*is_alone = 1;
		return -1;
	}
	for (int j = i + 1; j < t->n && j <= i + 4 && !t->word[j].before; j++) {
		const enum word_role role = b->a->word[j].role;
		const int class = tokens_class(t, j);
		if (b->phrase_of[j] >= 0)
			return b->phrase_of[j];
		if (role == ROLE_PREDICATE && (class != CLOSED_PREPOSITION || j == i + 1))
			return build_phrase_under(b, b->a->word[j].head);
		if (class == CLOSED_GENERIC)
			return 0;
		if (role == ROLE_NONE && class < 0) {
			if (is_called_so(b, j))
				return 0;
			if (build_value(t, i) < 0) /* "last week" */
				return -1;
			is_named = 1;
		} else if (role == ROLE_NONE && class != CLOSED_NUMBER && class != CLOSED_SIZE &&
			   class != CLOSED_ATTRIBUTE && class != CLOSED_ADVERB)
			break;
	}
	*is_alone = !is_named;
	return -1;
}

/* "the second", "third from the left", "what comes first"; not "for a second", "put first". */
static int counts_alone(const struct tokens *t, int i)
{
	const int is_start = !i || t->word[i].before != PAUSE_NONE;
	const int is_end = i + 1 >= t->n || t->word[i + 1].before != PAUSE_NONE;

	const int before = tokens_is(t, i - 1, "very") ? i - 2 : i - 1;

	if (tokens_is(t, before,
		    "the|that|this|comes|come|coming|came|stands|stand|meet|meets|reach|hit|pass") ||
		tokens_class(t, before) == CLOSED_BE)
		return 1;
	const int is_first_or_last = build_value(t, i) == 1 || build_value(t, i) < 0;
	if (goes_on(t, i + 1))
		return !is_first_or_last || is_start || tokens_is(t, i + 1, "from");
	return is_end && !is_start && !is_first_or_last && !tokens_is(t, i - 1, "a") &&
	       tokens_class(t, i - 1) != CLOSED_CONJUNCTION;
}

/* What the ordinal at word i counts, as a phrase, or -1. */
static int owner_of(const struct build *b, int i)
{
	int is_alone = 0;
	const int owner = counted_by(b, i, &is_alone);

	return is_alone ? (counts_alone(b->t, i) ? 0 : -1) : owner;
}

/* "number two". */
static int number_after(const struct tokens *t, int i)
{
	if (!tokens_is(t, i, "number"))
		return 0;
	if (tokens_is(t, i + 1, "one"))
		return 1;
	return tokens_class(t, i + 1) == CLOSED_NUMBER && build_value(t, i + 1) > 0 ? build_value(t, i + 1)
										    : 0;
}

void parse_ordinals(struct build *b)
{
	const struct tokens *t = b->t;

	for (int i = 0; i < t->n; i++) {
		int value = number_after(t, i), owner = 0;
		if (tokens_class(t, i) == CLOSED_ORDINAL) {
			owner = owner_of(b, i);
			value = build_value(t, i);
		}
		if (!value || owner < 0)
			continue;
		b->p->phrases[owner].ordinal = value;
		b->p->phrases[owner].from = counted_from(b);
	}
}
