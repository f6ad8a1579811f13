/* Clauses: how what a phrase means stands to its anchors, and in which order of all that fits. */
#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "places/relate.h"
#include "places/resting.h"
#include "lang/colours.h"

#include <math.h>
#include <string.h>

enum { ANCHORS = 16 }; /* more anchors of a clause are not looked at */

/* "On the near side of" is before, and "on the far side of" or "on the other side of" behind. */
static enum parse_relation relation_of(const struct parse *p, const struct parse_clause *c)
{
	static const char *const side[] = {"side", NULL}, *const near[] = {"near", "nearer", "front", NULL},
				 *const far[] = {
					 "far", "farther", "further", "other", "opposite", "back", NULL};
	const int is_distance =
		c->relation == PARSE_NEAR || c->relation == PARSE_FAR || c->relation == PARSE_ACROSS;

	for (int w = 1; is_distance && c->anchors.n && w < p->word_count; w++) {
		const struct parse_word *word = &p->words[w];
		if (!meaning_word_is(word, side) || word->span.end < c->span.begin ||
			word[-1].span.begin > c->span.end)
			continue;
		if (meaning_word_is(&word[-1], near))
			return PARSE_FRONT;
		if (meaning_word_is(&word[-1], far))
			return PARSE_BEHIND;
	}
	return c->relation;
}

/* There is no more or less of some relations: "on top of". */
static enum parse_degree degree_of(const struct parse_clause *c)
{
	const unsigned plain = 1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_SUPPORTS |
			       1U << PARSE_BETWEEN | 1U << PARSE_WITH;

	return plain >> c->relation & 1 ? PARSE_PLAIN : c->degree;
}

static enum meaning_turn turn_of(const struct parse_clause *c)
{
	const int is_place = c->relation != PARSE_OTHER && c->relation != PARSE_WITH;

	if (degree_of(c) != PARSE_PLAIN)
		return BY_DEGREE;
	return (is_place && !c->anchors.n) || c->relation == PARSE_MIDDLE ? BY_PLACE : AT_ONCE;
}

/* Whether an ordinal counts along a clause: "the second tallest"; or from its anchor: "the first one left of
 * the lamp"; or from the end that it names: "the second on the right". */
static int counts_along(const struct parse_clause *c)
{
	return degree_of(c) == PARSE_MOST;
}

static int counts_away_from(const struct parse_clause *c)
{
	return c->anchors.n == 1 && (c->relation <= PARSE_BEHIND || c->relation == PARSE_NEAR);
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

static enum relate_width width_of(
	const struct parse *p, const struct parse_phrase *f, const struct parse_clause *said)
{
	static const char *const half[] = {"half", NULL};
	int directions = 0;

	if (said->words.n && parse_word_is(p, said->words.item[0] + 1, half))
		return RELATE_HALF_PLANE; /* "in the left half": not the leftmost one */
	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		directions += c->relation <= PARSE_BEHIND && !c->negated ? c->anchors.n : 0;
	}
	return f->count != PARSE_ONE ? RELATE_HALF_PLANE : directions > 1 ? RELATE_WIDE : RELATE_NARROW;
}

/* "something" beside the thing itself: "that carries something", but not "something to put flowers in". */
static int speaks_of_something(const struct parse *p)
{
	static const char *const some[] = {"something", "anything", "things", "stuff", NULL};

	for (int w = 0; w < p->word_count; w++)
		if (meaning_word_is(&p->words[w], some) &&
			(p->words[w].span.end <= p->phrases[0].span.begin ||
				p->words[w].span.begin >= p->phrases[0].span.end))
			return 1;
	return 0;
}

/* "with nothing on it", "by itself". */
static int is_of_anything(const struct parse_clause *c)
{
	return c->relation == PARSE_SUPPORTS || c->relation == PARSE_INSIDE ||
	       (c->relation == PARSE_NEAR && c->negated && c->degree == PARSE_PLAIN);
}

/* "the two leftmost": the second as well as the first. */
static void rank_more(
	struct meaning *m, const struct relation *first, int count, const double *fit, double *value)
{
	const size_t n = objects_of(m);
	struct relation r = *first;
	double *next = m->scratch + 6 * n;

	for (r.place = 2; r.place <= count && !first->place; r.place++) {
		relate(m->arrangement, &r, fit, m->scratch + 3 * n, next);
		for (size_t o = 0; o < n; o++)
			value[o] = fmax(value[o], next[o]);
	}
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
	struct relation r = {relation_of(p, c), degree_of(c), width_of(p, f, c), 0, 0, anchors};
	double known = 1;

	if (c->negated && is_size(c) && c->anchors.n) /* what is not as large is not larger */
		r.degree = PARSE_MORE;
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
		/* "the one near us": of all that is there */
		const int is_of_all =
			meaning_is_scene(m, i) ||
			(p->phrases[i].viewer && c->relation == PARSE_NEAR && r.degree == PARSE_PLAIN);
		anchors[r.count] = (struct relate_anchor){
			fit_of(m, i), is_of_all, is_many && !c->negated, meaning_is_other(p, &p->phrases[i])};
		if (!p->phrases[i].viewer && !anchors[r.count].is_scene)
			known = fmin(known,
				fmin(m->known[i], largest(there_of(m, i), objects_of(m)) / GENERIC_THERE));
		r.count++;
	}
	relate(m->arrangement, &r, fit, m->scratch + 3 * objects_of(m), value);
	if (r.degree == PARSE_MOST)
		rank_more(m, &r, f->count, fit, value);
	return known;
}

/* "in tangerine", where nothing is called so. */
static int is_of_colour(const struct meaning *m, const struct parse_clause *c)
{
	const struct parse *p = m->sentence->parse;
	const int a = c->relation == PARSE_INSIDE && c->anchors.n == 1 ? c->anchors.item[0] : -1;
	const struct parse_list *noun = a >= 0 ? &p->phrases[a].noun : NULL;

	return noun && noun->n && m->known[a] <= GENERIC_THERE &&
	       colour_word(p->words[noun->item[noun->n - 1]].lemma) >= 0;
}

/* out (O): how true a clause is whose anchor is no object here. */
static void relate_unnamed(const struct meaning *m, const struct parse_clause *c, double *out)
{
	const struct parse *p = m->sentence->parse;
	const int may_be = c->anchors.n && (c->relation == PARSE_ON || c->relation == PARSE_BELOW);
	const int head = may_be ? meaning_head_of(p, &p->phrases[c->anchors.item[0]]) : -1;
	const int is_held = head >= 0 && resting_holds(p->words[head].lemma);

	resting_relate(m->arrangement, is_held ? c->relation : PARSE_OTHER, out);
}

/* value (O): how far a clause holds, before what is negated is turned round. said (O) is scratch. */
static void judge_predication(struct meaning *m, int phrase, const struct parse_clause *c, const double *fit,
	double *said, double *value)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	double *unnamed = m->scratch;

	if (meaning_compares_looks(p, c)) {
		meaning_judge_compared(
			m, c, counted_by(p, f, counts_along) == c ? f->ordinal : 1, fit, value);
		return;
	}
	if (c->relation == PARSE_OTHER || is_of_colour(m, c)) {
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
	if (known < 1)
		relate_unnamed(m, c, unnamed);
	else
		memset(unnamed, 0, n * sizeof *unnamed);
	meaning_judge_said(m, c, said);
	for (size_t o = 0; o < n; o++)
		value[o] =
			fmax(known * value[o] + (1 - known) * unnamed[o], (1 - known) * SAID_WORTH * said[o]);
}

/* "no other bowl", or no bowl of a bowl: another one than the thing itself. */
static int is_another(const struct parse *p, int phrase, int anchor)
{
	const struct parse_phrase *f = &p->phrases[phrase], *a = &p->phrases[anchor];

	return meaning_is_other(p, a) || (f->noun.n && a->noun.n && a->count != PARSE_ALL &&
						 !strcmp(p->words[f->noun.item[f->noun.n - 1]].lemma,
							 p->words[a->noun.item[a->noun.n - 1]].lemma));
}

/* How far an object is itself an anchor of a clause: "not beside the mug" is not said of the mug. */
static double is_anchor(const struct meaning *m, int phrase, const struct parse_clause *c, size_t o)
{
	double is = 0;

	for (int j = 0; j < c->anchors.n; j++) {
		const int i = c->anchors.item[j];
		const double *fit = fit_of(m, i);
		if (!meaning_is_scene(m, i) && !is_another(m->sentence->parse, phrase, i))
			is = fmax(is, m->known[i] * fit[o] / fmax(largest(fit, objects_of(m)), 1e-9));
	}
	return is;
}

/* Whether a clause is so or not: of two things that touch, or that are compared. */
static int is_plain_fact(const struct parse_clause *c)
{
	const unsigned contact =
		1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_SUPPORTS | 1U << PARSE_BELOW;

	return c->anchors.n && !c->negated && (contact >> c->relation & 1 || degree_of(c) == PARSE_MORE);
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
		const double x = c->negated ? (1 - value[o]) * (1 - is_anchor(m, phrase, c, o)) : value[o];
		value[o] = least + (1 - least) * x;
		there[o] *= is_size(c) ? 1 : value[o] / (value[o] + soft) * (1 + soft);
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

static void rank_away_from(struct meaning *m, const struct parse_clause *c, const double *fit, double *value)
{
	const struct parse *p = m->sentence->parse;
	const int i = c->anchors.item[0];
	const struct relate_anchor anchor = {fit_of(m, i), meaning_is_scene(m, i), 0, 0};
	const struct relation r = {PARSE_NEAR, PARSE_MOST, 0,
		p->phrases[m->parts[m->part_count - 1].phrase].ordinal, 1, &anchor};

	relate(m->arrangement, &r, fit, m->scratch + 3 * objects_of(m), value);
}

static void judge_ordinal(struct meaning *m, int phrase, const double *fit)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const struct parse_clause *from = counted_by(p, f, counts_away_from),
				  *end = counted_by(p, f, names_end);
	const size_t n = objects_of(m);

	if (counted_by(p, f, counts_along)) /* judge_relation has counted */
		return;
	double *value = meaning_add_part(m, phrase, MEANING_ORDINAL, -1);
	if (from && f->ordinal > 0)
		rank_away_from(m, from, fit, value);
	else /* "the last on the right" is the rightmost */
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
static int says_nothing(const struct parse *p, const struct parse_clause *c)
{
	const int may_be =
		c->relation == PARSE_NEAR || (c->relation == PARSE_SUPPORTS && !speaks_of_something(p));

	return may_be && c->degree == PARSE_PLAIN && !c->anchors.n && !c->negated;
}

/* The clauses that compare, or those that do not. Those of the place as a whole are the thing's: "everything
 * on the shelf that is left of the lamp". */
void meaning_judge_clauses(struct meaning *m, int phrase, const struct parse_phrase *f, const double *fit,
	enum meaning_turn turn, int depth)
{
	const struct parse *p = m->sentence->parse;

	for (int k = 0; k < f->clauses.n && depth < 2; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		const int is_mutual = !phrase && !c->anchors.n && meaning_is_mutual(p) &&
				      (c->relation == PARSE_NEAR || c->relation == PARSE_FAR);
		if (turn_of(c) == turn && !says_nothing(p, c) && !is_mutual &&
			c != counted_by(p, f, names_end))
			judge_clause(m, phrase, f->clauses.item[k], fit);
		for (int j = 0; j < c->anchors.n; j++)
			if (meaning_is_scene(m, c->anchors.item[j]))
				meaning_judge_clauses(
					m, phrase, &p->phrases[c->anchors.item[j]], fit, turn, depth + 1);
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
	meaning_judge_clauses(m, phrase, f, before, BY_PLACE, 0);
	/* what fits half as well is hardly one of them: "the littlest grey thing" */
	for (size_t o = 0; o < n; o++)
		before[o] *= sqrt(before[o]);
	meaning_judge_clauses(m, phrase, f, before, BY_DEGREE, 0);
	if (f->ordinal)
		judge_ordinal(m, phrase, before);
}
