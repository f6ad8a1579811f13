/* Sentences with their analyses, to learn a parser from: wordings written for this project, multiplied by a
 * generator. Wordings for learning and for testing are disjoint: those of EXAMPLES_TEST have templates,
 * requests and nouns of their own; adjectives are shared. */
#ifndef LANG_EXAMPLES_H
#define LANG_EXAMPLES_H

#include "base/rng.h"
#include "lang/analysis.h"

enum examples_set { EXAMPLES_TRAIN, EXAMPLES_TEST };

enum { EXAMPLE_LENGTH = 1024 };

/* One sentence. Its words are those that tokens_take makes of the text. The same state of the generator gives
 * the same sentence. */
struct example {
	char text[EXAMPLE_LENGTH];
	struct tokens tokens;
	struct analysis analysis;
};

/* `pieces` of the sentence that will come out, where the encoder was asked before; NULL. */
void example_make(struct example *x, enum examples_set set, const char *pieces, struct rng *r);

/* clang-format off */
/* The wordings, in examples_words.c, examples_sentences.c, examples_talk.c and examples_words_test.c. A template is
 * words with a blank between; "a|b" is a choice, "_" a blank within one.
 *
 * In clauses:
 *   *w  the main word of the predicate
 *   @   a phrase that it has as anchor; 0 one without clauses; % one of the target's noun
 *   $   "with", "that has"
 *   ^   "sitting", "placed" or nothing; ~ "just", "directly" or nothing
 *
 * In whole sentences:
 *   T   the target with its clauses; N without; n its noun again, or "one"; L several of its noun
 *   U   a target of no noun ("the one") with its clauses; Q "the red one" that is meant
 *   S   a further target; O a further "red one"; X what is left out; V what is faced or stood at
 *   C   a clause as after "is"; C2 one that is denied; H one with "has"; W one with "with"
 *   A   a size or place adjective; q a word of its look
 *   F   what a thing is for ("to write with"), all predicates of PARSE_OTHER
 *   G   a question turned round after the noun: "is @ next to"
 *   B   an anchor that a later word points back to: D "near it", P "between them" for two, R where one goes from it
 *       ("start at the box, go left")
 *   ,.? punctuation */
/* clang-format on */
struct example_clause {
	enum parse_relation relation;
	int negated;
	const char *text;
};
struct example_list {
	int n;
	const char *const *item;
};
struct example_clauses {
	int n;
	const struct example_clause *item;
};
/* What is said around a target: "computer , find" T ", you ca n't miss it". */
struct example_talk {
	struct example_list before, after, core;
	struct example_list subjects, deeds, tails, links, requests; /* of a story that comes first */
};
struct example_wordings {
	struct example_clauses placed;	    /* after a noun, "that is" or "it is" */
	struct example_clauses having;	    /* after $ in its place, or "has" */
	struct example_clauses turned;	    /* after a noun as a relative clause: "that @ is on" */
	struct example_clauses back;	    /* of what was spoken of: "near it" */
	struct example_clauses back_to_two; /* of two things spoken of: "between them" */
	struct example_clauses travelled;   /* on the way from what was spoken of: "go left" */
	struct example_clauses inverted;    /* after "which noun": "is @ standing next to" */
	struct example_clauses before;	    /* adjectives that place or size: "left", "smallest" */
	const struct example_list *sentences, *functions;
	const struct example_talk *talk; /* NULL: none */
};
extern const struct example_wordings example_wordings_train, example_wordings_test;

/* In examples_sentences.c. */
extern const struct example_list example_sentences, example_functions;
/* In examples_talk.c. */
extern const struct example_talk example_talk;
/* In examples_nouns.c. */
extern const struct example_list example_nouns[2], example_attributes, example_hues, example_stuffs;

#endif
