/* Sentences that each mean one object of the scene, as people would write them: attributes with synonyms, and
 * relations true from the reference viewpoint. */
#ifndef SYNTH_SYNTH_SENTENCES_H
#define SYNTH_SYNTH_SENTENCES_H

#include "base/err.h"
#include "geom/camera.h"
#include "synth/relations.h"

#include <stdint.h>

enum {
	SYNTH_TRAIN_SENTENCES = 4,
	SYNTH_SENTENCES = 5, /* an object; the last is for testing */
	SYNTH_MIN_WORDS = 7,
	SYNTH_MAX_WORDS = 22,
	SYNTH_CLAUSES = 3,
};

struct synth_sentence {
	int object;
	enum camera_split split;
	char ref[SYNTH_NAME + 12]; /* "red-mug-1" */
	char text[256];
	/* What the text says, for checking it. */
	struct synth_meaning meaning;
	int clause_count;
	struct synth_clause clauses[SYNTH_CLAUSES];
};

/* sentences (n objects, SYNTH_SENTENCES), of 13.6 words on average. A test sentence has a frame and wordings
 * of relations that no training sentence has, and no pair of colour word and noun that a training sentence of
 * its object has. Returns 0, or -1 with *e set (ERR_CHECK) where some object cannot be told apart in words;
 * another seed then helps. */
int synth_sentences_make(
	struct synth_sentence *sentences, const struct synth_layout *l, uint64_t seed, struct err *e);

/* As synth_clause_judge, for the whole sentence. */
int synth_sentence_judge(const struct synth_sentence *s, const struct synth_layout *l, int i);

#endif
