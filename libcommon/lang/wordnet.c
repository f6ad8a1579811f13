#include "lang/wordnet.h"

#include "base/hash.h"
#include "lang/synsets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef HAVE_WORDNET
#include "base/mapped_stream.h"

#include <unistd.h>
#include <wn.h>

enum { DEEPEST = 10, THINGS = 4 };
/* What a sense counts that those texts do not have, how much less each rarer one, and what cannot be seen. */
static const double UNSEEN = 0.5, RARER = 0.8, NO_THING = 0.1;

/* A question about a scene looks up thousands of words, each by some twenty seeks. */
static void map_files(void)
{
	static char buffers[NUMPARTS + 1][2][MAPPED_STREAM_BUFFER];

	for (int pos = 1; pos <= NUMPARTS; pos++) {
		mapped_stream_take(&indexfps[pos], buffers[pos][0]);
		mapped_stream_take(&datafps[pos], buffers[pos][1]);
	}
}

int wordnet_is_there(void)
{
	static int is_open = -1;

	if (is_open < 0) {
		const char *folder = getenv("WNSEARCHDIR");
		/* libwordnet complains aloud of what is not there */
		is_open = !access(folder ? folder : "/usr/share/wordnet", R_OK) && !wninit();
		if (is_open)
			map_files();
	}
	return is_open;
}

/* Adds a synset and what it is a kind of. */
static void climb(struct wordnet_noun *to, long synset, int depth, int sense)
{
	long up[SYNSETS_UP];

	if (to->n == WORDNET_UP || depth > DEEPEST)
		return;
	to->up[to->n].synset = synset;
	to->up[to->n].depth = (short)depth;
	to->up[to->n++].sense = (short)sense;
	const int n = synsets_up(synset, up);
	for (int i = 0; i < n; i++)
		climb(to, up[i], depth + 1, sense);
}

/* Whether a sense of a noun is a kind of a synset. */
static int is_kind_of(const struct wordnet_noun *noun, int sense, long synset)
{
	for (int i = 0; i < noun->n; i++)
		if (noun->up[i].sense == sense && noun->up[i].synset == synset)
			return 1;
	return 0;
}

/* Whether a sense is of what can be on a table. */
static int is_thing(const struct wordnet_noun *noun, int sense)
{
	static const char *const tops[THINGS] = {"artifact", "animal", "plant", "food"};
	static long top[THINGS];

	for (int i = 0; i < THINGS; i++) {
		long senses[2];
		if (!top[i]) {
			const int n = synsets_of(tops[i], NOUN, senses, 2);
			top[i] = senses[n > 1 && i == 2]; /* a plant is a factory first */
		}
		if (is_kind_of(noun, sense, top[i]))
			return 1;
	}
	return 0;
}

/* How often a sense was meant in the texts that WordNet's makers have read, where it is of a thing. */
static void weigh(struct wordnet_noun *to, const char *lemma, int senses)
{
	double all = 0, chance[WORDNET_SENSES] = {0};
	int counts[WORDNET_SENSES];

	synsets_counts(lemma, NOUN, counts, senses);
	for (int i = 0; i < senses; i++) {
		chance[i] = (counts[i] + UNSEEN * pow(RARER, i)) * (is_thing(to, i) ? 1 : NO_THING);
		all += chance[i];
	}
	for (int i = 0; i < WORDNET_SENSES; i++)
		to->chance[i] = senses ? (float)(chance[i] / all) : 0;
}

static void find(struct wordnet_noun *to, const char *lemma)
{
	long senses[WORDNET_SENSES];
	const int n = synsets_of(lemma, NOUN, senses, WORDNET_SENSES);

	to->n = 0;
	for (int i = 0; i < n; i++)
		climb(to, senses[i], 0, i);
	weigh(to, lemma, n);
}

/* Sentences of a scene say the same words again and again: the last noun of each hash is kept. */
void wordnet_find(struct wordnet_noun *to, const char *lemma)
{
	static struct {
		char lemma[64]; /* "": none yet */
		struct wordnet_noun noun;
	} kept[256];
	const size_t length = strlen(lemma), at = hash64(lemma, length, 0) % 256;

	if (!length || length >= sizeof kept[at].lemma) {
		find(to, lemma);
		return;
	}
	if (strcmp(kept[at].lemma, lemma) != 0) {
		find(&kept[at].noun, lemma);
		memcpy(kept[at].lemma, lemma, length + 1);
	}
	*to = kept[at].noun;
}

void wordnet_find_thing(struct wordnet_noun *to, const char *lemma)
{
	static long made, food;
	float all = 0, chance[WORDNET_SENSES];

	wordnet_find(to, lemma);
	if ((!made && !synsets_of("artifact", NOUN, &made, 1)) ||
		(!food && !synsets_of("food", NOUN, &food, 1)))
		return;
	const int is_made = is_kind_of(to, 0, made);
	for (int i = 0; i < WORDNET_SENSES; i++) {
		chance[i] = is_thing(to, i) && !(is_made && is_kind_of(to, i, food)) ? to->chance[i] : 0;
		all += chance[i];
	}
	for (int i = 0; i < WORDNET_SENSES && all > 0; i++)
		to->chance[i] = chance[i] / all;
}

int wordnet_is_noun(const char *lemma)
{
	long sense;

	return synsets_of(lemma, NOUN, &sense, 1) > 0;
}

int wordnet_is_adjective(const char *lemma)
{
	long sense;

	return synsets_of(lemma, ADJ, &sense, 1) > 0;
}

int wordnet_is_verb(const char *lemma)
{
	long sense;

	return synsets_of(lemma, VERB, &sense, 1) > 0;
}
#else
int wordnet_is_adjective(const char *lemma)
{
	(void)lemma;
	return 0;
}

int wordnet_is_verb(const char *lemma)
{
	(void)lemma;
	return 0;
}

int wordnet_is_there(void)
{
	return 0;
}

void wordnet_find(struct wordnet_noun *to, const char *lemma)
{
	(void)lemma;
	to->n = 0;
}

void wordnet_find_thing(struct wordnet_noun *to, const char *lemma)
{
	wordnet_find(to, lemma);
}

int wordnet_is_noun(const char *lemma)
{
	(void)lemma;
	return 0;
}
#endif

/* A step up, and a rarer sense of the word that asks, each make it so much less likely. */
static const double per_step_up = 0.96, per_sense = 0.9;
enum { STEPS_UP = 9 };

double wordnet_fits(const struct wordnet_noun *word, const struct wordnet_noun *known)
{
	double best[WORDNET_SENSES] = {0}, sum = 0;

	for (int i = 0; i < word->n; i++)
		for (int k = 0; k < known->n && !word->up[i].depth; k++)
			if (word->up[i].synset == known->up[k].synset && known->up[k].depth <= STEPS_UP)
				best[known->up[k].sense] = fmax(
					best[known->up[k].sense], pow(per_step_up, known->up[k].depth) *
									  pow(per_sense, word->up[i].sense));
	for (int k = 0; k < WORDNET_SENSES; k++)
		sum += (double)known->chance[k] * best[k];
	return sum;
}

int wordnet_is_above(const struct wordnet_noun *above, const struct wordnet_noun *word)
{
	for (int i = 0; i < above->n; i++)
		for (int k = 0; k < word->n; k++)
			if (!above->up[i].depth && word->up[k].depth &&
				above->up[i].synset == word->up[k].synset)
				return 1;
	return 0;
}
