#include "ask/choose.h"

#include "ask/choose_motion.h"
#include "ask/constants.h"
#include "ask/judge.h"
#include "ask/usage.h"
#include "base/largest.h"
#include "base/logistic.h"
#include "base/mem.h"

#include <math.h>

int choose_without(const char *list, unsigned *parts, struct list_name *unknown)
{
	static const char *const names[CHOOSE_PARTS] = {"words", "names", "knowledge", "colours", "surfaces",
		"sizes", "relations", "except", "sentence", "purpose"};

	*parts = CHOOSE_ALL;
	while (list_next(&list, unknown)) {
		int p = 0;
		while (p < CHOOSE_PARTS && !list_name_is(unknown, names[p]))
			p++;
		if (p == CHOOSE_PARTS)
			return -1;
		*parts &= ~(1U << p);
	}
	return 0;
}

/* What all sentences of a call share, and scratch. */
struct chooser {
	const struct choose_scene *scene;
	unsigned parts;
	struct vocabulary vocabulary;
	struct parser parser; /* with the words of the vocabulary known */
	const char **words;
	struct arrangement arrangement;
	struct viewpoint from; /* of the arrangement */
	struct meaning meaning;
	struct motion_meaning motion; /* of a scene that moves */
	double *score, *whole;	      /* (O) */
	double *purpose;	      /* (3 O) scratch */
};

static int has(const struct chooser *c, enum choose_part p)
{
	return c->parts >> p & 1;
}

/* x becomes its softmax. */
static void softmax(double *x, size_t n)
{
	const double most = largest(x, n);
	double sum = 0;

	for (size_t i = 0; i < n; i++)
		sum += x[i] = exp(x[i] - most);
	for (size_t i = 0; i < n; i++)
		x[i] /= sum;
}

static void look_from(struct chooser *c, const struct viewpoint *from)
{
	if (!viewpoint_is_same(&c->from, from))
		arrangement_look(&c->arrangement, from);
	c->from = *from;
}

/* P that what a phrase means is there, where object o fits it best. */
static double presence(const struct chooser *c, const struct parse *p, int phrase, size_t o)
{
	const struct meaning *m = &c->meaning;
	const double own = m->there[(size_t)phrase * m->arrangement->n + o];
	const int is_nothing =
		meaning_is_empty(m, phrase) && p->phrases[phrase].count != PARSE_ALL && m->arrangement->n > 1;
	const double x = PRESENCE_BASE + PRESENCE_OWN * log(fmax(own, 1e-6)) -
			 PRESENCE_UNKNOWN * (double)m->unknown - (is_nothing ? PRESENCE_NOTHING : 0);

	return logistic(x);
}

/* How sure differences of fit make: as is found by likelihood, but plainly where it is in doubt which object
 * has which name. */
static double sharpness(const struct chooser *c)
{
	return c->scene->naming == 1 ? SCORE_WEIGHT : 1;
}

/* One of the phrases of the target: its own objects are added to chosen. Returns P that it means anything. */
static double choose_phrase(struct chooser *c, const struct parse *p, int phrase, double *row, char *chosen)
{
	const size_t n = c->arrangement.n;
	const struct parse_phrase *f = &p->phrases[phrase];
	const double *fit = c->meaning.fit + (size_t)phrase * (n + 1);

	for (size_t o = 0; o < n; o++)
		c->score[o] = log(fmax(fit[o], 1e-12)) +
			      (has(c, CHOOSE_SENTENCE) ? SENTENCE_WEIGHT * c->whole[o] : 0);
	const size_t best = best_of(c->score, n);
	const double top = fit[best], there = presence(c, p, phrase, best);
	if (f->count == PARSE_ONE) {
		for (size_t o = 0; o < n; o++)
			c->score[o] *= sharpness(c);
		softmax(c->score, n);
		chosen[best] = 1;
	} else if (there >= PARSE_LEAST ||
		   !p->phrases[0].also.n) {	     /* of plates and bowls there may be no plates */
		for (int k = 0; k < f->count; k++) { /* "three": the best three */
			size_t next = n;
			for (size_t o = 0; o < n; o++)
				if (!chosen[o] && fit[o] > COUNTED_SHARE * top &&
					(next == n || c->score[o] > c->score[next]))
					next = o;
			if (next < n)
				chosen[next] = 1;
		}
		for (size_t o = 0; o < n; o++) {
			const double odds = fit[o] / (SEVERAL_SHARE * fmax(top, 1e-12));
			c->score[o] = 1 - 1 / (1 + pow(odds, sharpness(c)));
			if (f->count < 0 && c->score[o] >= 0.5)
				chosen[o] = 1;
		}
	}
	for (size_t o = 0; o < n; o++)
		row[o] = fmax(row[o], c->score[o]);
	return there;
}

/* A sentence whose words are not known: by its mean alone. */
static void choose_whole(struct chooser *c, double *row, char *chosen)
{
	const size_t n = c->arrangement.n;

	for (size_t o = 0; o < n; o++)
		row[o] = sharpness(c) * SENTENCE_WEIGHT * c->whole[o];
	softmax(row, n);
	chosen[best_of(row, n)] = 1;
}

/* A sentence that says what a thing is for: the object of which that is most likely; several: and what
 * is nearly as likely; is_all: and what is for the same. */
static void choose_purpose(
	struct chooser *c, int several, int is_all, struct choice *to, double *row, char *chosen)
{
	const size_t n = c->arrangement.n;
	const double there = usage_judge(&c->meaning, c->score, c->purpose);

	if (there <= 0)
		return;
	memcpy(row, c->score, n * sizeof *row);
	softmax(row, n);
	memset(chosen, 0, n);
	const size_t best = best_of(row, n);
	/* all that are for the same, whatever they are called */
	const double *use = c->purpose + n, *parts = use + n;
	for (size_t o = 0; o < n; o++) {
		const double less = fabs(PURPOSE_USE * (use[best] - use[o])) + fabs(parts[best] - parts[o]);
		chosen[o] =
			o == best || (several && c->score[o] > c->score[best] - PURPOSE_SEVERAL) ||
			((several || is_all) && c->arrangement.objects[o].is_there && less < PURPOSE_SAME);
	}
	to->there = there;
	to->is_by_purpose = 1;
	to->is_several = several || is_all;
}

/* Where a sentence says that it is said, if that is told by things that are here: "when facing the window",
 * "from the door". Several that fit alike tell nothing, but where several are meant. */
static int says_from(const struct chooser *c, const struct parse *p, struct viewpoint *to)
{
	const struct meaning *m = &c->meaning;
	const size_t n = c->arrangement.n;
	const int phrase = p->view == PARSE_VIEW_NONE ? -1 : p->view_phrase;

	if (phrase < 1 || p->phrases[phrase].viewer || p->phrases[phrase].scene || m->known[phrase] < 0.5)
		return 0;
	const double *fit = m->fit + (size_t)phrase * (n + 1);
	const size_t best = best_of(fit, n);
	double at[3] = {0}, count = 0;
	for (size_t o = 0; o < n; o++) {
		double centre[3];
		if (fit[o] < VIEW_ALIKE * fit[best] || !arrangement_where(&c->arrangement, o, centre))
			continue;
		for (int k = 0; k < 3; k++)
			at[k] += centre[k];
		count++;
	}
	if (m->there[(size_t)phrase * n + best] < VIEW_THERE || !count ||
		(count > 1 && p->phrases[phrase].count == PARSE_ONE))
		return 0;
	for (int k = 0; k < 3; k++)
		at[k] /= count;
	to->is_facing = p->view == PARSE_VIEW_FACING;
	if (!to->is_facing)
		to->kind = VIEWPOINT_POINT;
	memcpy(to->is_facing ? to->faced : to->point, at, sizeof at);
	return 1;
}

/* s gets the sentence with its parse, which is `own` where the sentence has none. */
static int choose_parsed(struct chooser *c, const struct choose_sentence *from, struct vocabulary_sentence *s,
	struct choice *to, double *row, char *chosen, struct parse *own, struct err *e)
{
	const struct lifted *l = c->scene->lifted;
	const struct parser_vectors vectors = {from->pieces, from->middle, (int)from->words, l->width};
	const struct parse *p = from->parse ? from->parse : own;

	if (!from->parse && parse_sentence(own, &c->parser, from->text, &vectors, e))
		return -1;
	if (c->scene->tracks && !from->parse &&
		choose_motion(&c->meaning, c->scene, &c->parser, from, own, e))
		return -1;
	to->is_motion = c->scene->tracks && (c->motion.said.n || c->motion.gone != MOTION_NONE);
	to->motion = to->is_motion && c->motion.said.n ? c->motion.said.events[0].kind : MOTION_NONE;
	const int is_all = from->is_all && own->phrases && own->phrases[0].count == PARSE_ONE;
	if (is_all) {
		own->phrases[0].count = PARSE_ALL;
		own->phrases[0].group = 0;
	}
	*s = (struct vocabulary_sentence){p, from->vectors, from->words};
	if (judge_sentence(&c->meaning, s, e))
		return -1;
	struct viewpoint said = from->from;
	if (says_from(c, p, &said)) {
		look_from(c, &said);
		if (judge_sentence(&c->meaning, s, e))
			return -1;
	}
	memset(row, 0, l->objects * sizeof *row);
	to->is_several = p->phrases[0].count != PARSE_ONE || p->phrases[0].also.n;
	to->there = choose_phrase(c, p, 0, row, chosen);
	for (int k = 0; k < p->phrases[0].also.n; k++)
		to->there = fmax(to->there, choose_phrase(c, p, p->phrases[0].also.item[k], row, chosen));
	const struct parse_phrase *target = &p->phrases[0];
	const int may_be_purpose =
		to->there < PARSE_LEAST || (!target->noun.n && !usage_says_more(&c->meaning));
	if (to->is_motion)
		choose_when(&c->motion, chosen, to->when);
	if (has(c, CHOOSE_PURPOSE) && may_be_purpose && !to->is_motion && !target->also.n &&
		!target->except.n && !target->ordinal && target->count <= PARSE_ONE)
		choose_purpose(c, target->count == PARSE_ALL && !is_all, is_all, to, row, chosen);
	return 0;
}

/* Everything of one sentence; row (O) is scratch. */
static int choose_one(struct chooser *c, const struct choose_sentence *from, struct choice *to, double *row,
	float *probability, char *chosen, const struct choose_watch *watch, size_t i, struct err *e)
{
	const size_t n = c->scene->lifted->objects;
	struct parse p = {0};
	struct vocabulary_sentence s;
	int bad = 0;

	*to = (struct choice){0};
	memset(chosen, 0, n);
	memset(probability, 0, n * sizeof *probability);
	if (!from->words || !n)
		return 0;
	look_from(c, &from->from);
	const size_t same = vocabulary_whole(&c->vocabulary, has(c, CHOOSE_SENTENCE) ? from->text : NULL,
		from->vectors, from->words, c->whole);
	if (from->pieces) {
		bad = choose_parsed(c, from, &s, to, row, chosen, &p, e);
		if (!bad && watch)
			watch->each(watch->data, i, &c->meaning);
	} else {
		to->there = 1;
		choose_whole(c, row, chosen);
	}
	if (!bad && same < n && !to->is_motion) {
		to->there = 1;
		for (size_t o = 0; o < n; o++)
			row[o] = chosen[o] = o == same;
	}
	for (size_t o = 0; o < n && !bad; o++)
		probability[o] = (float)row[o];
	parse_free(&p);
	return bad;
}

/* Words of the scene's own sentences and names are spelt right. */
static int know_words(struct chooser *c, struct err *e)
{
	const struct vocabulary *v = &c->vocabulary;

	c->words = mem_alloc(v->kind_count, sizeof *c->words, "vocabulary", e);
	if (!c->words)
		return -1;
	c->parser = *c->scene->parser;
	c->parser.known = c->words;
	c->parser.known_count = 0;
	for (size_t k = 0; k < v->kind_count; k++)
		if (!strchr(v->kinds[k].lemma, ' '))
			c->words[c->parser.known_count++] = v->kinds[k].lemma;
	return 0;
}

static int chooser_init(struct chooser *c, const struct choose_scene *s, unsigned parts, struct err *e)
{
	const size_t objects = s->lifted->objects;

	*c = (struct chooser){.scene = s, .parts = parts, .from = {.kind = VIEWPOINT_USUAL}};
	c->score = mem_alloc(objects, sizeof *c->score, "choice", e);
	c->whole = mem_alloc(objects, sizeof *c->whole, "choice", e);
	c->purpose = mem_alloc(objects, 3 * sizeof *c->purpose, "choice", e);
	if (!c->score || !c->whole || !c->purpose ||
		arrangement_make(&c->arrangement, s->lifted, s->splats, s->cameras, e) ||
		vocabulary_make(&c->vocabulary, s->lifted, s->parser, e) || know_words(c, e))
		return -1;
	c->meaning = (struct meaning){.arrangement = &c->arrangement,
		.vocabulary = &c->vocabulary,
		.has_surfaces = has(c, CHOOSE_SURFACES),
		.motion = s->tracks ? &c->motion : NULL,
		.naming = s->naming};
	if (s->tracks && motion_meaning_make(&c->motion, s->tracks, e))
		return -1;
	if (!has(c, CHOOSE_WORDS))
		c->meaning.without |= 1U << MEANING_NOUN | 1U << MEANING_ATTRIBUTE;
	if (!has(c, CHOOSE_COLOURS))
		c->meaning.without |= 1U << MEANING_COLOUR;
	c->vocabulary.has_said = s->naming == 1; /* what is said of its name is of other Gaussians, perhaps */
	c->vocabulary.has_names = has(c, CHOOSE_NAMES);
	c->vocabulary.has_knowledge = has(c, CHOOSE_KNOWLEDGE);
	if (!has(c, CHOOSE_SIZES))
		c->meaning.without |= 1U << MEANING_SIZE;
	if (!has(c, CHOOSE_RELATIONS))
		c->meaning.without |= 1U << MEANING_CLAUSE | 1U << MEANING_ORDINAL;
	if (!has(c, CHOOSE_EXCEPT))
		c->meaning.without |= 1U << MEANING_EXCEPT | 1U << MEANING_AMONG;
	return 0;
}

void chooser_free(struct chooser *c)
{
	if (!c)
		return;
	arrangement_free(&c->arrangement);
	if (c->vocabulary.lifted)
		vocabulary_free(&c->vocabulary);
	meaning_free(&c->meaning);
	motion_meaning_free(&c->motion);
	free(c->words);
	free(c->score);
	free(c->whole);
	free(c->purpose);
	free(c);
}

struct chooser *chooser_make(const struct choose_scene *s, unsigned parts, struct err *e)
{
	struct chooser *c = mem_zalloc(1, sizeof *c, "choice", e);

	if (!c || !chooser_init(c, s, parts, e))
		return c;
	chooser_free(c);
	return NULL;
}

void chooser_within(struct chooser *c, const struct meaning_set *set)
{
	c->meaning.set = set;
}

void chooser_swap(struct chooser *c, size_t i, size_t k)
{
	arrangement_swap(&c->arrangement, i, k);
}

const struct parse *chooser_parse(const struct chooser *c, size_t sentence)
{
	return &c->vocabulary.parses[sentence];
}

int choose_with(struct chooser *c, const struct choose_sentence *sentences, size_t n, struct choice *choices,
	float *probability, char *chosen, const struct choose_watch *watch, struct err *e)
{
	const size_t objects = c->scene->lifted->objects;
	double *row = mem_alloc(objects, sizeof *row, "choice", e);
	int bad = !row;

	for (size_t i = 0; i < n && !bad; i++)
		bad = choose_one(c, &sentences[i], &choices[i], row, probability + i * objects,
			chosen + i * objects, watch, i, e);
	free(row);
	return bad ? -1 : 0;
}

int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	struct choice *choices, float *probability, char *chosen, const struct choose_watch *watch,
	struct err *e)
{
	struct chooser *c = chooser_make(s, parts, e);
	const int bad = !c || choose_with(c, sentences, n, choices, probability, chosen, watch, e);

	chooser_free(c);
	return bad ? -1 : 0;
}
