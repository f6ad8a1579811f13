/* The words by which training sentences call each lifted object and say where it is; how words match them. */
#pragma once

#include "places/arrangement.h"
#include "base/err.h"
#include "lang/parser.h"
#include "lang/naming.h"
#include "lang/things_vectors.h"
#include "lang/parts.h"
#include "lift/lifted_model.h"

/* A sentence and what is known of it. */
struct vocabulary_sentence {
	const struct parse *parse;
	const float *vectors; /* (pieces, width) */
	size_t pieces;
};

enum vocabulary_role {
	VOCABULARY_NOUN,      /* what the object is called */
	VOCABULARY_ATTRIBUTE, /* what is said of it */
	VOCABULARY_ANCHOR,    /* a noun that a clause of it names: what it is near, on, with */
	VOCABULARY_OTHER      /* other words of its clauses */
};

struct vocabulary_item {
	enum vocabulary_role role;
	size_t object, sentence;
	const char *lemma;
	enum parse_relation relation; /* of VOCABULARY_ANCHOR: the clause's */
	size_t kind;		      /* into kinds */
	int is_of_name;		      /* of the object's noun: "earbud" and "case" */
	int is_general; /* a noun that is above another one of the same object: "container" of a bowl */
};

/* What is known of a lemma. */
struct vocabulary_kind {
	const char *lemma;
	struct naming naming;
	int finish;	    /* finish_of */
	int is_thing;	    /* something here is called so */
	struct parts parts; /* found when they are first asked for; n < 0 before */
};

struct vocabulary {
	const struct lifted *lifted;
	struct parse *parses;  /* (R) of the training sentences */
	double *mean;	       /* (width) of all word pieces of the training sentences */
	double *sentence_mean; /* (width) of the sentences' means */
	size_t n, capacity;
	struct vocabulary_item *items;
	float *vectors;	  /* (n,width) of length 1: the items' words, less the mean */
	float *sentences; /* (R,width) of length 1: means of the sentences, less sentence_mean */
	size_t kind_count, kind_capacity;
	struct vocabulary_kind *kinds; /* of different lemmas */
	char **heads;	    /* (O) the last word of an object's name that is no number, lower case */
	size_t *head_kinds; /* (O) into kinds */
	char **wholes; /* (O) the longest end of a name of two words or more that is known, "mouse pad"; or ""
			*/
	size_t *whole_kinds; /* (O) into kinds */
	char **contents; /* (O) the word before it, where it is a container: of an "eraser box"; else "" */
	size_t *content_kinds;	      /* (O) into kinds */
	int has_names, has_knowledge; /* whether names, and WordNet with lang/kinds.h and things.h, count: 1,
					 for the caller to set */
	int has_said;	 /* whether colours and relations that training sentences give an object count: 1,
			    likewise */
	int of_several;	 /* whether a noun or colour is asked of each of several things: 0, for the caller to
			    set */
	double *scratch; /* (width) */
	float *about;	 /* (O,width) of length 1: of each object's nouns */
	float *word;	 /* (width) */
	char *kin; /* (O,O) what makes two objects one kind: 2 a noun that is not general, 1 their names */
	double *other; /* (O) */
	struct things_vectors things;
	/* Object o is lines line_begin[o] to line_begin[o + 1] of the table, those from line_named[o] on by
	 * its name alone. */
	int *lines;
	size_t *line_begin, *line_named; /* (O+1) */
	size_t line_count, line_capacity;
	float *cosine; /* (things.lines) of the sentence that was asked last */
};

/* Refers to l, which must outlive it. Returns 0, or -1 with *e set; vocabulary_free after either. */
int vocabulary_make(struct vocabulary *v, const struct lifted *l, const struct parser *parser, struct err *e);
void vocabulary_free(struct vocabulary *v);

/* match (O): how likely an object is called by word w of a sentence, in [0,1]: 1 where its name or a training
 * sentence calls it so; what WordNet and lang/kinds.h think of the two nouns; what their cosine is worth. */
void vocabulary_noun(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match);

/* Whether a word is, by WordNet, of a kind of things that an object's name is one of: "container" of a box.
 */
int vocabulary_is_above(const struct vocabulary *v, const char *lemma, size_t object);

/* Whether an object is, by its name, a piece of furniture. */
int vocabulary_is_furniture(const struct vocabulary *v, size_t object);

/* match (O): how far an object is said to be what a word says, as an attribute or in any other way, in [0,1];
 * below 0, to -1, where it is said to be the opposite. */
void vocabulary_attribute(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match);

/* match (O) in [0,1]: that a training sentence says that the object has what word w names, a screen of the
 * laptop; with a place also where it is so, on the shelf, and less in another. PARSE_OTHER: no place. */
void vocabulary_has(struct vocabulary *v, const struct vocabulary_sentence *s, int w,
	enum parse_relation place, double *match);

/* match (O) in [0,1]: that an object is said to be at what word w names: near it, on it, under it; by a
 * training sentence, or by its name, as a "kitchen-side chair" is at the kitchen. */
void vocabulary_at(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match);

/* match (O): the cosine of the mean of a sentence's words that count (a char of each word) with the nouns
 * that training sentences call an object by, 0 where there is none: what the sentence is about. */
void vocabulary_about(
	struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts, double *match);

/* What the mean of a sentence's words that count is for: match (O) the best cosine with the uses of what an
 * object is, or by `about` (O, of vocabulary_about) where nothing is known of that; *any the soft maximum
 * over all everyday things. Returns 0 where the encoder is not the one that made lang/things_vectors.h. */
int vocabulary_for(struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts,
	const double *about, double *match, double *any);

/* fit (O): how far an object is of the colour of a word, in [0,1], by its Gaussians and by the colours that
 * training sentences say it has. Returns 0 where it is no colour word. */
int vocabulary_colour(struct vocabulary *v, const struct arrangement *a, const char *word, double *fit);

/* The same of any part of an object. */
int vocabulary_part_colour(
	const struct vocabulary *v, const struct arrangement *a, const char *word, double *fit);

/* match (O): the best cosine of the mean of a sentence's pieces with that of an object's training sentences,
 * -1 where it has none. Returns the object of the training sentence of the same text, or O; text may be NULL.
 */
size_t vocabulary_whole(
	struct vocabulary *v, const char *text, const float *vectors, size_t pieces, double *match);
