/* What the words of a phrase say of each object: its noun, colours and attributes, and what it does or has.
 */
#include "ask/constants.h"
#include "ask/meaning_private.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/finish.h"
#include "lang/purpose.h"
#include "lang/tokens.h"

#include <math.h>
#include <string.h>

/* Objects that look the same share what is said of them. */
static void share_looks(const struct meaning *m, double *match)
{
	const size_t n = objects_of(m);
	double *own = m->scratch;

	memcpy(own, match, n * sizeof *own);
	for (size_t o = 0; o < n && m->looks; o++)
		for (size_t k = 0; k < n; k++)
			if (match[o] >= 0)
				match[o] = fmax(match[o], own[k] * m->looks[o * n + k]);
}

int meaning_word_is(const struct parse_word *w, const char *const *list)
{
	for (; *list; list++)
		if (!strcmp(w->text, *list) || !strcmp(w->lemma, *list))
			return 1;
	return 0;
}

/* The word that names the kind of thing, or -1: "something", "the red one". */
int meaning_head_of(const struct parse *p, const struct parse_phrase *f)
{
	static const char *const generic[] = {"thing", "object", "item", "one", "something", "anything",
		"everything", "stuff", "what", "whatever", "which", "who", "whoever", "thingy", "other",
		"another", "piece", NULL};
	const int head = f->noun.n ? f->noun.item[f->noun.n - 1] : -1;

	return head >= 0 && (meaning_word_is(&p->words[head], generic) ||
				    closed_is(p->words[head].text, CLOSED_BE))
		       ? -1
		       : head;
}

static int has_word(const struct parse *p, const struct parse_phrase *f, const char *const *list)
{
	for (int w = 0; w < p->word_count; w++)
		if (p->words[w].span.begin >= f->span.begin && p->words[w].span.end <= f->span.end &&
			meaning_word_is(&p->words[w], list))
			return 1;
	return 0;
}

/* "the red one", "the other two": a thing of the kind that was spoken of. */
static int is_elliptic(const struct parse *p, const struct parse_phrase *f)
{
	static const char *const again[] = {
		"one", "ones", "other", "others", "another", "two", "three", "those", NULL};

	for (int w = 1; w < p->word_count && !f->noun.n; w++) /* "the striped one" */
		if (p->words[w - 1].span.end == f->span.end && meaning_word_is(&p->words[w], again))
			return 1;
	return !f->noun.n && (f->span.begin == f->span.end || has_word(p, f, again));
}

/* "the other cups", "anything else". */
int meaning_is_other(const struct parse *p, const struct parse_phrase *f)
{
	static const char *const other[] = {"other", "others", "else", "rest", "remaining", NULL};

	return has_word(p, f, other);
}

/* The colour that a colour goes on with, as "black and white" and "salmon pink" do, or -1; and the one
 * before. */
static int colour_after(const struct parse *p, int word)
{
	static const char *const plus[] = {"and", NULL};
	const int next = parse_word_is(p, word + 1, plus) ? word + 2 : word + 1;

	return next < p->word_count && colour_word(p->words[next].lemma) >= 0 ? next : -1;
}

static int colour_before(const struct parse *p, int word)
{
	for (int i = word - 2 > 0 ? word - 2 : 0; i < word; i++)
		if (colour_word(p->words[i].lemma) >= 0 && colour_after(p, i) == word)
			return i;
	return -1;
}

/* "blue-green" is teal. */
static int is_blue_green(const struct parse *p, int word)
{
	static const char *const blue[] = {"blue", "bluish", NULL};
	static const char *const green[] = {"green", "greenish", NULL};

	return word + 1 < p->word_count &&
	       ((meaning_word_is(&p->words[word], blue) && meaning_word_is(&p->words[word + 1], green)) ||
		       (meaning_word_is(&p->words[word], green) &&
			       meaning_word_is(&p->words[word + 1], blue)));
}

/* What a colour is of that a phrase has after another one: "the brown cup with white stripes". */
enum coloured { OF_THING, OF_PART_PERHAPS, OF_PART };

static enum coloured coloured_by(const struct parse *p, const struct parse_phrase *f, int word)
{
	static const char *const with[] = {"with", "w", "having", NULL};
	enum coloured of = OF_THING;

	if (parse_word_is(p, word + 1, closed_at_end) &&
		(parse_word_is(p, word + 2, closed_ends) || parse_word_is(p, word + 3, closed_ends)))
		return OF_PART; /* "green at the bottom" */
	for (int i = word - 1; i >= 0; i--) {
		if (parse_list_has(&f->attributes, i)) {
			if (of != OF_THING && colour_word(p->words[i].lemma) >= 0)
				return of;
		} else if (of != OF_PART) {
			of = meaning_word_is(&p->words[i], with) ? OF_PART : OF_PART_PERHAPS;
		}
	}
	return OF_THING;
}

/* Whether a phrase names what a surface is marked with. */
static int is_marking(const struct parse *p, const struct parse_phrase *f)
{
	static const char *const markings[] = {"band", "bit", "blob", "blotch", "check", "dot", "fleck",
		"freckle", "hoop", "line", "marking", "patch", "pattern", "ring", "speck", "speckle",
		"splash", "splodge", "splotch", "spot", "streak", "stripe", "swirl", NULL};
	const int head = meaning_head_of(p, f);

	return head >= 0 && meaning_word_is(&p->words[head], markings);
}

/* Whether a part is all that one sees of a thing: "a book with a red cover". */
static int is_outside(const struct parse *p, const struct parse_phrase *f)
{
	static const char *const outsides[] = {"binding", "body", "coating", "colour", "color", "cover",
		"exterior", "finish", "fur", "glaze", "outside", "paint", "skin", "surface", NULL};
	const int head = meaning_head_of(p, f);

	return head >= 0 && meaning_word_is(&p->words[head], outsides);
}

/* "With a yellow scarf": a colour that nothing here has, or is said to have, speaks against its being there.
 */
void meaning_judge_part_colours(struct meaning *m, int phrase, const struct parse_clause *c, double *value)
{
	const struct parse *p = m->sentence->parse;
	double *match = m->scratch + objects_of(m), *there = there_of(m, phrase);

	for (int k = 0; k < c->anchors.n; k++) {
		const struct parse_phrase *f = &p->phrases[c->anchors.item[k]];
		const int counts = m->known[c->anchors.item[k]] < 0.5 || is_marking(p, f);
		for (int a = 0; a < f->attributes.n && counts; a++) {
			const char *word = p->words[f->attributes.item[a]].lemma;
			const int is_colour =
				is_outside(p, f)
					? vocabulary_colour(m->vocabulary, m->arrangement, word, match)
					: vocabulary_part_colour(m->vocabulary, m->arrangement, word, match);
			for (size_t o = 0; o < objects_of(m) && is_colour; o++) {
				value[o] *= PART_COLOUR_LEAST + (1 - PART_COLOUR_LEAST) * match[o];
				there[o] *= c->negated
						    ? 1
						    : PART_COLOUR_THERE + (1 - PART_COLOUR_THERE) * match[o];
			}
		}
	}
}

/* How far objects are of the colour of a word, and of those right after it that are colours too: "salmon
 * pink" and "black and white" are either. Nothing where the word before it has done so. */
static void judge_colour(struct meaning *m, int phrase, int word)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *match = m->scratch + n;

	if (colour_before(p, word) >= 0)
		return;
	const double leasts[] = {COLOUR_LEAST, OTHER_COLOUR_LEAST, PART_COLOUR_LEAST};
	const enum coloured of = coloured_by(p, &p->phrases[phrase], word);
	const double least = leasts[of];
	double *value = meaning_add_part(m, phrase, MEANING_COLOUR, word), *there = there_of(m, phrase);
	memset(value, 0, n * sizeof *value);
	m->vocabulary->of_several = p->phrases[phrase].count != PARSE_ONE;
	if (is_blue_green(p, word)) {
		vocabulary_colour(m->vocabulary, m->arrangement, "teal", match);
		memcpy(value, match, n * sizeof *value);
	}
	for (; word >= 0; word = colour_after(p, word)) {
		if (of == OF_PART)
			vocabulary_part_colour(m->vocabulary, m->arrangement, p->words[word].lemma, match);
		else
			vocabulary_colour(m->vocabulary, m->arrangement, p->words[word].lemma, match);
		for (size_t o = 0; o < n; o++)
			value[o] = fmax(value[o], match[o]);
	}
	m->vocabulary->of_several = 0;
	for (size_t o = 0; o < n; o++) {
		value[o] = least + (1 - least) * value[o];
		there[o] *= value[o];
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

/* Whether a phrase, or a word like "one" where the phrase has no words, comes after some words. */
static int is_after(const struct parse *p, const struct parse_phrase *f, struct parse_span words)
{
	static const char *const again[] = {"one", "ones", "other", "others", "another", NULL};

	for (int w = 0; w < p->word_count && f->span.begin == f->span.end; w++)
		if (p->words[w].span.begin >= words.end && meaning_word_is(&p->words[w], again))
			return 1;
	return words.begin < f->span.begin;
}

/* "Two plates there ... the one that is near": the word of several things that were spoken of before and
 * found no place, where something is called so; or -1. */
static int kind_left_over(struct meaning *m, const struct parse_phrase *target)
{
	const struct parse *p = m->sentence->parse;
	double *match = m->scratch + objects_of(m);

	for (int k = p->unexplained.n - 1; k >= 0; k--) {
		const struct parse_word *w = &p->words[p->unexplained.item[k]];
		if (!is_after(p, target, w->span) || !strcmp(w->text, w->lemma))
			continue;
		vocabulary_noun(m->vocabulary, m->sentence, p->unexplained.item[k], match);
		if (largest(match, objects_of(m)) >= KIND_SPOKEN_OF)
			return p->unexplained.item[k];
	}
	return -1;
}

/* "Not the orange plate, the other one": the word of the kind that was spoken of before, or -1. is_alike: it
 * is of that colour too, as in "not the left orange plate, the other one". */
static int kind_before(struct meaning *m, const struct parse_phrase *target, int *is_alike)
{
	const struct parse *p = m->sentence->parse;

	*is_alike = 1;
	for (int k = 0; k < target->except.n; k++) {
		const struct parse_phrase *f = &p->phrases[target->except.item[k]];
		if (!is_after(p, target, f->span))
			continue;
		*is_alike = f->clauses.n > 0;
		return meaning_head_of(p, f);
	}
	return kind_left_over(m, target);
}

/* Whether a word that nothing is called by is said of something: "striped" of "neither purple nor striped".
 */
static int is_said_of_something(struct meaning *m, int word, double *match)
{
	struct wordnet_adjective adjective;

	wordnet_find_adjective(&adjective, m->sentence->parse->words[word].lemma);
	if (!adjective.n)
		return 0;
	vocabulary_attribute(m->vocabulary, m->sentence, word, match);
	return largest(match, objects_of(m)) > ATTRIBUTE_SAID;
}

/* "The white gadget": a thing whose name is not said, and few of what is called so somewhere is called so
 * here. */
static int is_vague(const struct parse_word *w)
{
	static const char *const vague[] = {"apparatus", "article", "beauty", "belonging", "bit", "bloke",
		"buddy", "bugger", "candidate", "chap", "character", "contraption", "critter", "customer",
		"doobry", "doodad", "doodah", "doofer", "doohickey", "entity", "exhibit", "fella", "fellow",
		"gadget", "gismo", "gizmo", "gubbins", "guy", "implement", "lad", "mate", "number",
		"possession", "prop", "specimen", "sucker", "thingamabob", "thingamajig", "thingie",
		"thingumabob", "thingumajig", "thingummy", "whatchamacallit", "whatnot", "whatsit", "widget",
		"wotsit", NULL};

	return meaning_word_is(w, vague);
}

/* "The white pebble" is a case: a shape in place of a name, where nothing here is called so. "A power strip"
 * and "a sheet of paper" are names. */
static int is_shape(const struct parse *p, const struct parse_phrase *f, int head)
{
	static const char *const shapes[] = {"blob", "bulge", "bump", "bundle", "capsule", "chunk", "clump",
		"dollop", "dome", "heap", "hump", "hunk", "lozenge", "lump", "mound", "nub", "nugget",
		"oblong", "oval", "patch", "pebble", "pill", "pod", "rectangle", "sheet", "shell", "slab",
		"sliver", "square", "strip", "stub", "tablet", "wad", "wedge", NULL};
	static const char *const of[] = {"of", NULL};

	return f->noun.n == 1 && meaning_word_is(&p->words[head], shapes) && !parse_word_is(p, head + 1, of);
}

void meaning_judge_noun(struct meaning *m, int phrase)
{
	const struct parse *p = m->sentence->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = objects_of(m);
	int head = meaning_head_of(p, f), is_alike = 0;
	double *value, *there = there_of(m, phrase), *match = m->scratch + n;

	if (head < 0 && is_elliptic(p, f))
		head = phrase ? meaning_head_of(p, &p->phrases[0]) : kind_before(m, f, &is_alike);
	for (size_t o = 0; o < n; o++)
		there[o] = GENERIC_THERE;
	m->known[phrase] = GENERIC_THERE;
	if (head < 0)
		return;
	vocabulary_noun(m->vocabulary, m->sentence, head, match);
	const int is_any = is_vague(&p->words[head]) || (is_shape(p, f, head) && largest(match, n) < 0.5);
	for (size_t o = 0; o < n && is_any; o++)
		match[o] = fmax(match[o], VAGUE_LEAST);
	if (colour_word(p->words[head].lemma) >= 0 && largest(match, n) < 0.5) { /* "something orange" */
		judge_colour(m, phrase, head);
		return;
	}
	if (largest(match, n) < 0.5 && is_said_of_something(m, head, m->scratch + 8 * n)) {
		meaning_judge_attribute(m, phrase, head, ATTRIBUTE_LEAST);
		return;
	}
	value = meaning_add_part(m, phrase, MEANING_NOUN, head);
	const double best = fmax(0, largest(match, n)), most = fmax(best, match[n]);
	/* of several things each has to be called so as well as another is */
	const double power = f->count == PARSE_ONE || is_any ? 0 : NOUN_SEVERAL;
	m->known[phrase] = best;
	for (size_t o = 0; o < n; o++) {
		const double x = match[o] * pow(match[o] / fmax(most, 1e-9), power);
		value[o] = NOUN_LEAST + (1 - NOUN_LEAST) * x * x / fmax(most, 1e-9);
		/* another thing that is called so speaks against it */
		there[o] = match[o] * pow(match[o] / fmax(best, 1e-9), NOUN_ELSEWHERE) *
			   (most > best ? best / most : 1);
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
	if (is_alike && head > 0 && colour_word(p->words[head - 1].lemma) >= 0)
		judge_colour(m, phrase, head - 1);
}

/* "bright", "dark" or "light" before a colour is of the colour. */
static int is_shade(const struct parse *p, int word)
{
	static const char *const shades[] = {
		"bright", "dark", "light", "pale", "deep", "vivid", "soft", "royal", "pure", "jet", NULL};

	return word + 1 < p->word_count && meaning_word_is(&p->words[word], shades) &&
	       colour_word(p->words[word + 1].lemma) >= 0;
}

/* The look that a word is of, where what Gaussians show of it counts; -1: none. */
static int look_of(const struct meaning *m, int word)
{
	return m->has_surfaces ? finish_of(m->sentence->parse->words[word].lemma) : -1;
}

/* What the Gaussians show of a look, where sentences do not say it. */
static void add_seen(const struct meaning *m, int word, double *match)
{
	const int finish = look_of(m, word);

	for (size_t o = 0; o < objects_of(m) && finish >= 0 && m->naming == 1; o++) {
		const double seen = surface_fits(&m->arrangement->objects[o].surface, finish);
		if (fabs(match[o]) < 1)
			match[o] = fmax(-1, fmin(1, match[o] + SURFACE_WORTH * seen));
	}
}

/* The same as a part of its own, where it is in doubt whose Gaussians they are. */
static void judge_surface(struct meaning *m, int phrase, int word)
{
	const int finish = look_of(m, word);

	if (finish < 0 || m->naming == 1)
		return;
	double *value = meaning_add_part(m, phrase, MEANING_SURFACE, word);
	for (size_t o = 0; o < objects_of(m); o++)
		value[o] = pow(SURFACE_UNLIKE,
			0.5 - 0.5 * surface_fits(&m->arrangement->objects[o].surface, finish));
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

void meaning_judge_attribute(struct meaning *m, int phrase, int word, double least)
{
	const size_t n = objects_of(m);

	if (is_shade(m->sentence->parse, word))
		return;
	if (colour_word(m->sentence->parse->words[word].lemma) >= 0) {
		judge_colour(m, phrase, word);
		return;
	}
	double *value = meaning_add_part(m, phrase, MEANING_ATTRIBUTE, word), *there = there_of(m, phrase);
	vocabulary_attribute(m->vocabulary, m->sentence, word, value);
	share_looks(m, value);
	add_seen(m, word, value);
	const double most = fmax(0, largest(value, n)), gone = look_of(m, word) < 0 ? 0 : LOOK_THERE;
	m->unknown += most < 0.5;
	for (size_t o = 0; o < n; o++) {
		there[o] *= 1 + gone * fmin(0, value[o]);
		value[o] = (value[o] < 0 ? least * (1 + (1 - OPPOSITE) * value[o])
					 : least + (1 - least) * value[o]) /
			   (least + (1 - least) * most);
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
	judge_surface(m, phrase, word);
}

/* A part that is, or fits, no object, but that training sentences may tell of: "with a handle", "on the
 * shelf". */
void meaning_judge_said(struct meaning *m, const struct parse_clause *c, double *said)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *match = m->scratch + n;

	memset(said, 0, n * sizeof *said);
	for (int k = 0; k < c->anchors.n; k++) {
		const int head = meaning_head_of(p, &p->phrases[c->anchors.item[k]]);
		if (head < 0)
			continue;
		vocabulary_clause(m->vocabulary, m->sentence, head, c->relation, match);
		for (size_t o = 0; o < n; o++)
			said[o] = fmax(said[o], match[o]);
	}
}

/* What a thing is for says what it is about: "the one you boil water in". */
static void judge_about(struct meaning *m, double *value)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *about = m->scratch + n;
	char counts[TOKENS_MOST];

	for (int w = 0; w < p->word_count; w++)
		counts[w] = (char)purpose_is_content(p, w);
	vocabulary_about(m->vocabulary, m->sentence, counts, about);
	for (size_t o = 0; o < n; o++)
		value[o] *= exp(ABOUT_WORTH * about[o]);
	const double most = fmax(largest(value, n), 1e-12);
	for (size_t o = 0; o < n; o++)
		value[o] /= most;
}

/* How far objects have what an anchor of "with a lid" or "with a lid on it" names. 0 where the clause or the
 * anchor is none such, or no object is said or known to have it. */
static int judge_part(struct meaning *m, const struct parse_clause *c, int anchor, double *match)
{
	const struct parse *p = m->sentence->parse;

	if (anchor < 0 || (c->relation != PARSE_WITH && c->relation != PARSE_SUPPORTS))
		return 0;
	vocabulary_has(
		m->vocabulary, m->sentence, meaning_head_of(p, &p->phrases[c->anchors.item[anchor]]), match);
	return largest(match, objects_of(m)) >= 0.5;
}

/* What a thing does, is for, or has: any word of it may be said of an object. */
double meaning_judge_predicate(struct meaning *m, const struct parse_clause *c, double *value)
{
	const struct parse *p = m->sentence->parse;
	const size_t n = objects_of(m);
	double *match = m->scratch + n, *use = m->scratch + 8 * n;
	int words = 0;

	for (size_t o = 0; o < n; o++)
		value[o] = 0;
	for (int k = 0; k < c->words.n + c->anchors.n; k++) {
		const int word = k < c->words.n
					 ? c->words.item[k]
					 : meaning_head_of(p, &p->phrases[c->anchors.item[k - c->words.n]]);
		if (word < 0)
			continue;
		memset(use, 0, n * sizeof *use);
		if (!judge_part(m, c, k - c->words.n, match) &&
			!vocabulary_colour(m->vocabulary, m->arrangement, p->words[word].lemma, match)) {
			vocabulary_attribute(m->vocabulary, m->sentence, word, match);
			add_seen(m, word, match);
			vocabulary_use(m->vocabulary, m->sentence, word, use);
		}
		for (size_t o = 0; o < n; o++)
			value[o] += fmax(fmax(match[o], USE_WORTH * use[o]), 0);
		words++;
	}
	const double most = fmax(0, largest(value, n));
	m->unknown += words && most < 0.5;
	for (size_t o = 0; o < n; o++) /* of what is denied nothing has to be so */
		value[o] = !words	? 1
			   : c->negated ? fmin(value[o], 1)
					: (PREDICATE_LEAST + value[o]) / (PREDICATE_LEAST + most);
	if (words && c->relation == PARSE_OTHER)
		judge_about(m, value);
	return most;
}
