/* What is named one by one: "two boxes, the red one on the shelf and the one by the door", "the tallest of
 * the mug and the jar". */
#include "lang/analysis.h"

#include <string.h>

/* Whether a phrase has no noun but the target's: "the red one". */
static int is_one_of(const struct parse_phrase *f, const struct parse_phrase *target)
{
	return !f->noun.n || (target->noun.n && f->noun.item[0] == target->noun.item[0]);
}

/* Whether the target's noun says no more than that there are several: "the things", "a group". */
static int is_of_things(const struct parse *p, const struct parse_phrase *f)
{
	return !f->noun.n ||
	       parse_word_is(p, f->noun.item[f->noun.n - 1], "group|pair|trio|set|lot|collection|bunch");
}

/* Whether the further targets are the members of what the target names. */
static int are_members(const struct parse *p)
{
	const struct parse_phrase *f = &p->phrases[0];

	if (f->count == PARSE_ONE || f->also.n < 2 || (f->count > 1 && f->count != f->also.n))
		return 0;
	for (int k = 0; k < f->also.n; k++)
		if (!is_one_of(&p->phrases[f->also.item[k]], f) && !is_of_things(p, f))
			return 0;
	return 1;
}

/* What is said of all is said of each. */
static int take_common(struct parse_phrase *f, const struct parse_phrase *all, struct err *e)
{
	if (!f->noun.n && parse_list_join(&f->noun, &all->noun, e))
		return -1;
	return parse_list_join(&f->attributes, &all->attributes, e) ||
			       parse_list_join(&f->clauses, &all->clauses, e)
		       ? -1
		       : 0;
}

/* The first member becomes the target. */
static int turn(struct parse *p, struct err *e)
{
	struct parse_phrase *f = &p->phrases[0];
	const int first = f->also.item[0];
	struct parse_phrase *member = &p->phrases[first];
	const struct parse_phrase all = *f;

	for (int k = 1; k < f->also.n; k++)
		f->also.item[k - 1] = f->also.item[k];
	f->also.n--;
	if (parse_list_join(&member->also, &f->also, e) || parse_list_join(&member->except, &f->except, e))
		return -1;
	*f = *member;
	p->phrases[first] = all;
	parse_list_cut(&p->phrases[first].also, 0);
	parse_list_cut(&p->phrases[first].except, 0);
	p->phrases[first].group = 0;
	return 0;
}

/* Whether the target and what is meant too are a choice: "of the mug and the jar", of which one is most so.
 */
static int are_choice(const struct parse *p)
{
	const struct parse_phrase *f = &p->phrases[0];
	int word = 0, is = 0;

	while (word < p->word_count && p->words[word].span.end <= f->span.begin)
		word++;
	while (word > 0 && parse_word_is(p, word - 1, "the|my|your|this|that"))
		word--;
	if (!word || !f->also.n || f->count != PARSE_ONE || f->group ||
		!parse_word_is(p, word - 1, "of|among|between|from"))
		return 0;
	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		is |= c->degree != PARSE_PLAIN && !c->anchors.n;
	}
	return is;
}

/* The target becomes one of several, of which its superlatives tell it. */
static int turn_choice(struct parse *p, struct err *e)
{
	const int last = p->phrase_count;
	struct parse_phrase one = {.count = PARSE_ONE};

	if (parse_make_room(p, e))
		return -1;
	struct parse_phrase *phrases = p->phrases;
	p->phrase_count++;
	one.span = phrases[0].span;
	one.group = phrases[0].also.n + 1;
	one.among = phrases[0].also;
	one.clauses = phrases[0].clauses;
	one.except = phrases[0].except;
	one.ordinal = phrases[0].ordinal;
	one.from = phrases[0].from;
	phrases[last] = phrases[0];
	phrases[last].ordinal = 0;
	phrases[last].from = PARSE_OTHER;
	phrases[last].also = phrases[last].clauses = phrases[last].except = (struct parse_list){0};
	phrases[0] = one;
	return parse_list_add(&phrases[0].among, last, e);
}

/* The word that begins what is said of several, "that are taller", or -1. */
static int find_shared(const struct parse *p)
{
	for (int w = 1; w + 1 < p->word_count; w++)
		if (parse_word_is(p, w, "that|which|who") &&
			parse_word_is(p, w + 1, "are|have|were|stand|lie|sit|hang|can|do"))
			return w;
	return -1;
}

/* What is said of the last from that word on is said of a phrase, too. */
static int take_shared(
	struct parse *p, struct parse_phrase *f, const struct parse_phrase *last, int word, struct err *e)
{
	const int begin = p->words[word].span.begin;
	int bad = 0;

	f->count = PARSE_ALL; /* none of them may be so */
	for (int k = 0; k < last->attributes.n && f != last && !bad; k++)
		if (last->attributes.item[k] > word)
			bad = parse_list_add(&f->attributes, last->attributes.item[k], e);
	for (int k = 0; k < last->clauses.n && f != last && !bad; k++)
		if (p->clauses[last->clauses.item[k]].span.begin > begin)
			bad = parse_list_add(&f->clauses, last->clauses.item[k], e);
	for (int k = 0; k < last->except.n && f != last && !bad; k++)
		if (p->phrases[last->except.item[k]].span.begin > begin)
			bad = parse_list_add(&f->except, last->except.item[k], e);
	return bad;
}

int parse_shared(struct parse *p, struct err *e)
{
	const int word = find_shared(p);
	struct parse_phrase *f = &p->phrases[0], *last = NULL;

	if (word < 0 || !f->also.n)
		return 0;
	for (int k = -1; k < f->also.n; k++) {
		struct parse_phrase *member = k < 0 ? f : &p->phrases[f->also.item[k]];
		if (member->span.begin < p->words[word].span.begin &&
			(!last || member->span.begin > last->span.begin))
			last = member;
	}
	for (int k = -1; k < f->also.n && last; k++)
		if (take_shared(p, k < 0 ? f : &p->phrases[f->also.item[k]], last, word, e))
			return -1;
	return 0;
}

int parse_members(struct parse *p, struct err *e)
{
	if (are_choice(p) && turn_choice(p, e))
		return -1;
	const struct parse_phrase *f = &p->phrases[0];
	if (f->among.n > 1 && f->count == PARSE_ONE && !f->group)
		p->phrases[0].group = f->among.n;
	if (!are_members(p))
		return 0;
	for (int k = 0; k < f->also.n; k++)
		if (take_common(&p->phrases[f->also.item[k]], f, e))
			return -1;
	return turn(p, e);
}
