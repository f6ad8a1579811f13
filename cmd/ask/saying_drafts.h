/* Random sentences about the things of a lifted scene, in gs-synth's training wording: likely true, as the
 * lifted choice was asked of which things each relation holds. */
#pragma once

#include "cmd/ask/saying_facts.h"
#include "cmd/ask/saying_parts.h"

enum { SAYING_LENGTH = 256 };

/* A sentence in the making. */
struct draft {
	char text[SAYING_LENGTH];
	size_t n;
};

struct drafter {
	size_t objects;
	struct saying_parts parts;
	struct synth_wordings wordings;
	struct facts facts;
	char *fits;	/* (objects) what a draft may mean so far */
	uint32_t nouns; /* of lang/kinds.h */
	struct rng rng;
};

/* Of an asking of one object or more. Returns 0, or -1 with *e set; drafter_free after either. */
int drafter_make(struct drafter *d, struct asking *a, uint64_t seed, struct err *e);
void drafter_free(struct drafter *d);

/* A sentence that names the object or tells where it is, what it is not, or the how manieth of its kind; of
 * the number of objects: of something that is not here. */
void drafter_draw(struct drafter *d, size_t object, struct draft *to);
