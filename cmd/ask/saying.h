/* Sentences that a scene can write of itself, to teach a trained field by: refer-say. What the training
 * sentences call each thing and say of it is put together anew, with relations in gs-synth's training
 * wording, and kept where the lifted choice is sure which thing that means. */
#pragma once

#include "cmd/ask/asking.h"

struct saying_options {
	long long each;	  /* sentences of a thing */
	long long absent; /* of what is not there */
	uint64_t seed;
	double least; /* how sure the choice has to be */
	const char *output;
};

/* Writes the sentences (formats/records/sentences.md). *short_of: how many there are too few of, where a
 * thing can hardly be told. Returns 0, or -1 with *e set. */
int say(struct asking *a, const struct saying_options *o, const struct report *to, size_t *short_of,
	struct err *e);
