/* What words of colour say of each object, or of a part of it. */
#include "ask/constants.h"
#include "ask/judge_words.h"
#include "lang/colours.h"

#include <string.h>

/* The colour that a colour goes on with, as "black and white" and "salmon pink" do, or -1. */
static int colour_after(const struct parse *p, int word)
{
	const int next = parse_word_is(p, word + 1, "and|or") ? word + 2 : word + 1;

	return next < p->word_count && colour_word(p->words[next].lemma) >= 0 ? next : -1;
}

static int colour_before(const struct parse *p, int word)
{
	for (int i = word - 2 > 0 ? word - 2 : 0; i < word; i++)
		if (colour_word(p->words[i].lemma) >= 0 && colour_after(p, i) == word)
			return i;
	return -1;
}

/* What a colour is of that a phrase has after another one: "the brown cup with white stripes". */
enum coloured { OF_THING, OF_PART_PERHAPS, OF_PART };

static enum coloured coloured_by(const struct parse *p, const struct parse_phrase *f, int word)
{
	enum coloured of = OF_THING;

	for (int i = word - 1; i >= 0; i--) {
		if (parse_list_has(&f->attributes, i)) {
			if (of != OF_THING && colour_word(p->words[i].lemma) >= 0)
				return of;
		} else if (of != OF_PART) {
			of = meaning_word_is(&p->words[i], "with|w|having") ? OF_PART : OF_PART_PERHAPS;
		}
	}
	return OF_THING;
}

/* "With a yellow scarf": a colour that nothing here has or is said to have. */
void judge_part_colours(struct meaning *m, int phrase, const struct parse_clause *c, double *value)
{
	const struct parse *p = m->sentence->parse;
	double *match = m->scratch + objects_of(m), *there = there_of(m, phrase);

	for (int k = 0; k < c->anchors.n; k++) {
		const struct parse_phrase *f = &p->phrases[c->anchors.item[k]];
		const int counts = m->known[c->anchors.item[k]] < 0.5;
		for (int a = 0; a < f->attributes.n && counts; a++) {
			const char *word = p->words[f->attributes.item[a]].lemma;
			const int is_colour =
				vocabulary_part_colour(m->vocabulary, m->arrangement, word, match);
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
void judge_colour(struct meaning *m, int phrase, int word)
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
	meaning_take_part(m);
}
