/* How near a sentence's words for its target are to the training sentences' words for each object, whatever
 * they say: for sentences whose parse does not tell, as "the round tub at the door" where
 * nobody knows that a basket is a tub.
 *
 * M_wo is the best cosine of target word w with a noun or attribute of object o's training sentences, or with
 * those of one that looks the same (less WORDING_UNLIKE times how unlike they are); a word of o's name counts
 * WORDING_NAME. Then
 *   A_o = sum over w of (M_wo - max M_w.), and for a colour word WORDING_COLOUR times the difference of
 *         log(0.05 + fit)
 *   f   = WORDING_HEAD M_o of the head noun + WORDING_ALL mean over w of max M + sum over colour words of
 *         log((0.05 + fit_o) / 0.25) + WORDING_PLAIN log of o's softmax of WORDING_SHARP A
 * is how well the sentence fits its best object o. Each training sentence is fitted in the same way by the
 * others alone. p = (1 + how many of them fit no better) / (1 + R) is even for sentences about what is there,
 * however freely the scene's sentences are worded, and near 0 for others: P = 4 / (4 + p^-0.75 / 4). */
#ifndef ASK_WORDING_H
#define ASK_WORDING_H

#include "places/arrangement.h"
#include "ask/vocabulary.h"
#include "base/err.h"

struct wording {
	struct vocabulary *vocabulary;
	const struct arrangement *arrangement;
	double *known;	     /* (R) rising: f of the training sentences */
	double *match, *own; /* (O) scratch */
};

/* Refers to v and a, which must outlive it. Returns 0, or -1 with *e set; wording_free after either. */
int wording_make(struct wording *w, struct vocabulary *v, const struct arrangement *a, struct err *e);
void wording_free(struct wording *w);

/* score (O): WORDING_SHARP A. Returns P that the sentence means any of the objects; 0 where no word is of its
 * target. */
double wording_judge(struct wording *w, const struct vocabulary_sentence *s, double *score);

#endif
