/* Why nothing is meant. */
#include "ask/refusal.h"

#include "base/largest.h"
#include "lang/motion_said.h"

#include <math.h>
#include <stdlib.h>

/* The words of a part of the sentence. */
void explain_add_part(struct parse_words *w, const struct explained *x, const struct meaning_part *part)
{
	const char *text = x->text;
	const struct parse *p = x->parse;

	switch (part->kind) {
	case MEANING_NOUN:
		if (p->phrases[part->phrase].noun.n)
			parse_words_noun(w, p, part->phrase);
		else /* of "the other one": what was spoken of before */
			parse_words_add(w, p->words[part->index].text);
		break;
	case MEANING_ATTRIBUTE:
	case MEANING_COLOUR:
	case MEANING_SURFACE:
		parse_words_add(w, p->words[part->index].text);
		break;
	case MEANING_CLAUSE:
	case MEANING_SIZE:
		parse_words_clause(w, p, text, &p->clauses[part->index]);
		break;
	case MEANING_MOTION:
		parse_words_add(w, motion_kind_name((enum motion_kind)part->index));
		break;
	case MEANING_EXCEPT:
		parse_words_phrase(w, p, text, part->index);
		break;
	case MEANING_AMONG:
		if (!p->phrases[part->phrase].among.n)
			parse_words_add(w, "of those");
		for (int k = 0; k < p->phrases[part->phrase].among.n; k++) {
			parse_words_add(w, k ? " or " : "");
			parse_words_phrase(w, p, text, p->phrases[part->phrase].among.item[k]);
		}
		break;
	default:
		break;
	}
}

/* The first anchor of a phrase, or of one of its anchors, that is not here; -1: none. */
static int absent_anchor(const struct explained *x, int phrase, int depth)
{
	const struct meaning *m = x->meaning;
	const struct parse *p = x->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = m->arrangement->n;

	for (int k = 0; k < f->clauses.n && depth < 4; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		for (int j = 0; j < c->anchors.n; j++) {
			const int a = c->anchors.item[j];
			const double *there = m->there + (size_t)a * n;
			if (p->phrases[a].viewer || p->phrases[a].scene || c->relation == PARSE_OTHER ||
				c->relation == PARSE_WITH)
				continue;
			if (there[best_of(there, n)] < 0.5)
				return a;
			const int deeper = absent_anchor(x, a, depth + 1);
			if (deeper >= 0)
				return deeper;
		}
	}
	return -1;
}

/* The part of the target that speaks most against an object. */
static const struct meaning_part *worst_part(const struct meaning *m, size_t o)
{
	const struct meaning_part *worst = NULL;

	for (size_t k = 0; k < m->part_count; k++)
		if (!m->parts[k].phrase && (!worst || m->parts[k].value[o] < worst->value[o]))
			worst = &m->parts[k];
	return worst;
}

/* A part as the sentence says it: a clause with its anchors, where they follow it. */
static void add_said(struct parse_words *w, const struct explained *x, const struct meaning_part *part)
{
	const char *text = x->text;
	const struct parse *p = x->parse;
	const int is_clause = part->kind == MEANING_CLAUSE || part->kind == MEANING_SIZE;
	const struct parse_clause *c = is_clause ? &p->clauses[part->index] : NULL;
	int end = c ? c->span.end : 0;

	for (int k = 0; c && k < c->anchors.n; k++)
		if (p->phrases[c->anchors.item[k]].span.end > end)
			end = p->phrases[c->anchors.item[k]].span.end;
	if (c && c->span.begin < c->span.end)
		parse_words_bytes(w, text + c->span.begin, (size_t)(end - c->span.begin));
	else
		explain_add_part(w, x, part);
}

void explain_refusal(const struct explained *x, char reason[EXPLAIN_REASON])
{
	const struct meaning *m = x->meaning;
	const char *text = x->text;
	const struct parse *p = x->parse;
	const int anchor = absent_anchor(x, 0, 0);
	const size_t best = best_of(m->fit, m->arrangement->n);
	const struct meaning_part *worst = worst_part(m, best);
	struct parse_words w = {reason, 0, EXPLAIN_REASON};

	*reason = 0;
	if (p->phrases[0].noun.n && m->known[0] < 0.5) {
		parse_words_add(&w, "nothing here is known as '");
		parse_words_noun(&w, p, 0);
		parse_words_add(&w, "'");
	} else if (anchor >= 0) {
		parse_words_add(&w, "there is no '");
		parse_words_phrase(&w, p, text, anchor);
		parse_words_add(&w, "' here to go by");
	} else if (worst && worst->value[best] < 0.5 && worst->kind != MEANING_ORDINAL) {
		parse_words_add(&w, m->vocabulary->lifted->names[best]);
		parse_words_add(&w, " comes nearest, but '");
		add_said(&w, x, worst);
		parse_words_add(&w, worst->kind == MEANING_EXCEPT ? "' leaves it out" : "' does not fit it");
	} else if (meaning_is_empty(m, 0)) {
		parse_words_add(&w, "it does not say which thing is meant");
	} else {
		parse_words_add(&w, m->vocabulary->lifted->names[best]);
		parse_words_add(&w, " comes nearest, but not near enough");
	}
}
