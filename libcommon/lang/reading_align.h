/* Someone else's readings of sentences: which noun is meant and how it stands to which others, but not which
 * words say so. reading_align finds the words, so that a parser can learn from them. */
#ifndef LANG_READING_ALIGN_H
#define LANG_READING_ALIGN_H

#include "lang/parser_net.h"

enum { READING_CLAUSES = 24, READING_ANCHORS = 24 };

struct reading {
	char target[TOKEN_LENGTH]; /* lemma of the last word */
	int clause_count, anchor_count;
	struct {
		unsigned relations; /* bit r: enum parse_relation r may be meant; 0: one that has no name here
				     */
		int negated, figure; /* an anchor, or ROOT */
	} clause[READING_CLAUSES];
	struct {
		char noun[TOKEN_LENGTH];
		int clause;
	} anchor[READING_ANCHORS];
};

/* The relations that a reading's word for one may stand for: 0 for an unknown word. */
unsigned reading_relations(const char *name);

/* The likeliest analysis by these weights that says what the reading says. Words of which it cannot be told
 * what they should be get the role ROLES. b holds parser_forward's results. */
void reading_align(const struct reading *r, const struct parser_weights *w, const struct parser_batch *b,
	int sentence, const struct tokens *t, struct analysis *a);

#endif
