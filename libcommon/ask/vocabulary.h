/* The words by which training sentences call each lifted object, and how other words match them. */
#ifndef ASK_VOCABULARY_H
#define ASK_VOCABULARY_H

#include "base/err.h"
#include "lang/sentence.h"
#include "ask/arrangement.h"
#include "refer/lifted.h"

struct vocabulary {
	const struct lifted *lifted;
	double *mean;	       /* (width) of all word pieces of the training sentences */
	double *sentence_mean; /* (width) of the sentences' means */
	size_t n;
	float *vectors;	  /* (n,width) of length 1: target words of the training sentences, less the mean */
	size_t *begin;	  /* (O+1) words begin[o] to begin[o+1] are of object o */
	size_t *of;	  /* (n) the sentence that each is of */
	float *sentences; /* (R,width) of length 1: means of the sentences, less sentence_mean */
	size_t without;	  /* the training sentence whose words do not count, for the caller to set; R: none */
	double *scratch, *own; /* (width), (O) */
};

/* Refers to l, which must outlive it. Returns 0, or -1 with *e set; vocabulary_free after either. */
int vocabulary_make(struct vocabulary *v, const struct lifted *l, struct err *e);
void vocabulary_free(struct vocabulary *v);

/* match (O): the best cosine of a word, whose sentence has these vectors of pieces, with an object's words
 * (where `words`; 0 where it has none), or VOCABULARY_NAME where it is a word of the object's name (where
 * `names`). With `alike`, objects that look the same share theirs. */
#define VOCABULARY_NAME 0.95
#define VOCABULARY_UNLIKE 0.07
void vocabulary_match(struct vocabulary *v, const struct lang_word *w, const float *vectors, int words,
	int names, const struct arrangement *alike, double *match);

/* fit (O): the share of an object's colours that a colour word fits, in [0,1]. 0 where it is no colour word.
 */
int vocabulary_colour(const struct arrangement *a, const struct lang_word *w, double *fit);

/* fit (O) at most 0: how well an object's size fits a word as "small", "medium" or "large", from -1/2 of the
 * square of how far log bulk is from one deviation below, at, or above the objects' mean, in units of 1.5. 0
 * where it is no such word. */
int vocabulary_size(const struct arrangement *a, const struct lang_word *w, double *fit);

/* match (O): the best cosine of the mean of a sentence's pieces with that of an object's training sentences,
 * -1 where it has none. Returns the object of the training sentence of the same pieces, or O. */
size_t vocabulary_sentence(
	struct vocabulary *v, const char *pieces, const float *vectors, size_t words, double *match);

#endif
