#include "ask/meaning.h"

#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = 16 }; /* deeper nesting is not looked at */

void meaning_free(struct meaning *m)
{
	free(m->fit);
	free(m->there);
	free(m->known);
	free(m->done);
	free(m->parts);
	free(m->values);
	free(m->scratch);
	m->fit = m->there = m->known = m->values = m->scratch = NULL;
	m->done = NULL;
	m->parts = NULL;
}

double *meaning_add_part(struct meaning *m, int phrase, enum meaning_kind kind, int index)
{
	double *value = m->values + m->part_count * objects_of(m);

	m->parts[m->part_count++] = (struct meaning_part){phrase, kind, index, value};
	return value;
}

/* The phrase's fit takes in a part's values. */
void meaning_take_part(struct meaning *m, const struct meaning_part *p)
{
	double *fit = fit_of(m, p->phrase);

	if (m->without >> p->kind & 1)
		return;
	const int names = p->kind == MEANING_NOUN || p->kind == MEANING_ATTRIBUTE;
	for (size_t o = 0; o < objects_of(m); o++)
		fit[o] *= names && m->naming != 1 ? pow(p->value[o], m->naming) : p->value[o];
}

static void judge_phrase(struct meaning *m, int phrase, int depth);

/* What is no thing here, but a part of one, is where that is: "in front of the screen". */
static void take_whole(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const int head = meaning_head_of(p, &p->phrases[phrase]);
	const size_t n = objects_of(m);
	double *has = m->scratch + n;

	if (head < 0 || m->known[phrase] >= 0.5 || p->phrases[phrase].viewer || meaning_is_scene(m, phrase))
		return;
	vocabulary_has(m->vocabulary, m->sentence, head, 0, has);
	if (largest(has, n) < 0.5)
		return;
	m->known[phrase] = PART_WORTH * largest(has, n);
	for (size_t o = 0; o < n; o++)
		there_of(m, phrase)[o] = fit_of(m, phrase)[o] =
			m->arrangement->objects[o].is_there ? PART_WORTH * has[o] : 0;
}

/* The phrases that a phrase needs, before it. */
static void judge_below(struct meaning *m, const struct parse_phrase *f, int depth)
{
	const struct parse *p = m->sentence->parse;

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
	meaning_judge_noun(m, phrase);
	if (f->viewer || depth > DEPTH)
		return;
	judge_below(m, f, depth);
	for (int k = 0; k + 1 < f->noun.n; k++)
		meaning_judge_attribute(m, phrase, f->noun.item[k], MODIFIER_LEAST);
	for (int k = 0; k < f->attributes.n; k++)
		meaning_judge_attribute(m, phrase, f->attributes.item[k], ATTRIBUTE_LEAST);
	meaning_judge_clauses(m, phrase, f, fit, AT_ONCE);
	for (int k = 0; k < f->except.n; k++)
		meaning_judge_except(m, phrase, f->except.item[k]);
	meaning_judge_among(m, phrase);
	meaning_judge_order(m, phrase);
	for (size_t o = 0; o < n; o++)
		fit[o] *= m->arrangement->objects[o].in_sight ? 1 : OUT_OF_SIGHT;
}

static size_t parts_of(const struct parse *p)
{
	size_t n = 0;

	for (int i = 0; i < p->phrase_count; i++) {
		const struct parse_phrase *f = &p->phrases[i];
		n += 4 + (size_t)(f->noun.n + f->attributes.n + 3 * f->clauses.n + f->except.n);
	}
	return n;
}

static int make_room(struct meaning *m, const struct parse *p, struct err *e)
{
	const size_t n = objects_of(m), phrases = (size_t)p->phrase_count, parts = parts_of(p);

	if (!m->scratch)
		m->scratch = mem_alloc(n + 1, 9 * sizeof *m->scratch, "choice", e);
	return !m->scratch ||
			       mem_room((void **)&m->fit, &m->fit_room, phrases * (n + 1), sizeof *m->fit,
				       "choice", e) ||
			       mem_room((void **)&m->there, &m->there_room, phrases * n, sizeof *m->there,
				       "choice", e) ||
			       mem_room((void **)&m->known, &m->known_room, phrases, sizeof *m->known,
				       "choice", e) ||
			       mem_room((void **)&m->done, &m->phrase_room, phrases, 1, "choice", e) ||
			       mem_room((void **)&m->parts, &m->part_room, parts, sizeof *m->parts, "choice",
				       e) ||
			       mem_room((void **)&m->values, &m->value_room, parts * n, sizeof *m->values,
				       "choice", e)
		       ? -1
		       : 0;
}

int meaning_judge(struct meaning *m, const struct vocabulary_sentence *s, struct err *e)
{
	const struct parse *p = s->parse;

	if (make_room(m, p, e))
		return -1;
	m->sentence = s;
	m->phrases = (size_t)p->phrase_count;
	m->part_count = 0;
	m->unknown = (size_t)p->unexplained.n;
	memset(m->done, 0, m->phrases);
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

int meaning_is_empty(const struct meaning *m, int phrase)
{
	for (size_t k = 0; k < m->part_count; k++)
		if (m->parts[k].phrase == phrase)
			return 0;
	return 1;
}
