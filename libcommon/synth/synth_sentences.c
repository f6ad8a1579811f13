#include "synth/sentence.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* How hard a sentence was to find decides what is asked of it. */
enum { TRIES_OF_STAGE = 4000, ANCHOR_TRIES = 6, CLAUSE_TRIES = 40, RELATION_TRIES = 6, MAX_CLAUSES = 3 };
enum stage {
	STAGE_FINE,	/* of the wanted length, and nothing said before */
	STAGE_LENGTH,	/* of any length */
	STAGE_REPEATED, /* what an earlier sentence of the object says too */
	STAGE_ARGUABLE, /* it could be argued of its object, but of no other */
	STAGES
};

/* 13.6 words on average and a little more often short than long, as in Ref-LERF. */
static const double mean_words = 13.6;
static const int usual_words[] = {9, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 16, 17, 18, 19};

enum { USUAL = sizeof usual_words / sizeof *usual_words };

/* A sentence in the making. */
struct draft {
	struct synth_sentence s;
	const struct synth_wordings *w;
	const struct synth_viewpoint *v;
	struct rng *rng;
	enum stage stage;
	int is_test_worded, among[SYNTH_MAX_OBJECTS];
};

/* among (n) gets the verdicts of the target's words. Returns how many objects they fit. */
static int judge_words(const struct synth_phrase *p, const struct synth_viewpoint *v, int *among)
{
	int n = 0;

	for (int i = 0; i < v->n; i++) {
		among[i] = synth_sense_judge(&p->sense, &v->objects[i]);
		n += among[i] > 0;
	}
	return n;
}

/* With the verdicts of the target's words known. */
static int judge_with(
	const struct synth_sentence *s, const struct synth_viewpoint *v, int i, const int *among)
{
	int verdict = among[i];

	for (int k = 0; k < s->clause_count && verdict >= 0; k++) {
		int one = synth_relation_judge(v, &s->clauses[k].is, i, among);
		verdict = one < verdict ? one : verdict;
	}
	return verdict;
}

static int means_only_its_object(const struct draft *d)
{
	for (int i = 0; i < d->v->n; i++)
		if (i != d->s.object && judge_with(&d->s, d->v, i, d->among) >= 0)
			return 0;
	return 1;
}

/* Says a random word for a slot in a phrase, one that is true of an object; -1 where there is none. */
static int say_word(struct draft *d, int phrase, char slot, int object)
{
	static const char slots[] = "SFMCN";
	const char *at = strchr(slots, slot);
	enum synth_word w = at ? (enum synth_word)(at - slots) : SYNTH_NOUN;
	const struct synth_query q = {
		.list = slot == 'G' ? SYNTH_GROUPS : synth_words_of(w), .of = &d->v->objects[object]};
	const struct synth_row *row = synth_draw(d->w, &q, d->rng);

	if (!row)
		return -1;
	synth_say(&d->s.phrases[phrase], w, row);
	return 0;
}

/* A short name for an object that no other has: "the red mug", with its size or finish. The phrase, or -1. */
static int name_anchor(struct draft *d, int object)
{
	static const char *const kinds[ANCHOR_TRIES] = {"N", "CN", "CN", "SCN", "FCN", "SFCN"};
	int among[SYNTH_MAX_OBJECTS], phrase = synth_add_phrase(&d->s);

	for (int i = (int)rng_below(d->rng, 2); i < ANCHOR_TRIES; i++) {
		d->s.phrase_count = phrase;
		synth_add_phrase(&d->s);
		for (const char *slot = kinds[i]; *slot; slot++)
			say_word(d, phrase, *slot, object);
		if (judge_words(&d->s.phrases[phrase], d->v, among) == 1)
			return phrase;
	}
	return -1;
}

static int is_of_table(const struct synth_row *kind)
{
	return kind->relation == PARSE_ON && !kind->anchors;
}

/* Nobody says of a thing that it is on the table unless another one like it is not. */
static int is_worth_saying(const struct draft *d, const struct synth_row *kind)
{
	int worth = !is_of_table(kind);

	for (int i = 0; i < d->v->n; i++)
		worth |= d->v->objects[i].on >= 0 && d->among[i] > 0;
	return worth;
}

/* The direction that a relation without anchors speaks of; -1: none. */
static int direction(const struct synth_row *kind)
{
	if (kind->anchors > 0 || synth_relation_is_size(kind->relation) || is_of_table(kind))
		return -1;
	return kind->relation == PARSE_NEAR  ? PARSE_FRONT
	       : kind->relation == PARSE_FAR ? PARSE_BEHIND
					     : (int)kind->relation;
}

/* Relations that say nearly the same: "the farthest one of the two, farthest from us". */
static int say_alike(const struct synth_row *a, const struct synth_row *b)
{
	return a == b || (direction(a) >= 0 && direction(a) == direction(b));
}

/* 1 where the clause tells the object from one that the sentence so far may mean as well, or none is left. */
static int helps(const struct draft *d, const struct synth_relation *r)
{
	int rivals = 0;

	for (int i = 0; i < d->v->n; i++) {
		if (i == d->s.object || judge_with(&d->s, d->v, i, d->among) < 0)
			continue;
		if (synth_relation_judge(d->v, r, i, d->among) < 0)
			return 1;
		rivals++;
	}
	return !rivals;
}

/* 1 where the sentence may say this of its object. */
static int holds(const struct draft *d, const struct synth_clause *c)
{
	const struct synth_sentence *s = &d->s;
	const struct synth_relation *r = &c->is;

	if (r->a == s->object || r->b == s->object || (r->a >= 0 && r->a == r->b))
		return 0;
	for (int i = 0; i < s->clause_count; i++)
		if (say_alike(s->clauses[i].kind, c->kind) || (r->a >= 0 && s->clauses[i].is.a == r->a))
			return 0;
	return is_worth_saying(d, c->kind) &&
	       synth_relation_judge(d->v, r, s->object, d->among) >= (d->stage < STAGE_ARGUABLE) &&
	       (d->stage < STAGE_REPEATED || helps(d, r));
}

/* Another object for a relation: any, but of a stack the one that it can only be. */
static int choose_other(const struct draft *d, enum parse_relation relation)
{
	const struct synth_object *o = d->v->objects;
	int load = 0;

	if (relation == PARSE_ON && o[d->s.object].on >= 0)
		return o[d->s.object].on;
	while (load < d->v->n && o[load].on != d->s.object)
		load++;
	return relation == PARSE_BELOW && load < d->v->n ? load : (int)rng_below(d->rng, (uint32_t)d->v->n);
}

/* A clause that is true of the object; -1 where none was met. */
static int choose_clause(struct draft *d, const char *slot, struct synth_clause *c)
{
	const struct synth_query q = {.list = SYNTH_RELATIONS, .forms = slot};

	for (int i = 0; i < CLAUSE_TRIES; i++) {
		const struct synth_row *kind = synth_draw(d->w, &q, d->rng);
		*c = (struct synth_clause){.kind = kind, .is = {kind->relation, kind->degree, -1, -1}};
		for (int k = 0; k < (kind->anchors > 0 ? RELATION_TRIES : 1); k++) {
			if (kind->anchors > 0)
				c->is.a = choose_other(d, kind->relation);
			if (kind->anchors > 1)
				c->is.b = choose_other(d, kind->relation);
			if (holds(d, c))
				return 0;
		}
	}
	return -1;
}

/* Adds a clause for a slot, "R" or "Z", with its wording and the names of its objects. */
static int add_clause(struct draft *d, const char *slot)
{
	struct synth_sentence *s = &d->s;
	struct synth_clause c;

	if (s->clause_count == MAX_CLAUSES || choose_clause(d, slot, &c))
		return -1;
	const struct synth_query q = {
		.list = d->is_test_worded ? SYNTH_SAID_TEST : SYNTH_SAID, .like = c.kind};
	c.said = synth_draw(d->w, &q, d->rng);
	for (; c.anchor_count < c.kind->anchors; c.anchor_count++) {
		c.anchors[c.anchor_count] = name_anchor(d, c.anchor_count ? c.is.b : c.is.a);
		if (c.anchors[c.anchor_count] < 0)
			return -1;
	}
	s->clauses[synth_add_clause(s, 0, c.is.relation, c.is.degree)] = c;
	return 0;
}

/* The words of the noun phrase, before any relation: comparisons and numbers depend on all of them. */
static int choose_words(struct draft *d, const char *frame)
{
	for (const char *p = strchr(frame, '%'); p; p = strchr(p + 1, '%'))
		if (!strchr("KZR", p[1]) && say_word(d, 0, p[1], d->s.object))
			return -1;
	d->s.phrases[0].group = judge_words(&d->s.phrases[0], d->v, d->among);
	return 0;
}

static int fill(struct draft *d, const char *frame)
{
	char longer[96];
	int group, bad = choose_words(d, frame);

	for (const char *p = strchr(frame, '%'); p && !bad; p = strchr(p + 1, '%')) {
		group = d->s.phrases[0].group;
		if (p[1] == 'R' || p[1] == 'Z')
			bad = add_clause(d, p[1] == 'R' ? "R" : "Z");
		else
			bad = p[1] == 'K' && (group < 2 || group > 6);
	}
	/* One more where words are hard to find. */
	if (!bad && d->stage >= STAGE_REPEATED && !means_only_its_object(d)) {
		bad = add_clause(d, "R");
		snprintf(longer, sizeof longer, "%s, %%R", frame);
		frame = longer;
	}
	return -(bad || synth_write(&d->s, frame, NULL, d->rng));
}

/* 1 where one of the sentences so far already says the same of the same other object. */
static int repeats(const struct synth_sentence *s, const struct synth_sentence *earlier, int n)
{
	for (int i = 0; i < n; i++)
		for (int j = 0; j < earlier[i].clause_count; j++)
			for (int k = 0; k < s->clause_count; k++)
				if (earlier[i].clauses[j].kind == s->clauses[k].kind &&
					earlier[i].clauses[j].is.a == s->clauses[k].is.a)
					return 1;
	return 0;
}

int synth_count_words(const char *text)
{
	int n = 1;

	for (; *text; text++)
		n += *text == ' ';
	return n;
}

/* "black" of "jet black". */
static const char *basic_colour(const struct synth_sentence *s)
{
	const char *colour = s->phrases[0].words[SYNTH_COLOUR_WORD],
		   *space = colour ? strrchr(colour, ' ') : NULL;

	return space ? space + 1 : colour;
}

/* The noun, but no word for several shapes. */
static const char *own_noun(const struct synth_sentence *s)
{
	return *s->phrases[0].plural ? s->phrases[0].words[SYNTH_NOUN] : NULL;
}

/* 1 where a text has the colour word and the noun of a sentence together. */
static int has_pair(const char *text, const struct synth_sentence *of)
{
	char pair[64];

	snprintf(pair, sizeof pair, "%s %s", basic_colour(of), own_noun(of));
	return strstr(text, pair) != NULL;
}

/* 1 where the sentence's colour word and noun occur together in one of the n earlier ones of the object, or
 * those of an earlier one in it. */
static int is_pair_known(const struct synth_sentence *s, const struct synth_sentence *earlier, int n)
{
	int has_own = basic_colour(s) && own_noun(s);

	for (int i = 0; i < n; i++) {
		if (has_own && has_pair(earlier[i].text, s))
			return 1;
		if (!basic_colour(&earlier[i]) || !own_noun(&earlier[i]))
			continue;
		if (has_pair(s->text, &earlier[i]) ||
			(has_own && own_noun(&earlier[i]) == own_noun(s) &&
				!strcmp(basic_colour(&earlier[i]), basic_colour(s))))
			return 1;
	}
	return 0;
}

/* Appends sentence number `done` of an object, of about `wanted` words; frames: those that its training
 * sentences have had. Returns the number of words, 0 where none was found, or -1 with *e set. */
static int say(struct synth_sentences *list, int object, int done, const struct synth_row **frames,
	int wanted, const struct synth_viewpoint *v, int is_wording_seen, struct rng *r, struct err *e)
{
	int is_test = done >= SYNTH_TRAIN_SENTENCES, is_test_worded = is_test && !is_wording_seen;
	const struct synth_query q = {.list = is_test_worded ? SYNTH_TEST : SYNTH_TRAIN};

	for (int tries = 0; tries < STAGES * TRIES_OF_STAGE; tries++) {
		const struct synth_sentence *earlier = done ? list->items + list->n - done : NULL;
		enum stage stage = (enum stage)(tries / TRIES_OF_STAGE);
		struct draft d = {.s = {.object = object, .view = -1, .objects = (uint64_t)1 << object},
			.w = &list->wordings,
			.v = v,
			.rng = r,
			.is_test_worded = is_test_worded,
			.stage = stage};
		int is_used = 0;
		const struct synth_row *frame = synth_draw(d.w, &q, r);
		synth_add_phrase(&d.s);
		for (int k = 0; k < done; k++)
			is_used |= frames[k] == frame;
		if (is_used || fill(&d, frame->text))
			continue;
		int words = synth_count_words(d.s.text);
		if (words < SYNTH_MIN_WORDS || words > SYNTH_MAX_WORDS ||
			(is_test && is_pair_known(&d.s, earlier, done)) ||
			(stage < STAGE_LENGTH && (words < wanted - 1 || words > wanted + 1)) ||
			(stage < STAGE_REPEATED && repeats(&d.s, earlier, done)) ||
			!means_only_its_object(&d))
			continue;
		frames[done] = frame;
		d.s.split = is_test ? SPLIT_TEST : SPLIT_TRAIN;
		snprintf(d.s.ref, sizeof d.s.ref, "%s-%d", v->objects[object].ref, done + 1);
		return synth_sentences_add(list, &d.s, e) ? -1 : words;
	}
	return 0;
}

int synth_sentences_make(struct synth_sentences *list, const struct synth_viewpoint *v, uint64_t seed,
	int is_wording_seen, struct err *e)
{
	struct rng r;
	double owed = 0; /* words that the sentences so far are short of the mean */

	*list = (struct synth_sentences){0};
	rng_seed(&r, seed, SYNTH_STREAM_SENTENCES);
	if (synth_wordings_load(&list->wordings, SYNTH_TABLE_SENTENCES, e))
		return -1;
	for (int i = 0; i < v->n; i++) {
		const struct synth_row *frames[SYNTH_SENTENCES];
		for (int k = 0; k < SYNTH_SENTENCES; k++) {
			int wanted = usual_words[rng_below(&r, USUAL)] + (int)lrint(owed / 2);
			int words = say(list, i, k, frames, wanted, v, is_wording_seen, &r, e);
			if (words < 0)
				return -1;
			if (!words)
				return err_set(e, ERR_CHECK,
					"seed %llu: the %s cannot be told apart in words; try another seed",
					(unsigned long long)seed, v->objects[i].name);
			owed += mean_words - words;
		}
	}
	return 0;
}
