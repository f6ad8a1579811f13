/* The learnt parser: what each word is, what it hangs on, and which relation it says, from the encoder's word
 * vectors and its closed-class word.
 *
 *   h0 = relu(Wv x + b + E[closed] + E[pause])
 *   s  = [lstm of h0 from the first word on, lstm from the last word back]      (nn/lstm.h)
 *   h  = h0 + relu(D s + d)
 *   roles, relations, negation: linear in h
 *   arc(i,j) = (A h_i + a) . (B h_j + b) / sqrt K + distance[j - i]
 *
 * with x the mean of the word's pieces. After Dozat and Manning (2017), "Deep biaffine attention for neural
 * dependency parsing"; ROOT is a j of its own. */
#pragma once

#include "lang/analysis.h"
#include "lang/closed.h"
#include "nn/lstm.h"

#include <stddef.h>

enum {
	NET_HIDDEN = 160,
	NET_UNITS = 112, /* of the lstm of either direction */
	NET_STATE = 2 * NET_UNITS,
	NET_ARC = 48,
	NET_DISTANCES = 17, /* -8 or less ... 8 or more */
	NET_CLOSED = CLOSED_MOST + 1,
	NET_PAUSES = 4, /* as before a word; 3: a plural */
};

/* One slab; the order is that of the file. */
struct parser_weights {
	int width;	  /* of the encoder */
	char encoder[17]; /* its fingerprint (formats/arrays/fingerprint.h); "": not known */
	size_t count;
	float *slab;
	float *vector, *vector_bias; /* (H,width), (H) */
	float *closed, *pause;	     /* (NET_CLOSED,H), (NET_PAUSES,H) */
	struct lstm ahead, back;
	float *down, *down_bias;	   /* (H,2U), (H) */
	float *out, *out_bias;		   /* (ROLES + PARSE_RELATIONS + 1, H): roles, relations, negated */
	float *dependent, *dependent_bias; /* (K,H), (K) */
	float *head, *head_bias;	   /* (K,H), (K) */
	float *root;			   /* (K) and a bias */
	float *distance;		   /* (NET_DISTANCES) */
	struct parser_weights *next;	   /* another member, learnt from another start: their scores are
					      averaged; NULL; owned */
	struct parser_weights *grammar;	   /* of the first: a network of width 0, to which a word is its
					      closed class and no more; NULL; owned */
};

/* Names and shapes of the parts, in order; columns 0: a vector. */
struct parser_part {
	const char *name;
	size_t rows, columns;
};
enum { PARSER_PARTS = 20, PARSER_MEMBERS = 8 /* at most */ };
void parser_parts(int width, struct parser_part parts[PARSER_PARTS]);

/* Zeroed. parser_weights_free frees. */
int parser_weights_make(struct parser_weights *w, int width, struct err *e);
/* The same as a new one at *to. */
int parser_weights_add(struct parser_weights **to, int width, struct err *e);
void parser_weights_free(struct parser_weights *w);

/* What is known of a word besides its vector. */
struct parser_features {
	int closed, pause;
};

/* Several sentences, one after the other. */
struct parser_batch {
	int rows, sentences, capacity;
	int *start;			  /* (sentences + 1) */
	float *x;			  /* (rows,width) */
	struct parser_features *features; /* (rows) */
	float *keep, *keep_state;	  /* (rows,H), (rows,2U): factors of dropout; NULL: none */
	float *first, *state;		  /* (rows,H), (rows,2U): h0 and s */
	float *grown, *h;		  /* (rows,H): D s + d, and h */
	struct lstm_memory ahead, back;
	float *scratch;		 /* of lstm_backward */
	float *out;		 /* (rows, ROLES + PARSE_RELATIONS + 1), the mean of the members' */
	float *own;		 /* the same of one member */
	float *dependent, *head; /* (members,capacity,K) */
};

enum { NET_OUT = ROLES + PARSE_RELATIONS + 1 };

int parser_batch_make(
	struct parser_batch *b, int capacity, int sentences, const struct parser_weights *w, struct err *e);
void parser_batch_free(struct parser_batch *b);
void parser_batch_clear(struct parser_batch *b);
/* Adds a sentence of n words: their features and vectors (n, width), means of pieces. */
void parser_batch_add(
	struct parser_batch *b, const struct parser_features *f, const float *vectors, int n, int width);

void parser_features_take(struct parser_features *f, const struct tokens *t);

void parser_forward(const struct parser_weights *w, struct parser_batch *b);

/* Scores of what word i of a sentence may hang on: scores[0] ROOT, scores[1 + j] word j (n + 1). */
void parser_arcs(
	const struct parser_weights *w, const struct parser_batch *b, int sentence, int i, float *scores);

int parser_distance(int from, int to);

/* Means of the pieces of each word: out (t->n, width); zero for a word without. */
void parser_vectors_of_words(const struct tokens *t, const float *vectors, int count, int width, float *out);

/* The best analysis that is well formed. *sure gets the mean probability of the roles. */
void parser_decode(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	const struct tokens *t, struct analysis *a, double *sure);
