/* Sentences that each mean one object of the scene, as people would write them: attributes with synonyms, and
 * relations true from the reference viewpoint. */
#ifndef SYNTH_SYNTH_SENTENCES_H
#define SYNTH_SYNTH_SENTENCES_H

#include "synth/sentence.h"

enum {
	SYNTH_TRAIN_SENTENCES = 4,
	SYNTH_SENTENCES = 5, /* an object; the last is for testing */
	SYNTH_MIN_WORDS = 7,
	SYNTH_MAX_WORDS = 22,
};

/* Items (n objects, SYNTH_SENTENCES), of 13.6 words on average, with objects for a and b of their relations.
 * A test sentence has a frame and wordings of relations that no training sentence has, and no pair of colour
 * word and noun that a training sentence of its object has. Returns 0, or -1 with *e set (ERR_CHECK) where
 * some object cannot be told apart in words; another seed then helps. After either *list may be freed. */
int synth_sentences_make(
	struct synth_sentences *list, const struct synth_viewpoint *v, uint64_t seed, struct err *e);

int synth_count_words(const char *text);

#endif
