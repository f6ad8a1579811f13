/* Which object a sentence means: a score of every lifted object for every sentence, from parts that can be
 * left out one by one. */
#ifndef REFER_CHOOSE_H
#define REFER_CHOOSE_H

#include "base/err.h"
#include "geom/camera.h"
#include "refer/lifted.h"
#include "splat/splats.h"

enum choose_part {
	CHOOSE_SENTENCE, /* the sentence as a whole against an object's training sentences */
	CHOOSE_PARTS
};
enum { CHOOSE_ALL = (1 << CHOOSE_PARTS) - 1 };

struct choose_sentence {
	const char *pieces;   /* word pieces with single spaces between, or NULL where they are not known */
	const float *vectors; /* (words, the model's width) */
	size_t words;
};

struct choose_scene {
	const struct lifted *lifted;
	const struct splats *splats;
	const struct cameras *cameras; /* relations are as seen by the training views among them */
};

/* probability (n,O): each row sums to at most 1; what is missing is the probability that the sentence means
 * nothing that was lifted. parts: a bit 1 << part for each part that counts. Returns 0, or -1 with *e set. */
int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	float *probability, struct err *e);

#endif
