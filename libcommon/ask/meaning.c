#include "ask/meaning.h"

#include "ask/judge_motion.h"
#include "base/list.h"
#include "base/mem.h"
#include "lang/closed.h"

#include <math.h>

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

void meaning_take_part(struct meaning *m)
{
	const struct meaning_part *p = &m->parts[m->part_count - 1];
	double *fit = fit_of(m, p->phrase);

	if (m->without >> p->kind & 1)
		return;
	const int names = p->kind == MEANING_NOUN || p->kind == MEANING_ATTRIBUTE;
	const double power = p->phrase && m->naming == 0 ? 1 : m->naming;
	for (size_t o = 0; o < objects_of(m); o++)
		fit[o] *= names && power != 1 ? pow(p->value[o], power) : p->value[o];
}

static size_t parts_of(const struct meaning *m, const struct parse *p)
{
	size_t n = m->motion ? (size_t)m->motion->said.n + 1 : 0;

	for (int i = 0; i < p->phrase_count; i++) {
		const struct parse_phrase *f = &p->phrases[i];
		n += 4 + (size_t)(f->noun.n + f->attributes.n + 3 * f->clauses.n + f->except.n);
	}
	return n;
}

static int make_room(struct meaning *m, const struct parse *p, struct err *e)
{
	const size_t n = objects_of(m), phrases = (size_t)p->phrase_count, parts = parts_of(m, p);

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

int meaning_begin(struct meaning *m, const struct vocabulary_sentence *s, struct err *e)
{
	if (make_room(m, s->parse, e))
		return -1;
	m->sentence = s;
	m->phrases = (size_t)s->parse->phrase_count;
	m->part_count = 0;
	m->unknown = (size_t)s->parse->unexplained.n;
	memset(m->done, 0, m->phrases);
	return 0;
}

int meaning_is_empty(const struct meaning *m, int phrase)
{
	for (size_t k = 0; k < m->part_count; k++)
		if (m->parts[k].phrase == phrase)
			return 0;
	return 1;
}

int meaning_word_is(const struct parse_word *w, const char *words)
{
	return list_has(words, w->text) || list_has(words, w->lemma);
}

int meaning_head_of(const struct parse *p, const struct parse_phrase *f)
{
	static const char generic[] =
		"thing|object|item|one|something|anything|everything|stuff|what|whatever|which|who|"
		"whoever|thingy|other|another|piece";
	const int head = f->noun.n ? f->noun.item[f->noun.n - 1] : -1;

	return head >= 0 && (meaning_word_is(&p->words[head], generic) ||
				    closed_is(p->words[head].text, CLOSED_BE))
		       ? -1
		       : head;
}

int meaning_has_word(const struct parse *p, const struct parse_phrase *f, const char *words)
{
	for (int w = 0; w < p->word_count; w++)
		if (p->words[w].span.begin >= f->span.begin && p->words[w].span.end <= f->span.end &&
			meaning_word_is(&p->words[w], words))
			return 1;
	return 0;
}

int meaning_is_other(const struct parse *p, const struct parse_phrase *f)
{
	return meaning_has_word(p, f, "other|others|else|rest|remaining");
}

int meaning_is_scene(const struct meaning *m, int phrase)
{
	static const char places[] =
		"table|tabletop|desk|desktop|countertop|picture|photo|image|scene|room|shot|frame|view|"
		"floor|ground|surface";
	const struct parse *p = m->sentence->parse;
	const int head = meaning_head_of(p, &p->phrases[phrase]);

	/* of the "table top" the table tells */
	const int is_top = head > 0 && meaning_word_is(&p->words[head], "top|surface");
	return p->phrases[phrase].scene ||
	       (head >= 0 && m->known[phrase] < 0.5 &&
		       (meaning_word_is(&p->words[head], places) ||
			       (is_top && meaning_word_is(&p->words[head - 1], places))));
}
