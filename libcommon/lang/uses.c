#include "lang/uses.h"

#include "lang/kinds.h"
#include "lang/synsets.h"
#include "lang/things.h"
#include "lang/wordnet.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double uses_fit(const struct uses *thing, const struct uses *word)
{
	double best = 0;

	for (int i = 0; i < thing->n; i++)
		for (int k = 0; k < word->n; k++)
			if (thing->of[i].stem == word->of[k].stem)
				best = fmax(best, (double)thing->of[i].worth * (double)word->of[k].worth);
	return best;
}

enum { LONGEST = 24 };

static int ends(const char *w, size_t n, const char *tail)
{
	const size_t m = strlen(tail);

	return n > m + 2 && !strcmp(w + n - m, tail);
}

/* "drinking" and "drinks" become "drink", "served" and "serve" "serv", "thrown" "throw". */
static void stem(char *w)
{
	static const char *const tails[] = {"ing", "ed", "en", "es", "s"};
	size_t n = strlen(w);

	for (size_t i = 0; i < sizeof tails / sizeof *tails; i++)
		if (ends(w, n, tails[i])) {
			n -= strlen(tails[i]);
			break;
		}
	w[n] = 0;
	if (ends(w, n, "wn"))
		w[--n] = 0;
	if (n > 3 && w[n - 1] == 'e')
		w[--n] = 0;
	if (n > 3 && w[n - 1] == w[n - 2] && w[n - 1] != 's' && w[n - 1] != 'l')
		w[--n] = 0;
}

static unsigned hash(const char *w)
{
	unsigned h = 2166136261U;

	for (; *w; w++)
		h = (h ^ (unsigned char)*w) * 16777619U;
	return h;
}

/* Words of glosses that say nothing of a use. */
static int is_empty(const char *stemmed)
{
	static const char empty[] =
		" the and for with that from its are was has have any who which one two used use usual made mak "
		"mad put tak tok get got giv let can may often oft such other than into out onto off not all "
		"small larg object thing someth someth part typic consist contain various some who whom his her he "
		"she him they them their it you your what when where were been be is do does an as at by in of on "
		"or to up go com kind form shap piec set particular especial etc own keep ";
	char padded[LONGEST + 3];

	snprintf(padded, sizeof padded, " %s ", stemmed);
	return strlen(stemmed) < 3 || strstr(empty, padded) != NULL;
}

static void add(struct uses *to, const char *word, size_t length, double worth)
{
	char w[LONGEST + 1];

	if (length > LONGEST || to->n == USES_STEMS)
		return;
	for (size_t i = 0; i < length; i++)
		w[i] = (char)tolower((unsigned char)word[i]);
	w[length] = 0;
	stem(w);
	if (is_empty(w))
		return;
	const unsigned h = hash(w);
	for (int i = 0; i < to->n; i++)
		if (to->of[i].stem == h) {
			to->of[i].worth = fmaxf(to->of[i].worth, (float)worth);
			return;
		}
	to->of[to->n].stem = h;
	to->of[to->n++].worth = (float)worth;
}

static void add_text(struct uses *to, const char *text, size_t length, double worth)
{
	for (size_t i = 0, n; i < length; i += n ? n : 1) {
		for (n = 0; i + n < length && isalpha((unsigned char)text[i + n]);)
			n++;
		if (n)
			add(to, text + i, n, worth);
	}
}

static void add_known(struct uses *to, const char *lemma, enum things_field field)
{
	struct things_rows rows;
	size_t length;

	things_find(&rows, lemma);
	for (int i = 0; i < rows.n; i++) {
		const char *text = things_text(rows.row[i], field, &length);
		add_text(to, text, length, 1);
	}
}

void uses_parts(struct uses *to, const char *lemma)
{
	to->n = 0;
	add_known(to, lemma, THINGS_HAS);
}

void uses_word(struct uses *to, const char *lemma)
{
	to->n = 0;
	add(to, lemma, strlen(lemma), 1);
}

#ifdef HAVE_WORDNET

enum { SENSES = 8, STEPS_OF_THING = 2, STEPS_OF_WORD = 4, COMMON_SENSES = 4, STEPS_TO_TOP = 12 };
static const double per_step = 0.9, per_sense = 0.93;

/* What a synset says, and what it is a kind of: glosses, or its own words. Returns whether an artifact is
 * above it. */
static int climb(struct uses *to, long synset, int pos, int is_gloss, int steps, double worth)
{
	int is_made = 0, at = 0;
	long up;
	SynsetPtr s = synsets_read(pos, synset);

	if (!s)
		return 0;
	for (int i = 0; i < s->wcount; i++)
		is_made |= !strcmp(s->words[i], "artifact");
	if (steps >= 0 && is_gloss && s->defn)
		add_text(to, s->defn, strlen(s->defn), worth);
	for (int i = 0; i < s->wcount && steps >= 0 && !is_gloss; i++)
		add(to, s->words[i], strlen(s->words[i]), worth);
	while ((is_gloss || steps > 0) && steps > -12 && synsets_next_up(s, pos, &at, &up))
		is_made |= climb(to, up, pos, is_gloss, steps - 1, worth * per_step);
	free_synset(s);
	return is_made;
}

/* Whether a synset is of what can be touched. */
static int is_touched(long synset, int steps)
{
	static const char *const kinds[] = {"artifact", "animal", "plant", "food"};
	int is = 0, at = 0;
	long up;
	SynsetPtr s = synsets_read(NOUN, synset);

	for (int i = 0; s && i < s->wcount; i++)
		for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
			is |= !strcmp(s->words[i], kinds[k]);
	while (s && !is && steps && synsets_next_up(s, NOUN, &at, &up))
		is = is_touched(up, steps - 1);
	if (s)
		free_synset(s);
	return is;
}

static int is_touchable(const char *lemma)
{
	long senses[COMMON_SENSES];
	int is = 0;
	const int n = synsets_of(lemma, NOUN, senses, COMMON_SENSES);

	for (int i = 0; i < n && !is; i++)
		is = is_touched(senses[i], STEPS_TO_TOP);
	return is;
}

void uses_of_thing(struct uses *to, const char *lemma)
{
	long senses[SENSES];
	const int n = synsets_of(lemma, NOUN, senses, SENSES);

	to->n = 0;
	add_known(to, lemma, THINGS_USES);
	for (int i = 0; i < n; i++) {
		struct uses own = *to;
		if (climb(&own, senses[i], NOUN, 1, STEPS_OF_THING, pow(per_sense, i)))
			*to = own;
	}
}

void uses_of_word(struct uses *to, const char *lemma)
{
	static const int pos[] = {NOUN, VERB};
	long senses[3];

	to->n = 0;
	add(to, lemma, strlen(lemma), 1);
	if (!wordnet_is_there())
		return;
	for (int k = 0; k < 2 && to->n; k++) {
		const int n = synsets_of(lemma, pos[k], senses, 3);
		for (int i = 0; i < n; i++)
			climb(to, senses[i], pos[k], 0, pos[k] == VERB ? 1 : STEPS_OF_WORD,
				pow(per_sense, i));
	}
}
#else
static int is_touchable(const char *lemma)
{
	(void)lemma;
	return 1;
}

void uses_of_thing(struct uses *to, const char *lemma)
{
	to->n = 0;
	add_known(to, lemma, THINGS_USES);
}

void uses_of_word(struct uses *to, const char *lemma)
{
	to->n = 0;
	add(to, lemma, strlen(lemma), 1);
}
#endif

int uses_names_thing(const char *lemma)
{
	struct things_rows rows;

	things_find(&rows, lemma);
	return rows.n || kinds_have(lemma) || !wordnet_is_there() || is_touchable(lemma);
}
