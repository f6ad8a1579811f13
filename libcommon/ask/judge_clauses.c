/* Clauses: how what a phrase means stands to its anchors, and in which order of all that fits. */
#include "ask/constants.h"
#include "ask/judge_clauses.h"
#include "ask/judge_words.h"
#include "lang/compared.h"
#include "lang/finish.h"
#include "places/relate.h"

#include <math.h>
#include <string.h>

enum { ANCHORS = 16 }; /* more anchors of a clause are not looked at */

/* Whether a clause compares looks: "darkest", "shinier than the kettle". */
static int compares_looks(const struct parse *p, const struct parse_clause *c)
{
	char base[COMPARED_LENGTH];
	const char *word = c->words.n == 1 ? p->words[c->words.item[0]].text : "";

	return c->relation == PARSE_OTHER && c->degree != PARSE_PLAIN &&
	       (compared_of(word, base) != PARSE_PLAIN || compared_look(word) != COMPARED_NONE);
}

/* How much an object looks as a word says, in units of what is told apart; 0 where looks do not count. */
static double look_of(
	const struct meaning *m, const struct arranged *o, enum compared_look look, const char *base)
{
	if (look == COMPARED_FINISH ? !m->has_surfaces : m->without >> MEANING_COLOUR & 1)
		return 0;
	switch (look) {
	case COMPARED_DARK:
		return -o->lab[0] / COMPARED_LIGHTNESS;
	case COMPARED_BRIGHT:
		return o->lab[0] / COMPARED_LIGHTNESS;
	case COMPARED_COLOURFUL:
		return hypot(o->lab[1], o->lab[2]) / COMPARED_LIGHTNESS;
	case COMPARED_FINISH:
		return surface_fits(&o->surface, finish_of(base)) / COMPARED_SHARE;
	default:
		return 0;
	}
}

/* key (O): the less, the more an object looks so; what sentences say of it where that cannot be seen. */
static void find_keys(struct meaning *m, int word, double *key)
{
	char base[COMPARED_LENGTH];
	const char *text = m->sentence->parse->words[word].text;
	const char *adjective = compared_of(text, base) == PARSE_PLAIN ? text : base;
	const enum compared_look look = compared_look(adjective);

	if (look == COMPARED_COLOUR)
		vocabulary_colour(m->vocabulary, m->arrangement, adjective, key);
	else if (look == COMPARED_NONE || look == COMPARED_FINISH)
		vocabulary_attribute(m->vocabulary, m->sentence, word, key);
	else
		memset(key, 0, objects_of(m) * sizeof *key);
	m->unknown += look == COMPARED_NONE && largest(key, objects_of(m)) < 0.5;
	for (size_t o = 0; o < objects_of(m); o++)
		key[o] = -key[o] / COMPARED_SHARE - look_of(m, &m->arrangement->objects[o], look, adjective);
}

/* value (O) of such a clause among those that fit, the place-th of them. */
static void judge_compared(
	struct meaning *m, const struct parse_clause *c, int place, const double *fit, double *value)
{
	const size_t n = objects_of(m);
	const int anchor = c->anchors.n && m->known[c->anchors.item[0]] >= 0.5 ? c->anchors.item[0] : -1;
	const double *than = anchor < 0 || c->degree == PARSE_MOST ? NULL : fit_of(m, anchor);
	double *key = m->scratch + 3 * n;

	find_keys(m, c->words.item[0], key);
	if (!than || meaning_is_other(m->sentence->parse, &m->sentence->parse->phrases[anchor])) {
		relate_rank_by(m->arrangement, key, place, fit, value);
		return;
	}
	const size_t best = best_of(than, n);
	for (size_t o = 0; o < n; o++)
		value[o] = o == best ? 0 : 1 / (1 + exp(fmin(key[o] - key[best] + 1, 40)));
}

/* When a clause is judged: what compares with all else that fits has to wait for it. */
enum turn { AT_ONCE, BY_PLACE, BY_DEGREE };

static enum turn turn_of(const struct parse_clause *c)
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

static enum relate_width width_of(const struct parse *p, const struct parse_phrase *f, enum parse_relation r)
{
	int directions = 0;

	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		directions += c->relation <= PARSE_BEHIND && !c->negated ? c->anchors.n : 0;
	}
	if (f->count != PARSE_ONE)
		return r == PARSE_FRONT || r == PARSE_BEHIND ? RELATE_CONE : RELATE_HALF_PLANE;
	return directions > 1 ? RELATE_WIDE : RELATE_NARROW;
}

/* How known the best known of a clause's anchors is. */
static double known_of(const struct meaning *m, const struct parse_clause *c)
{
	double most = 0;

	for (int k = 0; k < c->anchors.n; k++)
		most = fmax(most, m->known[c->anchors.item[k]]);
	return most;
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
	struct relation r = {c->relation, c->degree, width_of(p, f, c->relation), 0, 0, anchors};
	double known = 1;
	int is_under = 0;

	if (counted_by(p, f, counts_along) == c)
		r.place = f->ordinal;
	if (!c->anchors.n && is_of_anything(c)) {
		for (size_t o = 0; o <= objects_of(m); o++)
			m->scratch[o] = o < objects_of(m);
		anchors[r.count++] = (struct relate_anchor){.p = m->scratch};
	}
	for (int k = 0; k < c->anchors.n && r.count < ANCHORS; k++) {
		const int i = c->anchors.item[k];
		if (c->relation == PARSE_BETWEEN && m->known[i] < 0.5 && known_of(m, c) >= 0.5)
			continue; /* near the other one */
		const int is_many = p->phrases[i].count != PARSE_ONE &&
				    (r.degree != PARSE_PLAIN || !(one_will_do >> c->relation & 1));
		anchors[r.count] = (struct relate_anchor){fit_of(m, i), meaning_is_scene(m, i),
			is_many && !c->negated, meaning_is_other(p, &p->phrases[i])};
		if (!p->phrases[i].viewer && !anchors[r.count].is_scene)
			known = fmin(known,
				fmin(m->known[i], largest(there_of(m, i), objects_of(m)) / GENERIC_THERE));
		is_under |= anchors[r.count].is_scene && c->relation == PARSE_BELOW &&
			    meaning_has_word(p, &p->phrases[i], "table|tabletop|desk|desktop|floor|ground");
		r.count++;
	}
	relate(m->arrangement, &r, fit, m->scratch + 3 * objects_of(m), value);
	for (size_t o = 0; o < objects_of(m) && is_under; o++)
		value[o] = 0; /* nothing is below what all stands on */
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

/* How far an object is itself an anchor of a clause: "not beside the mug" is not said of the mug. */
static double is_anchor(const struct meaning *m, const struct parse_clause *c, size_t o)
{
	double is = 0;

	for (int j = 0; j < c->anchors.n; j++) {
		const int i = c->anchors.item[j];
		const double *fit = fit_of(m, i);
		if (!meaning_is_scene(m, i) &&
			!meaning_is_other(m->sentence->parse, &m->sentence->parse->phrases[i]))
			is = fmax(is, m->known[i] * fit[o] / fmax(largest(fit, objects_of(m)), 1e-9));
	}
	return is;
}

/* The same by where the anchor is, which is no object. */
static void add_elsewhere(struct meaning *m, int anchor, const double *fit, double *elsewhere)
{
	const struct parse_list *clauses = &m->sentence->parse->phrases[anchor].clauses;
	double *value = m->scratch + 6 * objects_of(m);

	for (int k = 0; k < clauses->n; k++) {
		const struct parse_clause *c = &m->sentence->parse->clauses[clauses->item[k]];
		if (c->negated || !c->anchors.n || c->relation >= PARSE_WITH)
			continue;
		const double known = judge_relation(m, anchor, c, fit, value);
		for (size_t o = 0; o < objects_of(m); o++)
			elsewhere[o] = fmax(elsewhere[o], ELSEWHERE_WORTH * known * (1 - value[o]));
	}
}

/* elsewhere (O): how far an object cannot be where a clause says, though the anchor is nothing here: it is an
 * anchor itself, or on the desk, and not on the sofa, or not beside what the anchor is beside. */
static void find_elsewhere(
	struct meaning *m, const struct parse_clause *c, const double *fit, double *elsewhere)
{
	const size_t n = objects_of(m);
	const struct relate_anchor furniture = {.p = m->scratch};
	const struct relation on = {PARSE_ON, PARSE_PLAIN, RELATE_NARROW, 0, 1, &furniture};

	memset(elsewhere, 0, n * sizeof *elsewhere);
	for (size_t o = 0; o <= n; o++)
		m->scratch[o] = o < n && c->relation == PARSE_ON && vocabulary_is_furniture(m->vocabulary, o);
	if (largest(m->scratch, n) > 0)
		relate(m->arrangement, &on, fit, m->scratch + 3 * n, elsewhere);
	for (size_t o = 0; o < n; o++)
		elsewhere[o] = fmax(ELSEWHERE_WORTH * elsewhere[o], is_anchor(m, c, o));
	for (int k = 0; k < c->anchors.n; k++)
		if (m->known[c->anchors.item[k]] < 0.5)
			add_elsewhere(m, c->anchors.item[k], fit, elsewhere);
}

/* value (O): how far a clause holds, before what is negated is turned round. said (O) is scratch. */
static void judge_predication(struct meaning *m, int phrase, const struct parse_clause *c, const double *fit,
	double *said, double *value)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);

	if (compares_looks(p, c)) {
		judge_compared(m, c, counted_by(p, f, counts_along) == c ? f->ordinal : 1, fit, value);
		return;
	}
	if (judge_by_place(m, c, counted_by(p, f, counts_along) == c ? f->ordinal : 1, fit, value))
		return;
	if (c->relation == PARSE_OTHER) {
		judge_predicate(m, c, value);
		return;
	}
	const double known = judge_relation(m, phrase, c, fit, value);
	/* what carries or holds something that is nothing here has it: "the one with its screen on" */
	if (c->relation == PARSE_WITH || (c->relation == PARSE_SUPPORTS && c->anchors.n && known < 0.5)) {
		judge_predicate(m, c, said);
		for (size_t o = 0; o < n; o++)
			value[o] = fmax(said[o], known * value[o]);
		judge_part_colours(m, phrase, c, value);
		return;
	}
	const int head = meaning_head_of(p, f);
	/* roses in a vase may be what is called a vase here */
	for (size_t o = 0; o < n && head >= 0 && c->relation == PARSE_INSIDE; o++)
		value[o] = fmax(value[o], OWN_HOLDER * is_anchor(m, c, o));
	judge_said(m, c, said);
	/* nothing is beside what is not here: a denial of it is true, and of "all that is on the sill"
	 * nothing is known */
	const int is_all = f->count != PARSE_ONE && head < 0;
	const double unknown = c->negated || is_all
				       ? 0
				       : UNKNOWN_RELATION * (1 - (f->count == PARSE_ONE) * UNSAID_RELATION *
									    largest(said, n));
	double *elsewhere = m->scratch + 8 * n;
	find_elsewhere(m, c, fit, elsewhere);
	for (size_t o = 0; o < n; o++)
		value[o] = fmax(known * value[o] + (1 - known) * unknown * (1 - elsewhere[o]),
			(1 - known) * SAID_WORTH * said[o]);
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
	const int is_denied = c->negated && m->sentence->parse->phrases[phrase].count == PARSE_ONE;
	const double soft = is_denied ? DENIED_THERE : is_plain_fact(c) ? CONTACT_THERE : RELATION_THERE;

	judge_predication(m, phrase, c, fit, m->scratch + 7 * n, value);
	for (size_t o = 0; o < n; o++) {
		const double x = c->negated ? (1 - value[o]) * (1 - is_anchor(m, c, o)) : value[o];
		value[o] = least + (1 - least) * x;
		there[o] *= is_size(c) ? 1 : value[o] / (value[o] + soft) * (1 + soft);
	}
	meaning_take_part(m);
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
	meaning_take_part(m);
}

/* "around", and nothing is there that it is around. */
static int says_nothing(const struct parse_clause *c)
{
	return c->relation == PARSE_NEAR && c->degree == PARSE_PLAIN && !c->anchors.n && !c->negated;
}

/* The clauses of a turn. fit: what is compared. */
static void judge_turn(struct meaning *m, int phrase, const double *fit, enum turn turn)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];

	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if (turn_of(c) == turn && !says_nothing(c) && c != counted_by(p, f, names_end))
			judge_clause(m, phrase, f->clauses.item[k], fit);
	}
}

void judge_clauses(struct meaning *m, int phrase)
{
	judge_turn(m, phrase, fit_of(m, phrase), AT_ONCE);
}

void judge_order(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	const double *fit = fit_of(m, phrase);
	double *before = m->scratch + 2 * n;

	for (size_t o = 0; o < n; o++)
		before[o] = fit[o] * fit[o] * m->arrangement->objects[o].in_sight;
	judge_turn(m, phrase, before, BY_PLACE);
	/* what fits half as well is hardly one of them: "the littlest grey thing" */
	for (size_t o = 0; o < n; o++)
		before[o] *= sqrt(before[o]);
	judge_turn(m, phrase, before, BY_DEGREE);
	if (f->ordinal)
		judge_ordinal(m, phrase, before);
}
