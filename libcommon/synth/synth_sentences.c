#include "synth/synth_sentences.h"

#include "synth/frames.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* How hard a sentence was to find decides what is asked of it. */
enum { TRIES_OF_STAGE = 4000, ANCHOR_TRIES = 6, CLAUSE_TRIES = 40, RELATION_TRIES = 6 };
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

enum { USUAL = sizeof usual_words / sizeof *usual_words, SLOTS = 8 };

/* A sentence in the making. */
struct draft {
	struct synth_sentence s;
	const struct synth_word *words[SLOTS]; /* of the frame's slots in order; NULL for %K, %Z and %R */
	const struct synth_word *hue, *noun;
	const struct synth_layout *layout;
	struct rng *rng;
	enum stage stage;
	int is_test, fitting;
};

static int append(char *text, size_t size, const char *more)
{
	size_t used = strlen(text), extra = strlen(more);

	if (used + extra >= size)
		return -1;
	memcpy(text + used, more, extra + 1);
	return 0;
}

static int append_plural(char *text, size_t size, const char *noun)
{
	size_t n = strlen(noun);

	return append(text, size, noun) || append(text, size, noun[n - 1] == 'x' ? "es" : "s");
}

static int count_fitting(const struct synth_layout *l, const struct synth_meaning *m)
{
	int n = 0;

	for (int i = 0; i < l->n; i++)
		n += synth_meaning_fits(m, &l->objects[i]);
	return n;
}

int synth_sentence_judge(const struct synth_sentence *s, const struct synth_layout *l, int i)
{
	int verdict = 1;

	if (!synth_meaning_fits(&s->meaning, &l->objects[i]))
		return -1;
	for (int k = 0; k < s->clause_count; k++) {
		int one = synth_clause_judge(l, &s->clauses[k], i, &s->meaning);
		verdict = one < verdict ? one : verdict;
	}
	return verdict;
}

static int means_only_its_object(const struct synth_sentence *s, const struct synth_layout *l)
{
	for (int i = 0; i < l->n; i++)
		if (i != s->object && synth_sentence_judge(s, l, i) >= 0)
			return 0;
	return 1;
}

/* A short name for an object that no other has: "the red mug", with its size or finish where that helps. */
static int append_anchor(struct draft *d, int anchor)
{
	static const char *const kinds[ANCHOR_TRIES] = {"N", "CN", "CN", "SCN", "FCN", "SFCN"};
	const struct synth_layout *l = d->layout;

	for (int i = (int)rng_below(d->rng, 2); i < ANCHOR_TRIES; i++) {
		struct synth_meaning m = synth_meaning_any();
		char text[96] = "the";
		for (const char *k = kinds[i]; *k; k++) {
			const struct synth_word *w =
				synth_word_choose((enum synth_word_kind) * k, &l->objects[anchor], d->rng);
			synth_meaning_add(&m, w);
			append(text, sizeof text, " ");
			append(text, sizeof text, w->text);
		}
		if (count_fitting(l, &m) == 1)
			return append(d->s.text, sizeof d->s.text, text);
	}
	return -1;
}

/* Nobody says of a thing that it is on the table unless another one like it is not. */
static int is_worth_saying(const struct draft *d, const struct synth_clause *c)
{
	int worth = c->relation != SYNTH_ON_TABLE;

	for (int i = 0; i < d->layout->n; i++)
		worth |= d->layout->objects[i].on >= 0 &&
			 synth_meaning_fits(&d->s.meaning, &d->layout->objects[i]);
	return worth;
}

/* Relations that say nearly the same: "the farthest one of the two, farthest from us". */
static int say_alike(enum synth_relation a, enum synth_relation b)
{
	static const char direction[SYNTH_RELATIONS] = {[SYNTH_LEFT_SIDE] = 'l',
		[SYNTH_LEFTMOST] = 'l',
		[SYNTH_LEFT_ONE] = 'l',
		[SYNTH_RIGHT_SIDE] = 'r',
		[SYNTH_RIGHTMOST] = 'r',
		[SYNTH_RIGHT_ONE] = 'r',
		[SYNTH_FRONT_SIDE] = 'f',
		[SYNTH_NEAREST_US] = 'f',
		[SYNTH_NEAR_ONE] = 'f',
		[SYNTH_BACK_SIDE] = 'b',
		[SYNTH_FARTHEST_US] = 'b',
		[SYNTH_FAR_ONE] = 'b',
		[SYNTH_MIDDLE] = 'm',
		[SYNTH_MIDDLE_ONE] = 'm'};

	return a == b || (direction[a] && direction[a] == direction[b]);
}

/* 1 where the clause tells the object from one that the sentence so far may mean as well, or none is left. */
static int helps(const struct draft *d, const struct synth_clause *c)
{
	const struct synth_sentence *s = &d->s;
	int rivals = 0;

	for (int i = 0; i < d->layout->n; i++) {
		if (i == s->object || synth_sentence_judge(s, d->layout, i) < 0)
			continue;
		if (synth_clause_judge(d->layout, c, i, &s->meaning) < 0)
			return 1;
		rivals++;
	}
	return !rivals;
}

/* 1 where the sentence may say this of its object. */
static int holds(const struct draft *d, const struct synth_clause *c)
{
	const struct synth_sentence *s = &d->s;

	if (c->a == s->object || c->b == s->object || (c->a >= 0 && c->a == c->b))
		return 0;
	for (int i = 0; i < s->clause_count; i++)
		if (say_alike(s->clauses[i].relation, c->relation) || (c->a >= 0 && s->clauses[i].a == c->a))
			return 0;
	return is_worth_saying(d, c) &&
	       synth_clause_judge(d->layout, c, s->object, &s->meaning) >= (d->stage < STAGE_ARGUABLE) &&
	       (d->stage < STAGE_REPEATED || helps(d, c));
}

/* Another object for a relation: any, but of a stack the one that it can only be. */
static int choose_other(const struct draft *d, enum synth_relation relation)
{
	const struct synth_layout *l = d->layout;
	int load = 0;

	if (relation == SYNTH_ON && l->objects[d->s.object].on >= 0)
		return l->objects[d->s.object].on;
	while (load < l->n && l->objects[load].on != d->s.object)
		load++;
	return relation == SYNTH_UNDER && load < l->n ? load : (int)rng_below(d->rng, (uint32_t)l->n);
}

/* A clause that is true of the object; -1 where none was met. */
static int choose_clause(struct draft *d, char slot, struct synth_clause *c)
{
	for (int i = 0; i < CLAUSE_TRIES; i++) {
		*c = (struct synth_clause){.relation = synth_relation_choose(slot, d->rng), .a = -1, .b = -1};
		int has_other = c->relation <= SYNTH_BETWEEN;
		for (int k = 0; k < (has_other ? RELATION_TRIES : 1); k++) {
			if (has_other)
				c->a = choose_other(d, c->relation);
			if (c->relation == SYNTH_BETWEEN)
				c->b = choose_other(d, c->relation);
			if (holds(d, c))
				return 0;
		}
	}
	return -1;
}

static int append_clause(struct draft *d, char slot)
{
	struct synth_sentence *s = &d->s;
	struct synth_clause c;

	if (s->clause_count == SYNTH_CLAUSES || choose_clause(d, slot, &c))
		return -1;
	for (const char *p = synth_wording(c.relation, d->is_test, d->rng); *p; p++) {
		char letter[2] = {*p, 0};
		if (*p != '%') {
			if (append(s->text, sizeof s->text, letter))
				return -1;
		} else if (append_anchor(d, *++p == 'A' ? c.a : c.b)) {
			return -1;
		}
	}
	s->clauses[s->clause_count++] = c;
	return 0;
}

/* The words of the noun phrase, before anything is written: comparisons and numbers depend on all of them. */
static int choose_words(struct draft *d, const char *frame)
{
	struct synth_sentence *s = &d->s;
	int n = 0;

	for (const char *p = frame; *p; p++) {
		if (*p != '%')
			continue;
		p++;
		if (strchr("KZR", *p)) {
			d->words[n++] = NULL;
			continue;
		}
		enum synth_word_kind kind = *p == 'P' ? SYNTH_NOUN : (enum synth_word_kind) * p;
		const struct synth_word *w = synth_word_choose(kind, &d->layout->objects[s->object], d->rng);
		if (!w)
			return -1;
		synth_meaning_add(&s->meaning, w);
		if (kind == SYNTH_HUE)
			d->hue = w;
		if (kind == SYNTH_NOUN)
			d->noun = w;
		d->words[n++] = w;
	}
	d->fitting = count_fitting(d->layout, &s->meaning);
	return 0;
}

static int fill(struct draft *d, const char *frame)
{
	static const char *const numbers[] = {"two", "three", "four", "five", "six"};
	struct synth_sentence *s = &d->s;
	size_t size = sizeof s->text;
	int slot = 0, bad = choose_words(d, frame);

	for (const char *p = frame; *p && !bad; p++) {
		char letter[2] = {*p, 0};
		if (*p != '%') {
			bad = append(s->text, size, letter);
			continue;
		}
		const struct synth_word *w = d->words[slot++];
		if (*++p == 'R' || *p == 'Z')
			bad = append_clause(d, *p);
		else if (*p == 'K')
			bad = d->fitting < 2 || d->fitting > 6 ||
			      append(s->text, size, numbers[d->fitting - 2]);
		else
			bad = *p == 'P' ? append_plural(s->text, size, w->text)
					: append(s->text, size, w->text);
	}
	/* One more where words are hard to find. */
	if (!bad && d->stage >= STAGE_REPEATED && !means_only_its_object(s, d->layout))
		bad = append(s->text, size, ", ") || append_clause(d, 'R');
	return bad ? -1 : 0;
}

/* 1 where one of the sentences so far already says the same of the same other object. */
static int repeats(const struct synth_sentence *s, const struct synth_sentence *earlier, int n)
{
	for (int i = 0; i < n; i++)
		for (int j = 0; j < earlier[i].clause_count; j++)
			for (int k = 0; k < s->clause_count; k++)
				if (earlier[i].clauses[j].relation == s->clauses[k].relation &&
					earlier[i].clauses[j].a == s->clauses[k].a)
					return 1;
	return 0;
}

static int count_words(const char *text)
{
	int n = 1;

	for (; *text; text++)
		n += *text == ' ';
	return n;
}

/* What the sentences of an object have used up. */
struct described {
	unsigned frames; /* training ones, a bit each */
	const struct synth_word *hues[SYNTH_SENTENCES], *nouns[SYNTH_SENTENCES];
};

/* "black" of "jet black". */
static const char *basic_colour(const struct synth_word *hue)
{
	const char *space = strrchr(hue->text, ' ');

	return space ? space + 1 : hue->text;
}

static int has_pair(const char *text, const struct synth_word *hue, const struct synth_word *noun)
{
	char pair[64];

	snprintf(pair, sizeof pair, "%s %s", basic_colour(hue), noun->text);
	return strstr(text, pair) != NULL;
}

/* 1 where the draft's colour word and noun occur together in one of the n earlier sentences, be it of another
 * object, or those of an earlier one in the draft. */
static int is_pair_known(
	const struct draft *d, const struct described *so_far, const struct synth_sentence *earlier, int n)
{
	int has_own = d->hue && d->noun;

	for (int i = 0; i < n; i++) {
		const struct synth_word *hue = so_far->hues[i], *noun = so_far->nouns[i];
		if (has_own && has_pair(earlier[i].text, d->hue, d->noun))
			return 1;
		if (!hue || !noun)
			continue;
		if (has_pair(d->s.text, hue, noun) ||
			(has_own && noun == d->noun && !strcmp(basic_colour(hue), basic_colour(d->hue))))
			return 1;
	}
	return 0;
}

/* Sentence number `done` of an object, of about `wanted` words. */
static int say(struct synth_sentence *out, int done, struct described *so_far, int object, int wanted,
	const struct synth_layout *l, struct rng *r)
{
	int is_test = done >= SYNTH_TRAIN_SENTENCES;

	for (int tries = 0; tries < STAGES * TRIES_OF_STAGE; tries++) {
		enum stage stage = (enum stage)(tries / TRIES_OF_STAGE);
		struct draft d = {.s = {.object = object, .meaning = synth_meaning_any()},
			.layout = l,
			.rng = r,
			.is_test = is_test,
			.stage = stage};
		int f = (int)rng_below(r, (uint32_t)synth_frame_count(is_test));
		if ((!is_test && so_far->frames >> f & 1) || fill(&d, synth_frame(is_test, f)))
			continue;
		int words = count_words(d.s.text);
		if (words < SYNTH_MIN_WORDS || words > SYNTH_MAX_WORDS ||
			(is_test && is_pair_known(&d, so_far, out, done)) ||
			(stage < STAGE_LENGTH && (words < wanted - 1 || words > wanted + 1)) ||
			(stage < STAGE_REPEATED && repeats(&d.s, out, done)) ||
			!means_only_its_object(&d.s, l))
			continue;
		if (!is_test)
			so_far->frames |= 1u << f;
		so_far->hues[done] = d.hue;
		so_far->nouns[done] = d.noun;
		d.s.split = is_test ? SPLIT_TEST : SPLIT_TRAIN;
		snprintf(d.s.ref, sizeof d.s.ref, "%s-%d", l->objects[object].ref, done + 1);
		out[done] = d.s;
		return words;
	}
	return -1;
}

int synth_sentences_make(
	struct synth_sentence *sentences, const struct synth_layout *l, uint64_t seed, struct err *e)
{
	struct rng r;
	double owed = 0; /* words that the sentences so far are short of the mean */

	rng_seed(&r, seed, SYNTH_STREAM_SENTENCES);
	for (int i = 0; i < l->n; i++) {
		struct described so_far = {0};
		for (int k = 0; k < SYNTH_SENTENCES; k++) {
			int wanted = usual_words[rng_below(&r, USUAL)] + (int)lrint(owed / 2);
			int words =
				say(sentences + (size_t)i * SYNTH_SENTENCES, k, &so_far, i, wanted, l, &r);
			if (words < 0)
				return err_set(e, ERR_CHECK,
					"seed %llu: the %s cannot be told apart in words; try another seed",
					(unsigned long long)seed, l->objects[i].name);
			owed += mean_words - words;
		}
	}
	return 0;
}
