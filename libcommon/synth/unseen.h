/* Sentences in a wording of their own, for testing what takes sentences apart: words, frames and ways of
 * turning a sentence round are kept apart from those of synth/sentence.h. What is kept means the same
 * objects to anybody by a margin, and its parse and its objects are exact. */
#pragma once

#include "synth/sentence.h"

enum synth_unseen_kind {
	SYNTH_UNSEEN_PLAIN,
	SYNTH_UNSEEN_CHATTY,
	SYNTH_UNSEEN_TWO_HOP,
	SYNTH_UNSEEN_NEGATION,
	SYNTH_UNSEEN_ORDINAL,
	SYNTH_UNSEEN_COMPARATIVE,
	SYNTH_UNSEEN_SEVERAL,
	SYNTH_UNSEEN_FUNCTION,
	SYNTH_UNSEEN_VIEW,
	SYNTH_UNSEEN_ABSENT,
	SYNTH_UNSEEN_KINDS
};

/* As many of each kind as the scene gives, at most about the number of its objects; view-dependent ones in
 * pairs of pictures with different answers. Its random numbers are its own. Returns 0, or -1 with *e set
 * (memory); after either *list may be freed. */
int synth_unseen_make(struct synth_sentences *list, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, uint64_t seed, struct err *e);

/* "plain", "chatty", "two-hop" ... */
const char *synth_unseen_kind_name(int kind);

/* An unseen sentence in the making: random phrases and clauses, to be judged and put into words. */
struct synth_draft {
	const struct synth_wordings *w;
	const struct synth_viewpoint *v;
	struct rng *rng;
	enum synth_list build;	 /* of frames */
	struct synth_sentence s; /* about its object */
	const char *frame;
};

/* A random sentence of the build and a frame for it; -1 where one does not fit the other. Whether it means
 * one thing, or its object, is not said. two_hop: an anchor has a clause. */
int synth_unseen_build(struct synth_draft *d, int two_hop);

/* The same of something that is not there. */
int synth_unseen_build_absent(struct synth_draft *d);
