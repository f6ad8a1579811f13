#include "ask/name_regions.h"

#include "ask/choose.h"
#include "base/mem.h"
#include "lang/naming.h"

#include <math.h>

/* Found on the desk's training views and sentences, and on made scenes of seed 5. */
static const double least_fit = 0.03, least_score = 0.02, least_vote = 0.02;
static const double score_worth = 2.5;
static const double vote_doubt = 0.1; /* votes that each region has for nothing */
static const double is_same = 0.5;    /* intersection over union of regions that are nearly one ... */
static const double is_part = 0.2;    /* ... and of a thing and a large part of it */
static const double part_doubt = 3;   /* of the value, which tells a thing from its parts badly */
enum { CHANGES = 3 };		      /* for each thing at most */

struct search {
	const struct lifted *l;
	size_t named;
	const struct region_facts *facts;
	struct chooser *chooser;
	struct choose_sentence *sentences; /* (R) */
	struct choice *choices;		   /* (R) */
	float *fit;			   /* (R,O) */
	char *chosen;			   /* (R,O) */
	double *own, *value;		   /* (named,count): of the region alone, and with the sentences */
	size_t *at;			   /* (named) */
};

/* A thing gets a region, and leaves the one that it has. */
static void move(struct search *s, size_t o, size_t region)
{
	if (s->at[o] != REGION_NONE)
		chooser_swap(s->chooser, o, s->named + s->at[o]);
	s->at[o] = region;
	if (region != REGION_NONE)
		chooser_swap(s->chooser, o, s->named + region);
}

/* How far a sentence calls its thing what a detector would: the words name one kind, or one is a kind of the
 * other, as a penguin is a bird. */
static double call_fits(const char *lemma, const char *class)
{
	struct naming thing, word, class_thing, class_word;

	naming_of_thing(&thing, lemma);
	naming_of_word(&word, lemma);
	naming_of_thing(&class_thing, class);
	naming_of_word(&class_word, class);
	return strcmp(lemma, class)
		       ? fmax(naming_fits(&class_word, &thing, 0), naming_fits(&word, &class_thing, 0))
		       : 1;
}

/* fits (named,classes): how far the mean sentence does. */
static int find_calls(const struct search *s, double *fits, struct err *e)
{
	const size_t classes = s->facts->class_count;
	SCOPED double *count = mem_zalloc(s->named, sizeof *count, "regions", e);

	if (!count)
		return -1;
	for (size_t r = 0; r < s->l->sentences; r++) {
		const struct parse *p = s->sentences[r].parse;
		const struct parse_list *noun = &p->phrases[0].noun;
		const size_t o = (size_t)s->l->object[r];
		count[o] += noun->n > 0;
		for (size_t c = 0; c < classes && noun->n; c++)
			fits[o * classes + c] +=
				call_fits(p->words[noun->item[noun->n - 1]].lemma, s->facts->classes[c]);
	}
	for (size_t i = 0; i < s->named * classes; i++)
		fits[i] /= fmax(count[i / classes], 1);
	return 0;
}

/* What is known of each region without the sentences' places and colours. */
static int find_own(struct search *s, struct err *e)
{
	const struct region_facts *f = s->facts;
	SCOPED double *fits = mem_zalloc(s->named, f->class_count * sizeof *fits, "regions", e);

	if (!fits || find_calls(s, fits, e))
		return -1;
	for (size_t i = 0; i < s->named * f->count; i++) {
		const double *fit = fits + i / f->count * f->class_count;
		const size_t k = i % f->count;
		double is = 0, all = vote_doubt;
		for (size_t c = 0; c < f->class_count; c++) {
			is += fit[c] * (double)f->votes[k * f->class_count + c];
			all += (double)f->votes[k * f->class_count + c];
		}
		s->own[i] = score_worth * log((double)f->score[k] + least_score) + log(is / all + least_vote);
	}
	return 0;
}

static int judge(struct search *s, struct err *e)
{
	const size_t n = s->l->objects, count = s->facts->count;

	if (choose_with(s->chooser, s->sentences, s->l->sentences, s->choices, s->fit, s->chosen, NULL, e))
		return -1;
	memcpy(s->value, s->own, s->named * count * sizeof *s->value);
	for (size_t r = 0; r < s->l->sentences; r++) {
		float *fit = s->fit + r * n, most = 1e-30f;
		double *value = s->value + (size_t)s->l->object[r] * count;
		for (size_t o = 0; o < n; o++)
			most = fmaxf(most, fit[o]);
		/* a region that a thing has is where that is */
		for (size_t o = 0; o < s->named; o++)
			if (s->at[o] != REGION_NONE)
				fit[s->named + s->at[o]] = fit[o];
		for (size_t k = 0; k < count; k++)
			value[k] += log((double)(fit[s->named + k] / most) + least_fit);
	}
	return 0;
}

static int agree(const struct search *s, size_t a, size_t b)
{
	return (double)s->facts->agree[a * s->facts->count + b] > is_same;
}

static int may_have(const struct search *s, size_t o, size_t region)
{
	for (size_t k = 0; k < s->named; k++)
		if (k != o && s->at[k] != REGION_NONE && agree(s, s->at[k], region))
			return 0;
	return 1;
}

/* A thing's best region, and by how much it is better than all that are another. */
static size_t best_region(const struct search *s, size_t o, double *margin)
{
	const size_t count = s->facts->count;
	const double *value = s->value + o * count;
	size_t best = REGION_NONE;
	double next = -1e9;

	for (size_t k = 0; k < count; k++)
		if (may_have(s, o, k) && (best == REGION_NONE || value[k] > value[best]))
			best = k;
	for (size_t k = 0; k < count && best != REGION_NONE; k++)
		if (!agree(s, best, k) && may_have(s, o, k))
			next = fmax(next, value[k]);
	*margin = best == REGION_NONE ? 0 : value[best] - next;
	return best;
}

/* The clearest thing that has no region gets one. Returns how many did, or -1 with *e set. */
static int place_clearest(struct search *s, struct err *e)
{
	size_t which = REGION_NONE, where = REGION_NONE;
	double most = -1, margin;

	if (judge(s, e))
		return -1;
	for (size_t o = 0; o < s->named; o++) {
		const size_t region = s->at[o] == REGION_NONE ? best_region(s, o, &margin) : REGION_NONE;
		if (region != REGION_NONE && margin > most) {
			most = margin;
			which = o;
			where = region;
		}
	}
	if (which != REGION_NONE)
		move(s, which, where);
	return which != REGION_NONE;
}

/* The change that is the best is made. Returns how many were, or -1 with *e set. */
static int change_best(struct search *s, struct err *e)
{
	size_t which = REGION_NONE, where = REGION_NONE;
	double most = 1e-6, margin;

	if (judge(s, e))
		return -1;
	for (size_t o = 0; o < s->named; o++) {
		const double *value = s->value + o * s->facts->count;
		const size_t region = best_region(s, o, &margin);
		if (s->at[o] == REGION_NONE || region == REGION_NONE ||
			value[region] - value[s->at[o]] <= most)
			continue;
		most = value[region] - value[s->at[o]];
		which = o;
		where = region;
	}
	if (which != REGION_NONE)
		move(s, which, where);
	return which != REGION_NONE;
}

/* What sentences say of a thing they say of its parts: of the regions in its own and around it that fit them
 * nearly as well, the likeliest thing. */
static void find_extent(struct search *s, size_t o)
{
	const size_t count = s->facts->count, own = s->at[o];
	const double *value = s->value + o * count;
	float most = -1;

	for (size_t k = 0; k < count && own != REGION_NONE; k++) {
		const float score = s->facts->score[k];
		if (score > most && value[k] >= value[own] - part_doubt &&
			(double)s->facts->agree[own * count + k] > is_part && may_have(s, o, k)) {
			most = score;
			s->at[o] = k;
		}
	}
}

static void find_probability(const struct search *s, size_t o, double *probability)
{
	const double *value = s->value + o * s->facts->count;
	double is = 0, all = 0;

	for (size_t k = 0; k < s->facts->count && s->at[o] != REGION_NONE; k++) {
		const double x = exp(fmin(value[k] - value[s->at[o]], 50));
		all += x;
		is += agree(s, s->at[o], k) ? x : 0;
	}
	*probability = all > 0 ? is / all : 0;
}

static int search(struct search *s, double *probability, struct err *e)
{
	int changed;

	while ((changed = place_clearest(s, e)) > 0)
		;
	for (size_t turn = 0; turn < CHANGES * s->named && changed >= 0; turn++)
		if (!(changed = change_best(s, e)))
			break;
	for (size_t o = 0; o < s->named; o++)
		find_extent(s, o);
	for (size_t o = 0; o < s->named; o++)
		find_probability(s, o, &probability[o]);
	return changed < 0 ? -1 : 0;
}

int name_regions(const struct lifted *l, size_t named, const struct region_facts *facts,
	const struct splats *splats, const struct cameras *cameras, const struct parser *parser,
	size_t *region, double *probability, struct err *e)
{
	const struct choose_scene scene = {l, splats, cameras, parser, 0, NULL};
	const size_t width = (size_t)l->width;
	struct search s = {.l = l, .named = named, .facts = facts, .at = region};
	SCOPED struct choose_sentence *sentences = s.sentences =
		mem_alloc(l->sentences, sizeof *sentences, "regions", e);
	SCOPED struct choice *choices = s.choices = mem_alloc(l->sentences, sizeof *choices, "regions", e);
	SCOPED float *fit = s.fit = mem_alloc(l->sentences, l->objects * sizeof *fit, "regions", e);
	SCOPED char *chosen = s.chosen = mem_alloc(l->sentences, l->objects, "regions", e);
	SCOPED double *own = s.own = mem_alloc(named, facts->count * sizeof *own, "regions", e);
	SCOPED double *value = s.value = mem_alloc(named, facts->count * sizeof *value, "regions", e);

	if (!sentences || !choices || !fit || !chosen || !own || !value)
		return -1;
	s.chooser = chooser_make(&scene, CHOOSE_ALL & ~(1U << CHOOSE_SENTENCE | 1U << CHOOSE_PURPOSE), e);
	for (size_t r = 0; r < l->sentences && s.chooser; r++)
		sentences[r] = (struct choose_sentence){l->texts[r], l->pieces[r],
			l->words + (size_t)l->offsets[r] * width, lifted_middle(l, r),
			(size_t)(l->offsets[r + 1] - l->offsets[r]), {.kind = VIEWPOINT_USUAL},
			chooser_parse(s.chooser, r), 0};
	for (size_t o = 0; o < named; o++)
		region[o] = REGION_NONE;
	const int bad = !s.chooser || find_own(&s, e) || search(&s, probability, e);
	chooser_free(s.chooser);
	return bad ? -1 : 0;
}
