/* Rules that settle, whatever a learnt parser makes of the words, what closed-class words say: how something
 * looks or does not, who looks, and places. lang/rules.def has them. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/compared.h"
#include "lang/rules.h"

/* Words between two predicates of one place. */
enum { PLACE_REACH = 4 };

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

/* "the door that isn't brown", "isn't made of wood": such are left out. */
static void take_isnt(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i + 1 < t->n; i++) {
		int next = tokens_class(t, i + 1) == CLOSED_ADVERB ? i + 2 : i + 1;
		next += tokens_is(t, next, "made|built|cut") && tokens_is(t, next + 1, "of|from") ? 2 : 0;
		if (tokens_class(t, i) == CLOSED_NEGATION && !tokens_is(t, i, "no|without") && next < t->n &&
			!t->word[next].before && a->word[next].role == ROLE_ATTRIBUTE &&
			a->word[next].head < next && noun_after(a, t, next) < 0)
			a->word[next].role = ROLE_EXCEPT;
	}
}

/* The last of the words from i on that stand together as a noun and what describes it, or -1. */
static int noun_of_run(const struct analysis *a, const struct tokens *t, int i)
{
	int last = -1;

	for (const int first = i; i < t->n && (i == first || !t->word[i].before); i++) {
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

/* "everything but the bowls, the mugs and a plate": what a list goes on with is left out too. */
static void take_excepts(struct analysis *a, const struct tokens *t)
{
	int is_all = 0, i = 0, noun;

	for (; i < t->n && a->word[i].role != ROLE_EXCEPT; i++)
		is_all |= tokens_class(t, i) == CLOSED_GENERIC ||
			  tokens_is(t, i, "all|everything|anything|else|what|which|objects|items");
	while (is_all && ++i < t->n &&
		(t->word[i].before == PAUSE_COMMA || tokens_class(t, i) == CLOSED_CONJUNCTION)) {
		while (tokens_class(t, i) == CLOSED_CONJUNCTION || tokens_class(t, i) == CLOSED_DETERMINER ||
			tokens_class(t, i) == CLOSED_NUMBER)
			i++;
		noun = noun_of_run(a, t, i);
		if (noun < 0 || (a->word[noun].role != ROLE_TARGET && a->word[noun].role != ROLE_ALSO &&
					a->word[noun].role != ROLE_EXCEPT))
			return;
		a->word[noun] = (struct analysis_word){.role = ROLE_EXCEPT, .head = ROOT};
		i = noun;
	}
}

/* "an empty plate", "the plates are still empty": they carry nothing. What stands on something is not what
 * has something on it. */
static void take_empty(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (tokens_is(t, i, "on") && tokens_is(t, i + 1, "something|anything") && i + 2 == t->n &&
			a->word[i].role == ROLE_PREDICATE) {
			a->word[i].relation = PARSE_ON;
			a->word[i + 1] = (struct analysis_word){.role = ROLE_ANCHOR, .head = i};
		}
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

/* "Who is wearing the scarf?" asks for whoever has it, not for the scarf. */
static void take_who(struct analysis *a, const struct tokens *t)
{
	int who = 0, predicate, noun = 0;

	while (who < t->n && !tokens_is(t, who, "who"))
		who++;
	for (predicate = who + 1; predicate < t->n && !analysis_is_predicate(a, predicate);)
		predicate++;
	while (noun < t->n && a->word[noun].role != ROLE_TARGET)
		noun++;
	if (predicate >= t->n || noun >= t->n || noun < who || a->word[who].role != ROLE_NONE ||
		analysis_has_anchor(a, predicate))
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
static void take_compared(struct analysis *a, const struct tokens *t)
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

static int is_viewer(const struct tokens *t, int i)
{
	return (tokens_class(t, i) == CLOSED_PRONOUN && closed_words[t->word[i].closed].value == 1) ||
	       tokens_is(t, i, "you");
}

/* "the one closest to us". */
static void take_viewer(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		if (a->word[i].role != ROLE_NONE || !is_viewer(t, i) ||
			!tokens_is(t, i - 1, "to|from|between|near|nearest"))
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

/* The last predicate between words i and j with nothing but words that say nothing after it, or -1. */
static int last_predicate(const struct analysis *a, const struct tokens *t, int i, int j)
{
	while (--j > i && !t->word[j + 1].before && !role_is_phrase(a->word[j].role))
		if (a->word[j].role == ROLE_PREDICATE)
			return j;
	return -1;
}

/* "over by the sink" is by it. */
static void take_over_by(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int first = a->word[i].role == ROLE_ANCHOR ? a->word[i].head : i;
		const int last = first < i ? last_predicate(a, t, first, i) : -1;
		if (last < 0 || tokens_class(t, last) != CLOSED_PLACE || analysis_has_anchor(a, last) ||
			a->word[last].head != a->word[first].head)
			continue;
		a->word[i].head = last;
		if (!analysis_has_anchor(a, first) && tokens_is(t, first, "over|up|down"))
			analysis_give_up(&a->word[first]);
	}
}

/* The way that a word before "corner" says, or -1: the far corner is at the back. */
static int way_to_corner(const struct tokens *t, int i)
{
	return tokens_is(t, i, "far|back|rear|upper")		     ? PARSE_BEHIND
	       : tokens_is(t, i, "near|front|nearest|closest|lower") ? PARSE_FRONT
	       : tokens_is(t, i, "left")			     ? PARSE_LEFT
	       : tokens_is(t, i, "right")			     ? PARSE_RIGHT
								     : -1;
}

/* "in the back right corner" is at the back, on the right and in a corner. */
static void take_corner(struct analysis *a, const struct tokens *t)
{
	for (int i = 1; i < t->n; i++) {
		const int is_plain = analysis_is_predicate(a, i) && a->word[i].relation == PARSE_CORNER &&
				     !a->word[i].negated;
		for (int j = i - 1; is_plain && j >= 0 && !t->word[j + 1].before; j--) {
			const int way = way_to_corner(t, j);
			if (way < 0 && !tokens_is(t, j, "hand|most"))
				break;
			if (way >= 0 && !analysis_has_anchor(a, j))
				a->word[j] = (struct analysis_word){
					ROLE_PREDICATE, a->word[i].head, (enum parse_relation)way, 0};
		}
	}
}

/* The next predicate that is said of the same thing, with no phrase, pause or "and" before it; or -1. */
static int next_place(const struct analysis *a, const struct tokens *t, int i)
{
	for (int j = i + 1; j < t->n && j <= i + PLACE_REACH && !t->word[j].before; j++) {
		if (analysis_is_predicate(a, j))
			return a->word[j].head == a->word[i].head && a->word[j].negated == a->word[i].negated
				       ? j
				       : -1;
		if (role_is_phrase(a->word[j].role) || tokens_class(t, j) == CLOSED_CONJUNCTION)
			return -1;
	}
	return -1;
}

static enum parse_relation without_contact(enum parse_relation r)
{
	return r == PARSE_ON ? PARSE_ABOVE : r == PARSE_SUPPORTS ? PARSE_BELOW : r;
}

/* Relations to the room itself. */
static int is_of_room(enum parse_relation r)
{
	return r == PARSE_CORNER || r == PARSE_WALL || r == PARSE_FLOOR || r == PARSE_MIDDLE;
}

/* "on the very top" is one place, as are "right next to" and "closest to the corner". */
static void take_doubled(struct analysis *a, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const int j = analysis_is_predicate(a, i) ? next_place(a, t, i) : -1;
		if (j < 0)
			continue;
		const enum parse_relation first = without_contact(a->word[i].relation),
					  second = without_contact(a->word[j].relation);
		const int is_of_both = first == second || (first == PARSE_NEAR && is_of_room(second));
		if (is_of_both && !analysis_has_anchor(a, i))
			analysis_give_up(&a->word[i]);
		else if (first == second && !analysis_has_anchor(a, j))
			analysis_give_up(&a->word[j]);
	}
}

/* "The second chair from the window", "the first one you meet when you come from the door": by how near it
 * is. */
void analysis_take_from(struct analysis *a, const struct tokens *t)
{
	enum { REACH = 9 };
	int i = 0, j, noun;

	while (i < t->n && tokens_class(t, i) != CLOSED_ORDINAL && !tokens_is(t, i, "number"))
		i++;
	for (j = i + 1; j < t->n && j <= i + REACH && (!t->word[j].before || tokens_class(t, j) < 0); j++) {
		if (!tokens_is(t, j, "from") ||
			tokens_is(t, j + 1, "left|right|front|back|top|bottom|behind|above|below|here|there"))
			continue;
		const int first = tokens_class(t, j + 1) == CLOSED_DETERMINER ? j + 2 : j + 1;
		noun = noun_of_run(a, t, first);
		if (noun < 0 || tokens_class(t, first) == CLOSED_PLACE ||
			tokens_is(t, noun, "side|end|hand|direction") || a->word[noun].role != ROLE_NONE)
			return;
		for (int k = j + 1; k < noun; k++)
			if (k >= first && !role_is_phrase(a->word[k].role))
				a->word[k] = (struct analysis_word){.role = ROLE_NAME, .head = noun};
		a->word[j] = (struct analysis_word){ROLE_PREDICATE, ROOT, PARSE_NEAR, 0};
		a->word[noun] = (struct analysis_word){.role = ROLE_ANCHOR, .head = j};
		return;
	}
}

void analysis_apply_rules(struct analysis *a, const struct tokens *t, unsigned without)
{
	if (rule_counts(without, RULE_isnt))
		take_isnt(a, t);
	if (rule_counts(without, RULE_excepts))
		take_excepts(a, t);
	if (rule_counts(without, RULE_viewer))
		take_viewer(a, t);
	if (rule_counts(without, RULE_over_by))
		take_over_by(a, t);
	if (rule_counts(without, RULE_corner))
		take_corner(a, t);
	if (rule_counts(without, RULE_doubled))
		take_doubled(a, t);
	if (rule_counts(without, RULE_empty))
		take_empty(a, t);
	if (rule_counts(without, RULE_who))
		take_who(a, t);
	if (rule_counts(without, RULE_compared))
		take_compared(a, t);
	analysis_repair(a);
}
