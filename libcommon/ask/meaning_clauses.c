/* Clauses: how what a phrase means stands to its anchors, and in which order of all that fits. */
#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "places/relate.h"

#include <math.h>
#include <string.h>

enum { ANCHORS = 16 }; /* more anchors of a clause are not looked at */

static enum meaning_turn turn_of(const struct parse_clause *c)
{
	const int is_place = c->relation != PARSE_OTHER && c->relation != PARSE_WITH;

	if (c->degree != PARSE_PLAIN)
		return BY_DEGREE;
	return (is_place && !c->anchors.n) || c->relation == PARSE_MIDDLE ? BY_PLACE : AT_ONCE;
}

/* Whether an ordinal counts along a clause: "the second tallest"; or from the end that it names: "the second
 * on the right". */
static int counts_along(const struct parse_clause *c)
{
	return c->degree == PARSE_MOST;
}

static int names_end(const struct parse_clause *c)
{
	return !c->anchors.n && c->relation <= PARSE_BELOW;
}

/* The clause of a phrase for which that is so, where its ordinal counts from no end by itself; or NULL. */
static const struct parse_clause *counted_by(
	const struct parse *p, const struct parse_phrase *f, int (*is_so)(const struct parse_clause *))
{
	for (int k = 0; k < f->clauses.n && f->ordinal && f->from == PARSE_OTHER; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if (!c->negated && is_so(c))
			return c;
	}
	return NULL;
}

/* The place as a whole, unless something is called so. */
int meaning_is_scene(const struct meaning *m, int phrase)
{
	static const char *const places[] = {"table", "tabletop", "desk", "desktop", "countertop", "picture",
		"photo", "image", "scene", "room", "shot", "frame", "view", "floor", "ground", "surface",
		NULL};
	const struct parse *p = m->sentence->parse;
	const int head = meaning_head_of(p, &p->phrases[phrase]);

	return p->phrases[phrase].scene ||
	       (head >= 0 && m->known[phrase] < 0.5 && meaning_word_is(&p->words[head], places));
}

/* "with nothing on it", "by itself". */
static int is_of_anything(const struct parse_clause *c)
{
	return c->relation == PARSE_SUPPORTS || c->relation == PARSE_INSIDE ||
	       (c->relation == PARSE_NEAR && c->negated && c->degree == PARSE_PLAIN);
}

/* "large", or as large as something. */
static int is_size(const struct parse_clause *c)
{
	return c->degree == PARSE_PLAIN && c->relation >= PARSE_LARGER && c->relation <= PARSE_WIDER;
}

/* value (O) of a clause that has places in it; returns how far its anchors are known. */
static double judge_relation(
	struct meaning *m, int phrase, const struct parse_clause *c, const double *fit, double *value)
{
	const unsigned one_will_do = 1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_SUPPORTS |
				     1U << PARSE_NEAR | 1U << PARSE_WITH | 1U << PARSE_BELOW |
				     1U << PARSE_ABOVE;
	const struct parse *p = m->sentence->parse;
	struct relate_anchor anchors[ANCHORS];
	const struct parse_phrase *f = &p->phrases[phrase];
	const enum relate_width width = f->count != PARSE_ONE ? RELATE_HALF_PLANE : RELATE_NARROW;
	struct relation r = {c->relation, c->degree, width, 0, 0, anchors};
	double known = 1;

	if (counted_by(p, f, counts_along) == c)
		r.place = f->ordinal;
	if (!c->anchors.n && is_of_anything(c)) {
		for (size_t o = 0; o <= objects_of(m); o++)
			m->scratch[o] = o < objects_of(m);
		anchors[r.count++] = (struct relate_anchor){.p = m->scratch};
	}
	for (int k = 0; k < c->anchors.n && r.count < ANCHORS; k++) {
		const int i = c->anchors.item[k];
		const int is_many = p->phrases[i].count != PARSE_ONE &&
				    (r.degree != PARSE_PLAIN || !(one_will_do >> c->relation & 1));
		anchors[r.count] = (struct relate_anchor){fit_of(m, i), meaning_is_scene(m, i),
			is_many && !c->negated, meaning_is_other(p, &p->phrases[i])};
		if (!p->phrases[i].viewer && !anchors[r.count].is_scene)
			known = fmin(known,
				fmin(m->known[i], largest(there_of(m, i), objects_of(m)) / GENERIC_THERE));
		r.count++;
	}
	relate(m->arrangement, &r, fit, m->scratch + 3 * objects_of(m), value);
	/* "the two leftmost": the second as well as the first */
	double *next = m->scratch + 6 * objects_of(m);
	const int more = r.degree == PARSE_MOST && !r.place ? f->count : 0;
	for (r.place = 2; r.place <= more; r.place++) {
		relate(m->arrangement, &r, fit, m->scratch + 3 * objects_of(m), next);
		for (size_t o = 0; o < objects_of(m); o++)
			value[o] = fmax(value[o], next[o]);
	}
	return known;
}

/* value (O): how far a clause holds, before what is negated is turned round. said (O) is scratch. */
static void judge_predication(struct meaning *m, int phrase, const struct parse_clause *c, const double *fit,
	double *said, double *value)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);

	if (meaning_compares_looks(p, c)) {
		meaning_judge_compared(
			m, c, counted_by(p, f, counts_along) == c ? f->ordinal : 1, fit, value);
		return;
	}
	if (c->relation == PARSE_OTHER) {
		meaning_judge_predicate(m, c, value);
		return;
	}
	const double known = judge_relation(m, phrase, c, fit, value);
	/* what carries or holds something that is nothing here has it: "the one with its screen on" */
	if (c->relation == PARSE_WITH || (c->relation == PARSE_SUPPORTS && c->anchors.n && known < 0.5)) {
		meaning_judge_predicate(m, c, said);
		for (size_t o = 0; o < n; o++)
			value[o] = fmax(said[o], known * value[o]);
		meaning_judge_part_colours(m, phrase, c, value);
		return;
	}
	meaning_judge_said(m, c, said);
	for (size_t o = 0; o < n; o++)
		value[o] = fmax(known * value[o] + (1 - known) * UNKNOWN_RELATION,
			(1 - known) * SAID_WORTH * said[o]);
}

/* How far an object is itself an anchor of a clause: "not beside the mug" is not said of the mug. */
static double is_anchor(const struct meaning *m, const struct parse_clause *c, size_t o)
{
	double is = 0;

	for (int j = 0; j < c->anchors.n; j++) {
		const int i = c->anchors.item[j];
		const double *fit = fit_of(m, i);
		if (!meaning_is_scene(m, i))
			is = fmax(is, m->known[i] * fit[o] / fmax(largest(fit, objects_of(m)), 1e-9));
	}
	return is;
}

/* Whether a clause is so or not: of two things that touch, or that are compared. */
static int is_plain_fact(const struct parse_clause *c)
{
	const unsigned contact =
		1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_SUPPORTS | 1U << PARSE_BELOW;

	return c->anchors.n && !c->negated && (contact >> c->relation & 1 || c->degree == PARSE_MORE);
}

static void judge_clause(struct meaning *m, int phrase, int clause, const double *fit)
{
	const struct parse_clause *c = &m->sentence->parse->clauses[clause];
	const size_t n = objects_of(m);
	double *value = meaning_add_part(m, phrase, is_size(c) ? MEANING_SIZE : MEANING_CLAUSE, clause);
	double *there = there_of(m, phrase);
	const double least = is_size(c) ? SIZE_LEAST : RELATION_LEAST;
	const double soft = is_plain_fact(c) ? CONTACT_THERE : RELATION_THERE;

	judge_predication(m, phrase, c, fit, m->scratch + 7 * n, value);
	for (size_t o = 0; o < n; o++) {
		const double x = c->negated ? (1 - value[o]) * (1 - is_anchor(m, c, o)) : value[o];
		value[o] = least + (1 - least) * x;
		there[o] *= is_size(c) ? 1 : value[o] / (value[o] + soft) * (1 + soft);
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

static void judge_ordinal(struct meaning *m, int phrase, const double *fit)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const struct parse_clause *end = counted_by(p, f, names_end);
	const size_t n = objects_of(m);

	if (counted_by(p, f, counts_along)) /* judge_relation has counted */
		return;
	double *value = meaning_add_part(m, phrase, MEANING_ORDINAL, -1);
	/* "the last on the right" is the rightmost */
	relate_rank(m->arrangement,
		end			 ? end->relation
		: f->from == PARSE_OTHER ? PARSE_LEFT
					 : f->from,
		end && f->ordinal < 0 ? 1 : f->ordinal, fit, m->scratch + 3 * n, value);
	for (size_t o = 0; o < n; o++) {
		value[o] = RELATION_LEAST + (1 - RELATION_LEAST) * value[o];
		/* "the second penguin" where there is but one */
		there_of(m, phrase)[o] *= value[o] / (value[o] + RELATION_THERE) * (1 + RELATION_THERE);
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

/* "around", and nothing is there that it is around; "in" of "what you boil water in". */
static int says_nothing(const struct parse_clause *c)
{
	const int may_be = c->relation == PARSE_NEAR || c->relation == PARSE_SUPPORTS;

	return may_be && c->degree == PARSE_PLAIN && !c->anchors.n && !c->negated;
}

void meaning_judge_clauses(struct meaning *m, int phrase, const struct parse_phrase *f, const double *fit,
	enum meaning_turn turn)
{
	const struct parse *p = m->sentence->parse;

	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if (turn_of(c) == turn && !says_nothing(c) && c != counted_by(p, f, names_end))
			judge_clause(m, phrase, f->clauses.item[k], fit);
	}
}

/* What orders those that fit so far, each by itself. */
void meaning_judge_order(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	const double *fit = fit_of(m, phrase);
	double *before = m->scratch + 2 * n;

	for (size_t o = 0; o < n; o++)
		before[o] = fit[o] * fit[o] * m->arrangement->objects[o].in_sight;
	meaning_judge_clauses(m, phrase, f, before, BY_PLACE);
	/* what fits half as well is hardly one of them: "the littlest grey thing" */
	for (size_t o = 0; o < n; o++)
		before[o] *= sqrt(before[o]);
	meaning_judge_clauses(m, phrase, f, before, BY_DEGREE);
	if (f->ordinal)
		judge_ordinal(m, phrase, before);
}
