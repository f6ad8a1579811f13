#include "ask/judge.h"

#include "ask/constants.h"
#include "ask/judge_clauses.h"
#include "ask/judge_motion.h"
#include "ask/judge_words.h"

#include <math.h>
#include <string.h>

enum { DEPTH = 16 }; /* deeper nesting is not looked at */

/* How far it is known which thing a phrase means that is left out: half, where it is told by its relation to
 * what is nothing here. */
static double known_except(const struct meaning *m, int except)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_list *clauses = &p->phrases[except].clauses;
	double known = fmin(m->known[except], largest(there_of(m, except), objects_of(m)) / GENERIC_THERE);

	for (int k = 0; k < clauses->n; k++) {
		const struct parse_clause *c = &p->clauses[clauses->item[k]];
		for (int j = 0; j < c->anchors.n; j++)
			if (!meaning_is_scene(m, c->anchors.item[j]))
				known = fmin(known, UNKNOWN_RELATION + (1 - UNKNOWN_RELATION) *
									       m->known[c->anchors.item[j]]);
	}
	return known;
}

/* The phrase's fit takes in a phrase that is left out. */
static void judge_except(struct meaning *m, int phrase, int except)
{
	const size_t n = objects_of(m);
	const double *fit = fit_of(m, except), most = fmax(largest(fit, n), 1e-9);
	const double known = known_except(m, except);
	double *value = meaning_add_part(m, phrase, MEANING_EXCEPT, except), *there = there_of(m, phrase);

	for (size_t o = 0; o < n; o++) {
		value[o] = 1 - (1 - EXCEPT_LEAST) * known * fit[o] / most;
		there[o] *= value[o] / (value[o] + RELATION_THERE) * (1 + RELATION_THERE);
	}
	meaning_take_part(m);
}

/* And that it is one of those that were spoken of: the target, or whatever is called by their noun. */
static void judge_within(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const int head = meaning_head_of(p, &p->phrases[phrase]);
	const size_t n = objects_of(m);

	if (!m->set || (*m->set->noun ? head < 0 || strcmp(p->words[head].lemma, m->set->noun) != 0 : phrase))
		return;
	double *value = meaning_add_part(m, phrase, MEANING_AMONG, -1), *there = there_of(m, phrase);
	for (size_t o = 0; o < n; o++) {
		const int is = o < MEANING_SET && m->set->is[o];
		value[o] = is ? 1 : GROUP_ELSE;
		there[o] *= is;
	}
	meaning_take_part(m);
}

/* And that it is one of several that are named: "of the jar, the tin and the box the tallest". */
static void judge_among(struct meaning *m, int phrase)
{
	const struct parse_list *among = &m->sentence->parse->phrases[phrase].among;
	const size_t n = objects_of(m);

	if (!among->n)
		return;
	double *value = meaning_add_part(m, phrase, MEANING_AMONG, -1), *there = there_of(m, phrase);
	for (size_t o = 0; o < n; o++) {
		double is = 0, is_there = 0;
		for (int k = 0; k < among->n; k++) {
			const int i = among->item[k];
			const double *fit = fit_of(m, i);
			is = fmax(is, m->known[i] * fit[o] / fmax(largest(fit, n), 1e-9));
			is_there = fmax(is_there, there_of(m, i)[o]);
		}
		value[o] = GROUP_ELSE + (1 - GROUP_ELSE) * fmin(is, 1);
		there[o] *= is_there;
	}
	meaning_take_part(m);
}

/* What is no thing here, but a part of one, is where that is: "in front of the screen". */
static void take_whole(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const int head = meaning_head_of(p, &p->phrases[phrase]);
	const size_t n = objects_of(m);
	double *has = m->scratch + n;

	if (head < 0 || m->known[phrase] >= 0.5 || p->phrases[phrase].viewer || meaning_is_scene(m, phrase))
		return;
	vocabulary_has(m->vocabulary, m->sentence, head, PARSE_OTHER, has);
	if (largest(has, n) < 0.5)
		return;
	m->known[phrase] = PART_WORTH * largest(has, n);
	for (size_t o = 0; o < n; o++)
		there_of(m, phrase)[o] = fit_of(m, phrase)[o] =
			m->arrangement->objects[o].is_there ? PART_WORTH * has[o] : 0;
}

static void judge_phrase(struct meaning *m, int phrase, int depth);

/* The phrases that a phrase needs, before it. */
static void judge_below(struct meaning *m, int phrase, int depth)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];

	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		for (int j = 0; j < c->anchors.n; j++) {
			judge_phrase(m, c->anchors.item[j], depth + 1);
			if (c->relation < PARSE_SUPPORTS)
				take_whole(m, c->anchors.item[j]);
		}
	}
	for (int k = 0; k < f->except.n; k++)
		judge_phrase(m, f->except.item[k], depth + 1);
	for (int k = 0; m->motion && k < m->motion->said.n; k++)
		if (m->motion->said.events[k].phrase == phrase && m->motion->said.events[k].about >= 0)
			judge_phrase(m, m->motion->said.events[k].about, depth + 1);
	for (int k = 0; k < f->among.n; k++)
		judge_phrase(m, f->among.item[k], depth + 1);
}

static void judge_phrase(struct meaning *m, int phrase, int depth)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	double *fit = fit_of(m, phrase);

	if (m->done[phrase])
		return;
	m->done[phrase] = 1;
	for (size_t o = 0; o <= n; o++)
		fit[o] = f->viewer ? o == n : o < n && m->arrangement->objects[o].is_there;
	judge_noun(m, phrase);
	if (f->viewer || depth > DEPTH)
		return;
	judge_within(m, phrase);
	judge_below(m, phrase, depth);
	for (int k = 0; k + 1 < f->noun.n; k++)
		judge_attribute(m, phrase, f->noun.item[k], MODIFIER_LEAST);
	/* of "something electronic" nothing else is told */
	const int is_all_told = f->count != PARSE_ONE && meaning_head_of(p, f) < 0 && f->attributes.n == 1;
	for (int k = 0; k < f->attributes.n; k++)
		judge_attribute(
			m, phrase, f->attributes.item[k], is_all_told ? ATTRIBUTE_SEVERAL : ATTRIBUTE_LEAST);
	judge_clauses(m, phrase);
	judge_motion(m, phrase);
	for (int k = 0; k < f->except.n; k++)
		judge_except(m, phrase, f->except.item[k]);
	judge_among(m, phrase);
	judge_order(m, phrase);
	for (size_t o = 0; o < n; o++)
		fit[o] *= m->arrangement->objects[o].in_sight ? 1 : OUT_OF_SIGHT;
}

int judge_sentence(struct meaning *m, const struct vocabulary_sentence *s, struct err *e)
{
	const struct parse *p = s->parse;

	if (meaning_begin(m, s, e))
		return -1;
	judge_phrase(m, 0, 0);
	for (int k = 0; k < p->phrases[0].also.n; k++)
		judge_phrase(m, p->phrases[0].also.item[k], 0);
	/* what is faced, or where the speaker stands, says nothing of what is meant */
	const size_t unknown = m->unknown;
	if (p->view != PARSE_VIEW_NONE && p->view_phrase > 0)
		judge_phrase(m, p->view_phrase, 0);
	m->unknown = unknown;
	return 0;
}
