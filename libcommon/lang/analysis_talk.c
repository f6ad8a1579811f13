/* Another part of what closed-class words settle (analysis_mend.c): compounds, what "with" has, poses, and
 * what is denied. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/wordnet.h"

/* The last of the words from i on that stand together as a noun and what describes it, or -1. */
static int noun_of_run(const struct analysis *a, const struct tokens *t, int i)
{
	int last = -1;

	for (; i < t->n && !t->word[i].before; i++) {
		const int class = tokens_class(t, i);
		if (class >= 0 && class != CLOSED_ATTRIBUTE && class != CLOSED_SIZE &&
			class != CLOSED_GENERIC)
			break;
		last = class != CLOSED_ATTRIBUTE && class != CLOSED_SIZE ? i : last;
		if (role_is_phrase(a->word[i].role))
			return i;
	}
	return last;
}

/* What word `from` is becomes word `to`, with all that hangs on it. */
static void move_role(struct analysis *a, int from, int to)
{
	a->word[to] = a->word[from];
	for (int i = 0; i < a->n; i++)
		if (a->word[i].head == from)
			a->word[i].head = to;
}

/* "the ash-coloured dish", "a pebble-looking gadget": ash and pebble say what it looks like. */
static void mend_compounds(struct analysis *a, const struct tokens *t)
{
	static const char *const looks[] = {
		"coloured", "colored", "hued", "toned", "tinted", "looking", "shaped", "sized", NULL};

	for (int i = 1; i < t->n; i++) {
		const int is_one = tokens_is_any(t, i, looks) && !t->word[i].before &&
				   (t->word[i - 1].closed < 0 || tokens_class(t, i - 1) == CLOSED_ATTRIBUTE);
		const int noun = is_one ? noun_of_run(a, t, i + 1) : -1;
		if (noun < 0)
			continue;
		if (role_is_phrase(a->word[i - 1].role) && !role_is_phrase(a->word[noun].role))
			move_role(a, i - 1, noun);
		if (role_is_phrase(a->word[i].role) && !role_is_phrase(a->word[noun].role))
			move_role(a, i, noun);
		const int head = a->word[noun].role == ROLE_TARGET ? ROOT : noun;
		if (role_is_phrase(a->word[noun].role))
			a->word[i - 1] = (struct analysis_word){.role = ROLE_ATTRIBUTE, .head = head};
		analysis_give_up(&a->word[i]);
	}
}

/* "with white swirls, the one farthest left": the swirls are what it has, and no anchor of what comes after
 * the pause. */
static void mend_with_before_pause(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		int with = i - 1, is_parted = 0;
		if (a->word[i].role != ROLE_ANCHOR || a->word[i].head < i)
			continue;
		for (int j = i + 1; j <= a->word[i].head; j++)
			is_parted |= t->word[j].before != PAUSE_NONE;
		while (with > 0 && !t->word[with + 1].before && tokens_class(t, with) != CLOSED_WITH &&
			!role_is_phrase(a->word[with].role) && !analysis_is_predicate(a, with))
			with--;
		if (!is_parted || t->word[with + 1].before || tokens_class(t, with) != CLOSED_WITH ||
			analysis_has_anchor(a, with))
			continue;
		if (!analysis_is_predicate(a, with))
			a->word[with] = (struct analysis_word){ROLE_PREDICATE, ROOT, PARSE_WITH, 0};
		a->word[i].head = with;
	}
}

/* "no plate under it" too. */
static int is_having(const struct tokens *t, int i)
{
	return analysis_has(t, i) || tokens_is(t, i, "no");
}

/* "which ball has a book just behind it and a cup on its left?" is in front of the book, right of the cup. */
static void mend_has_it(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		const enum parse_relation said =
			tokens_class(t, i) == CLOSED_PLACE
				? (enum parse_relation)closed_words[t->word[i].closed].relation
				: PARSE_OTHER;
		int has, anchor = -1;
		const int is_of_it = tokens_is(t, i - 1, "its") || tokens_is(t, i + 1, "it") ||
				     (tokens_is(t, i + 1, "of") && tokens_is(t, i + 2, "it"));
		if (!analysis_is_predicate(a, i) || said > PARSE_ON || a->word[i].relation != said ||
			!is_of_it)
			continue;
		for (int j = 0; j < i; j++)
			anchor = a->word[j].role == ROLE_ANCHOR && a->word[j].head == i ? j : anchor;
		for (has = anchor; has > 0 && !is_having(t, has); has--)
			if (t->word[has].before == PAUSE_STOP || a->word[has].role == ROLE_TARGET)
				break;
		if (anchor > 0 && is_having(t, has))
			a->word[i].relation = closed_inverse(said);
	}
}

/* "See the cup? I want the thing just right of it": what is meant is right of it, whatever was spoken of. */
static void mend_of_it(struct analysis *a, const struct tokens *t)
{
	static const char *const what[] = {"what", "whatever", NULL};

	for (int i = 1; i < t->n; i++) {
		const int it = tokens_is(t, i + 1, "of") ? i + 2 : i + 1;
		int before = i - 1;
		if (!analysis_is_predicate(a, i) || tokens_class(t, i) != CLOSED_PLACE ||
			!tokens_is(t, it, "it"))
			continue;
		while (before > 0 && !role_is_phrase(a->word[before].role) && !is_having(t, before) &&
			!tokens_is(t, before, "it") && !tokens_is_any(t, before, what) &&
			!t->word[before].before)
			before--;
		const enum parse_relation said =
			(enum parse_relation)closed_words[t->word[i].closed].relation;
		if ((a->word[before].role == ROLE_TARGET || tokens_is_any(t, before, what)) &&
			a->word[i].head == ROOT && said <= PARSE_ON &&
			a->word[i].relation == closed_inverse(said))
			a->word[i].relation = said;
	}
}

/* "not the one on the box, over on the right": what comes after the pause and names nothing is said of what
 * is meant. */
static void mend_after_pause(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int is_parted = 0;
		if (!analysis_is_predicate(a, i) || tokens_class(t, i) != CLOSED_PLACE ||
			a->word[i].relation > PARSE_BELOW || a->word[i].head == ROOT || a->word[i].head > i ||
			analysis_has_anchor(a, i))
			continue;
		for (int j = a->word[i].head + 1; j <= i; j++)
			is_parted |= t->word[j].before != PAUSE_NONE;
		if (is_parted)
			a->word[i].head = ROOT;
	}
}

/* "any colour but orange": orange is left out. */
static void mend_any_colour(struct analysis *a, const struct tokens *t)
{
	static const char *const colour[] = {"colour", "color", NULL}, *const but[] = {"but", "except", NULL};

	for (int i = 1; i + 2 < t->n; i++) {
		const int out = tokens_is_any(t, i + 1, but) ? i + 2 : i + 3;
		const int is_but =
			out == i + 2 || (tokens_is(t, i + 1, "other") && tokens_is(t, i + 2, "than"));
		if (!tokens_is_any(t, i, colour) || !is_but || out >= t->n ||
			colour_word(t->word[out].text) < 0)
			continue;
		analysis_give_up(&a->word[i]);
		a->word[out] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
	}
}

/* "the things that sit on plates": to sit somewhere is no use; "can they" is no can. */
static void mend_verbs_of_pose(struct analysis *a, const struct tokens *t)
{
	static const char *const poses[] = {"sit", "sits", "sat", "stand", "stands", "stood", "lie", "lies",
		"lay", "rest", "rests", "lean", "leans", "live", "lives", "hang", "hangs", "stay", "stays",
		NULL};

	for (int i = 0; i < t->n; i++) {
		if (analysis_is_predicate(a, i) && a->word[i].relation == PARSE_OTHER &&
			tokens_is_any(t, i, poses) && !analysis_has_anchor(a, i) &&
			tokens_class(t, i + 1) != -1)
			analysis_give_up(&a->word[i]);
		if (tokens_is(t, i, "can") && tokens_class(t, i + 1) == CLOSED_PRONOUN)
			analysis_give_up(&a->word[i]);
	}
}

/* "an empty plate", "the plates are still empty": they carry nothing. */
static void mend_empty(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int verb = tokens_class(t, i - 1) == CLOSED_ADVERB || tokens_is(t, i - 1, "still")
					 ? i - 2
					 : i - 1;
		const int is_said = a->word[i].role == ROLE_ATTRIBUTE || a->word[i].role == ROLE_NAME ||
				    (a->word[i].role == ROLE_NONE && tokens_class(t, verb) == CLOSED_BE);
		if (tokens_is(t, i, "empty") && is_said)
			a->word[i] =
				(struct analysis_word){ROLE_PREDICATE, a->word[i].head, PARSE_SUPPORTS, 1};
	}
}

/* "no pattern", "no big one". */
static int has_no(const struct analysis *a, const struct tokens *t, int noun)
{
	int i = noun - 1;

	while (i >= 0 && !t->word[i + 1].before &&
		(a->word[i].role == ROLE_ATTRIBUTE || a->word[i].role == ROLE_NAME))
		i--;
	return !t->word[i + 1].before && tokens_is(t, i, "no");
}

/* "isn't over to the left of it" is not left of it; "isn't carrying anything" leaves out nothing. */
static void mend_denied(struct analysis *a, const struct tokens *t)
{
	static const char *const any[] = {"anything", "anyone", "everything", NULL};
	int denied = 0;

	for (int i = 1; i < t->n; i++) {
		int j = i + 1;
		if (a->word[i].role == ROLE_ANCHOR && has_no(a, t, i) &&
			analysis_is_predicate(a, a->word[i].head) && a->word[i].head > i)
			a->word[a->word[i].head].negated = 1;
		denied |= analysis_is_predicate(a, i) && a->word[i].negated;
		if (denied && a->word[i].role == ROLE_EXCEPT && tokens_is_any(t, i, any))
			analysis_give_up(&a->word[i]);
		if (tokens_class(t, i) != CLOSED_NEGATION || tokens_class(t, i - 1) != CLOSED_BE)
			continue;
		while (j < i + 5 && j < t->n && a->word[j].role == ROLE_NONE && t->word[j].closed >= 0 &&
			!t->word[j].before)
			j++;
		if (analysis_is_predicate(a, j) && !t->word[j].before && tokens_class(t, j) == CLOSED_PLACE &&
			a->word[j].relation <= PARSE_INSIDE &&
			a->word[j].relation == (enum parse_relation)closed_words[t->word[j].closed].relation)
			a->word[j].negated = 1;
	}
}

/* Whether a word says how a thing looks, and no noun comes after it of which it says so. */
static int is_look_alone(const struct analysis *a, const struct tokens *t, int i)
{
	const int is_look = i < t->n && !t->word[i].before &&
			    (colour_word(t->word[i].text) >= 0 || tokens_class(t, i) == CLOSED_ATTRIBUTE);

	return is_look && (i + 1 == t->n || t->word[i + 1].before || a->word[i + 1].role == ROLE_NONE);
}

/* "the can that isn't orange or red": what is orange is left out, and what is red. */
static void mend_denied_looks(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		int j = i + 1;
		while (tokens_class(t, j) == CLOSED_ADVERB)
			j++;
		if (tokens_class(t, i) != CLOSED_NEGATION || !is_look_alone(a, t, j))
			continue;
		if (a->word[j].role == ROLE_NONE)
			a->word[j] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
		if (a->word[j].role == ROLE_EXCEPT &&
			(tokens_is(t, j + 1, "or") || tokens_is(t, j + 1, "nor")) &&
			is_look_alone(a, t, j + 2))
			a->word[j + 2] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
	}
}

static int is_noun(const struct tokens *t, int i)
{
	struct wordnet_noun noun;

	if (i >= t->n || t->word[i].closed >= 0 || colour_word(t->word[i].text) >= 0)
		return 0;
	wordnet_find(&noun, t->word[i].lemma);
	return noun.n > 0;
}

/* "The wizard's hat" is a hat, and what is over the laptop's screen is over the laptop. */
static void mend_possessive(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i + 1 < t->n; i++) {
		const struct analysis_word owner = a->word[i - 1];
		if (!tokens_is(t, i, "'s") || t->word[i + 1].before)
			continue;
		if (owner.role == ROLE_ANCHOR && a->word[i + 1].role == ROLE_ANCHOR &&
			a->word[i + 1].head == owner.head && is_noun(t, i + 1)) {
			analysis_give_up(&a->word[i + 1]);
		} else if (owner.role == ROLE_TARGET &&
			   (a->word[i + 1].role == ROLE_NONE || a->word[i + 1].role == ROLE_NAME) &&
			   is_noun(t, i - 1) && is_noun(t, i + 1)) {
			move_role(a, i - 1, i + 1);
			a->word[i - 1] = (struct analysis_word){.role = ROLE_NAME, .head = ROOT};
		}
	}
}

void analysis_talk(struct analysis *a, const struct tokens *t)
{
	mend_after_pause(a, t);
	mend_any_colour(a, t);
	mend_verbs_of_pose(a, t);
	mend_empty(a, t);
	mend_denied(a, t);
	mend_denied_looks(a, t);
	mend_compounds(a, t);
	mend_possessive(a, t);
	mend_with_before_pause(a, t);
	mend_has_it(a, t);
	mend_of_it(a, t);
}
