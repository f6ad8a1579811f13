/* "Somebody put a mug on one of the trays. I need that tray.": what a sentence tells of at first is not what
 * it asks for at last. */
#include "lang/analysis.h"
#include "lang/closed.h"

#include <string.h>

static const char *head_of(const struct parse *p, int phrase)
{
	const struct parse_list *noun = &p->phrases[phrase].noun;

	return noun->n ? p->words[noun->item[noun->n - 1]].lemma : "";
}

/* Whether the target is said to be anywhere among the bytes from..to-1: "the jar beside that tray". */
static int is_placed(const struct parse *p, int from, int to)
{
	const struct parse_list *clauses = &p->phrases[0].clauses;

	for (int k = 0; k < clauses->n; k++) {
		const int begin = p->clauses[clauses->item[k]].span.begin;
		if (begin >= from && begin < to)
			return 1;
	}
	return 0;
}

/* The place in the target's clauses of the one whose only anchor is called by a word; or -1. */
static int clause_by(const struct parse *p, int word)
{
	const struct parse_list *clauses = &p->phrases[0].clauses;

	for (int k = 0; k < clauses->n; k++) {
		const struct parse_clause *c = &p->clauses[clauses->item[k]];
		const int a = c->anchors.n == 1 && !c->negated && c->degree == PARSE_PLAIN
				      ? c->anchors.item[0]
				      : -1;
		if (a > 0 && !strcmp(head_of(p, a), p->words[word].lemma) &&
			p->phrases[a].span.end <= p->words[word].span.begin &&
			!is_placed(p, p->phrases[a].span.end, p->words[word].span.begin))
			return k;
	}
	return -1;
}

/* The anchor of the target's k-th clause becomes the target. */
static int turn(struct parse *p, int k, struct err *e)
{
	struct parse_list *clauses = &p->phrases[0].clauses;
	const int clause = clauses->item[k];
	struct parse_clause *c = &p->clauses[clause];
	const int a = c->anchors.item[0];

	for (int i = k + 1; i < clauses->n; i++)
		clauses->item[i - 1] = clauses->item[i];
	clauses->n--;
	const struct parse_phrase told = p->phrases[0];
	p->phrases[0] = p->phrases[a];
	p->phrases[a] = told;
	p->phrases[0].count = PARSE_ONE;
	c->relation = closed_inverse(c->relation);
	return parse_list_add(&p->phrases[0].clauses, clause, e);
}

int parse_that(struct parse *p, struct err *e)
{
	static const char *const that[] = {"that", NULL};

	for (int i = 0; i < p->unexplained.n && !p->phrases[0].also.n; i++) {
		const int word = p->unexplained.item[i];
		const int k =
			parse_word_is(p, word - 1, that) && strcmp(head_of(p, 0), p->words[word].lemma) != 0
				? clause_by(p, word)
				: -1;
		if (k >= 0) {
			for (int j = i + 1; j < p->unexplained.n; j++)
				p->unexplained.item[j - 1] = p->unexplained.item[j];
			p->unexplained.n--;
			return turn(p, k, e);
		}
	}
	return 0;
}
