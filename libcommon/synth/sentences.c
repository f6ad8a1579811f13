#include "synth/sentences.h"

#include <stdio.h>
#include <string.h>

enum { TRIES = 20000, ANCHOR_TRIES = 6 };

/* Frames: %S size, %F finish, %C colour, %N noun, %G group, %M material, %R a relation. */
static const char *const train_frames[] = {
	"the %S %C %N %R",
	"the %C %N standing %R",
	"the %F %C %N that stands %R",
	"the %S %N %R and %R",
	"the %C %G placed %R",
	"the %M %N with a %F %C surface, %R",
	"the %S %F %C %N on the wooden table",
	"the %C object %R",
	"the %F thing %R and %R",
	"the %S %M %N %R",
	"the %N %R, %R",
	"the %S %C %G set down %R",
	"the %N made of %M, %R",
};
static const char *const test_frames[] = {
	"the %C coloured %N resting %R",
	"the %F %N of %C colour, located %R",
	"the %S %C %G that you can see %R",
	"the %S %N in %C, positioned %R",
	"the %N whose colour is %C, %R",
	"the %C item found %R and %R",
	"the %S %F %N lying %R",
};

enum {
	TRAIN_FRAMES = sizeof train_frames / sizeof *train_frames,
	TEST_FRAMES = sizeof test_frames / sizeof *test_frames,
	WAYS = 3,
};

/* How each relation is said; %A and %B are the other objects. The last way is only for test sentences. */
static const char *const ways[SYNTH_RELATIONS][WAYS] = {
	[SYNTH_LEFT_OF] = {"to the left of %A", "left of %A", "on the left-hand side of %A"},
	[SYNTH_RIGHT_OF] = {"to the right of %A", "right of %A", "on the right-hand side of %A"},
	[SYNTH_IN_FRONT_OF] = {"in front of %A", "just in front of %A", "on the near side of %A"},
	[SYNTH_BEHIND] = {"behind %A", "just behind %A", "on the far side of %A"},
	[SYNTH_NEXT_TO] = {"next to %A", "beside %A", "right by %A"},
	[SYNTH_NEAREST_TO] = {"nearest to %A", "closest to %A", "at the least distance from %A"},
	[SYNTH_FARTHEST_FROM] = {"farthest from %A", "furthest away from %A", "most distant from %A"},
	[SYNTH_BETWEEN] = {"between %A and %B", "in between %A and %B", "with %A and %B on either side"},
	[SYNTH_LEFT_SIDE] = {"on the left side of the table", "at the left of the table",
		"on the left half of the table"},
	[SYNTH_RIGHT_SIDE] = {"on the right side of the table", "at the right of the table",
		"on the right half of the table"},
	[SYNTH_FRONT_SIDE] = {"near the front edge of the table", "at the front of the table",
		"on the near half of the table"},
	[SYNTH_BACK_SIDE] = {"near the back edge of the table", "at the back of the table",
		"on the far half of the table"},
	[SYNTH_MIDDLE] = {"in the middle of the table", "near the centre of the table",
		"in the central part of the table"},
	[SYNTH_LEFTMOST] = {"farthest to the left", "at the far left", "at the leftmost place"},
	[SYNTH_RIGHTMOST] = {"farthest to the right", "at the far right", "at the rightmost place"},
};

/* A sentence in the making. */
struct draft {
	struct synth_sentence s;
	const struct synth_word *hue, *noun;
	const struct synth_layout *layout;
	struct rng *rng;
	int is_test;
};

static int append(char *text, size_t size, const char *more)
{
	size_t used = strlen(text), extra = strlen(more);

	if (used + extra >= size)
		return -1;
	memcpy(text + used, more, extra + 1);
	return 0;
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
		int fitting = 0;
		for (int j = 0; j < l->n; j++)
			fitting += synth_meaning_fits(&m, &l->objects[j]);
		if (fitting == 1)
			return append(d->s.text, sizeof d->s.text, text);
	}
	return -1;
}

static int append_clause(struct draft *d)
{
	struct synth_sentence *s = &d->s;
	const struct synth_layout *l = d->layout;
	uint32_t n = (uint32_t)l->n, of_table = SYNTH_BETWEEN + 1;
	struct synth_clause c = {.a = -1, .b = -1};

	/* People say where a thing is by other things more often than by the table. */
	if (rng_uniform(d->rng) < 0.25) {
		c.relation = (enum synth_relation)(of_table + rng_below(d->rng, SYNTH_RELATIONS - of_table));
	} else {
		c.relation = (enum synth_relation)rng_below(d->rng, of_table);
		c.a = (int)rng_below(d->rng, n);
	}
	if (c.relation == SYNTH_BETWEEN)
		c.b = (int)rng_below(d->rng, n);
	if (c.a == s->object || c.b == s->object || (c.a >= 0 && c.a == c.b))
		return -1;
	for (int i = 0; i < s->clause_count; i++)
		if (s->clauses[i].relation == c.relation || s->clauses[i].a == c.a)
			return -1;
	const char *way = ways[c.relation][rng_below(d->rng, d->is_test ? WAYS : WAYS - 1)];
	for (; *way; way++) {
		char letter[2] = {*way, 0};
		if (*way != '%') {
			if (append(s->text, sizeof s->text, letter))
				return -1;
		} else if (append_anchor(d, *++way == 'A' ? c.a : c.b)) {
			return -1;
		}
	}
	s->clauses[s->clause_count++] = c;
	return 0;
}

static int fill(struct draft *d, const char *frame)
{
	struct synth_sentence *s = &d->s;

	for (const char *p = frame; *p; p++) {
		char letter[2] = {*p, 0};
		if (*p != '%') {
			if (append(s->text, sizeof s->text, letter))
				return -1;
			continue;
		}
		if (*++p == 'R') {
			if (append_clause(d))
				return -1;
			continue;
		}
		const struct synth_word *w =
			synth_word_choose((enum synth_word_kind) * p, &d->layout->objects[s->object], d->rng);
		if (!w || append(s->text, sizeof s->text, w->text))
			return -1;
		synth_meaning_add(&s->meaning, w);
		if (w->kind == SYNTH_HUE)
			d->hue = w;
		if (w->kind == SYNTH_NOUN)
			d->noun = w;
	}
	return 0;
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
		if (synth_sentence_judge(s, l, i) != (i == s->object ? 1 : -1))
			return 0;
	return 1;
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

/* The five sentences of one object, no frame twice. */
static int describe(struct synth_sentence *out, int object, const struct synth_layout *l, struct rng *r)
{
	const struct synth_word *hues[SYNTH_SENTENCES], *nouns[SYNTH_SENTENCES];
	unsigned used = 0;
	int done = 0;

	for (int tries = 0; tries < TRIES && done < SYNTH_SENTENCES; tries++) {
		struct draft d = {
			.s = {.object = object, .meaning = synth_meaning_any()}, .layout = l, .rng = r};
		d.is_test = done >= SYNTH_TRAIN_SENTENCES;
		uint32_t f = rng_below(r, d.is_test ? TEST_FRAMES : TRAIN_FRAMES);
		if ((!d.is_test && used >> f & 1) || fill(&d, d.is_test ? test_frames[f] : train_frames[f]))
			continue;
		int words = count_words(d.s.text), is_known = 0;
		for (int i = 0; d.is_test && d.hue && d.noun && i < done; i++)
			is_known |= hues[i] == d.hue && nouns[i] == d.noun;
		if (words < SYNTH_MIN_WORDS || words > SYNTH_MAX_WORDS || is_known ||
			!means_only_its_object(&d.s, l))
			continue;
		/* Variety is wanted, but few objects leave little to say. */
		if (tries < TRIES / 2 && repeats(&d.s, out, done))
			continue;
		used |= 1u << f;
		hues[done] = d.hue;
		nouns[done] = d.noun;
		d.s.split = d.is_test ? SPLIT_TEST : SPLIT_TRAIN;
		snprintf(d.s.ref, sizeof d.s.ref, "%s-%d", l->objects[object].ref, done + 1);
		out[done++] = d.s;
	}
	return done == SYNTH_SENTENCES ? 0 : -1;
}

int synth_sentences_make(
	struct synth_sentence *sentences, const struct synth_layout *l, uint64_t seed, struct err *e)
{
	struct rng r;

	rng_seed(&r, seed, SYNTH_STREAM_SENTENCES);
	for (int i = 0; i < l->n; i++)
		if (describe(sentences + (size_t)i * SYNTH_SENTENCES, i, l, &r))
			return err_set(e, ERR_CHECK,
				"seed %llu: the %s cannot be told apart in words; try another seed",
				(unsigned long long)seed, l->objects[i].name);
	return 0;
}
