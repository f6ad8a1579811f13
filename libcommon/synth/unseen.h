/* Sentences in a wording of their own, for testing what takes sentences apart: another generator than
 * synth/synth_sentences.c, whose words, frames and ways of turning a sentence round are kept apart from it.
 *
 * A sentence is first made as a parse (phrases and clauses as in lang/parse.h), then judged on the scene's
 * geometry, then put into words. What is kept means the same objects to anybody by a margin, and its parse
 * and its objects are exact. */
#ifndef SYNTH_UNSEEN_H
#define SYNTH_UNSEEN_H

#include "base/err.h"
#include "geom/camera.h"
#include "lang/parse.h"
#include "synth/objects.h"

#include <stdint.h>

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

enum { SYNTH_UNSEEN_PHRASES = 10, SYNTH_UNSEEN_CLAUSES = 8, SYNTH_UNSEEN_LIST = 3, SYNTH_UNSEEN_TEXT = 320 };

/* What the words of a phrase leave possible: bits of surely, and of surely or arguably. */
struct synth_unseen_sense {
	unsigned shapes, colours, sizes, finishes;
	unsigned maybe_shapes, maybe_colours, maybe_sizes;
};

/* As struct parse_phrase, with the words themselves and without spans. */
struct synth_unseen_phrase {
	const char *noun; /* singular; "" where the sentence says "one" */
	const char *plural;
	const char *words[SYNTH_UNSEEN_LIST]; /* attributes but for the colour */
	const char *colour;		      /* NULL: none */
	const char *size;		      /* "small"; NULL: none. A parse has it as a clause */
	int word_count, clause_count, except_count, also_count;
	int clauses[SYNTH_UNSEEN_LIST], except[SYNTH_UNSEEN_LIST], also[SYNTH_UNSEEN_LIST];
	int count, group, ordinal;
	enum parse_relation from;
	int viewer;
	int of_several;	 /* "of all the cups, the ..." */
	int is_anything; /* as an anchor: whatever there is */
	struct synth_unseen_sense sense;
};

/* As struct parse_clause. */
struct synth_unseen_clause {
	enum parse_relation relation;
	enum parse_degree degree;
	int negated;
	int anchor_count, anchors[2];
	int word_count;
	const char *words[2];
	unsigned does, may_do; /* of PARSE_OTHER: shapes that do this, and may be thought to */
	const char *text;      /* its wording */
	char form;	       /* of the wording: synth/unseen_frames.h */
};

struct synth_unseen {
	enum synth_unseen_kind kind;
	int view;	  /* the camera whose picture it is said of; -1: the reference viewpoint */
	uint64_t objects; /* those that it means, a bit each */
	char ref[32];
	char text[SYNTH_UNSEEN_TEXT];
	int phrase_count, clause_count;
	struct synth_unseen_phrase phrases[SYNTH_UNSEEN_PHRASES]; /* the first is the target */
	struct synth_unseen_clause clauses[SYNTH_UNSEEN_CLAUSES];
};

struct synth_unseen_list {
	int n, capacity;
	struct synth_unseen *items; /* owned */
};

/* As many of each kind as the scene gives, at most about the number of its objects; view-dependent ones in
 * pairs of pictures with different answers. Its random numbers are its own. Returns 0, or -1 with *e (memory)
 * and nothing to free. */
int synth_unseen_make(struct synth_unseen_list *list, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, uint64_t seed, struct err *e);
void synth_unseen_free(struct synth_unseen_list *list);

/* "plain", "chatty", "two-hop" ... */
const char *synth_unseen_kind_name(enum synth_unseen_kind k);

#endif
