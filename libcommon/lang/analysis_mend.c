/* What closed-class words settle whatever a learnt parser makes of them: how something looks, and how it does
 * not. Rules that change no answer to sentences on which none was written are left out (pipelines/parse.md).
 */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/compared.h"

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

/* "left of the plain grey one": plain and grey are said of what comes right after them. */
static void mend_attributes(struct analysis *a, const struct tokens *t)
{
	int noun = -1; /* that word i + 1 is, or is said of as it stands before it */

	for (int i = t->n - 1; i >= 0; i--) {
		if (noun >= 0 && t->word[i + 1].before)
			noun = -1;
		if (a->word[i].role == ROLE_ATTRIBUTE && noun >= 0 && tokens_class(t, i) != CLOSED_RELATIVE)
			a->word[i].head = a->word[noun].role == ROLE_TARGET ? ROOT : noun;
		else if (a->word[i].role != ROLE_NAME)
			noun = role_is_phrase(a->word[i].role) ? i : -1;
	}
}

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

/* Of an end of a thing ("the bottom" in "pale green at the bottom") the word before that place; else -1. */
static int look_of_end(const struct tokens *t, int i)
{
	const int before = tokens_is(t, i - 1, "the") ? i - 2 : i - 1;

	if (!tokens_is_any(t, i, closed_ends) || before < 1 || !tokens_is_any(t, before, closed_at_end))
		return -1;
	for (int j = before; j <= i; j++)
		if (t->word[j].before)
			return -1;
	return before - 1;
}

/* "Pale green at the bottom" says how a part looks, and not where the thing is. */
static void mend_ends(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int look = look_of_end(t, i);
		if (look >= 0 && a->word[i].role == ROLE_PREDICATE && !analysis_has_anchor(a, i) &&
			a->word[look].role == ROLE_ATTRIBUTE)
			analysis_give_up(&a->word[i]);
	}
}

/* The first noun from word i on, or -1; none stands before a word of `stop`. */
static int next_noun(const struct analysis *a, const struct tokens *t, int i, const char *stop)
{
	for (; i < t->n && !tokens_is(t, i, stop); i++)
		if (role_is_phrase(a->word[i].role))
			return i;
	return -1;
}

/* "left of both the jar and the tin": of the tin too. */
static void mend_both(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		const int is_of = tokens_class(t, i - 1) == CLOSED_PREPOSITION || tokens_is(t, i - 1, "than");
		const int first = tokens_is(t, i, "both") && is_of ? next_noun(a, t, i + 1, "and") : -1;
		const int second =
			first >= 0 && tokens_is(t, first + 1, "and") ? next_noun(a, t, first + 2, "and") : -1;
		if (second >= 0 && a->word[first].role == ROLE_ANCHOR && a->word[second].role == ROLE_ALSO)
			a->word[second] = a->word[first];
	}
}

/* "Who is wearing the scarf?" asks for whoever has it, not for the scarf. */
static void mend_who(struct analysis *a, const struct tokens *t)
{
	int who = 0, predicate, noun = 0;

	while (who < t->n && !tokens_is(t, who, "who"))
		who++;
	for (predicate = who + 1; predicate < t->n && !analysis_is_predicate(a, predicate);)
		predicate++;
	while (noun < t->n && a->word[noun].role != ROLE_TARGET)
		noun++;
	if (predicate >= t->n || noun >= t->n || noun < who || a->word[who].role != ROLE_NONE ||
		analysis_has_anchor(a, predicate) ||
		(a->word[predicate].relation != PARSE_WITH && a->word[predicate].relation != PARSE_SUPPORTS))
		return;
	for (int i = 0; i < t->n; i++)
		if (a->word[i].role == ROLE_ATTRIBUTE && a->word[i].head == ROOT)
			a->word[i].head = noun;
	a->word[noun].role = ROLE_ANCHOR;
	a->word[noun].head = predicate;
	a->word[who] = (struct analysis_word){.role = ROLE_TARGET, .head = ROOT};
	a->word[predicate].head = who;
}

/* Whether a word is said of something as a look or a size. */
static int is_said_of_looks(const struct analysis_word *w)
{
	return w->role == ROLE_ATTRIBUTE || w->role == ROLE_NAME || w->role == ROLE_TARGET ||
	       (w->role == ROLE_PREDICATE && w->relation >= PARSE_LARGER && w->relation <= PARSE_WIDER);
}

/* "the darkest", "the most colourful one", "shinier than the tin": no sizes, but looks that are compared. */
static void mend_compared(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const struct analysis_word w = a->word[i];
		if (!is_said_of_looks(&w) || compared_at(t, i) == PARSE_PLAIN)
			continue;
		const int is_of_target = w.head >= 0 && a->word[w.head].role == ROLE_TARGET;
		a->word[i] = (struct analysis_word){ROLE_PREDICATE, is_of_target ? ROOT : w.head, PARSE_OTHER,
			w.role == ROLE_PREDICATE && w.negated};
		const int start = tokens_class(t, i + 2) == CLOSED_DETERMINER ? i + 3 : i + 2;
		const int noun = tokens_is(t, i + 1, "than") ? noun_of_run(a, t, start) : -1;
		if (noun >= 0 && a->word[noun].role == ROLE_NONE)
			a->word[noun] = (struct analysis_word){.role = ROLE_ANCHOR, .head = i};
	}
}

void analysis_mend(struct analysis *a, const struct analysis *grammar, const struct tokens *t)
{
	analysis_denied(a, t);
	mend_attributes(a, t);
	analysis_places(a, grammar, t);
	analysis_it(a, t);
	analysis_command(a, t);
	mend_any_colour(a, t);
	mend_empty(a, t);
	mend_compared(a, t);
	mend_both(a, t);
	mend_who(a, t);
	mend_compounds(a, t);
	mend_ends(a, t);
	analysis_repair(a);
}
