/* Scoring: predictions against truth, as mIoU, overall IoU and precision. */
#pragma once

#include "mask/mask.h"

#include <stddef.h>

struct score_pair {
	const char *object;	       /* of the truth, else of the prediction, else the truth's ref */
	const char *ref;	       /* of the prediction; NULL where it has none */
	const struct mask *prediction; /* NULL: no prediction for this truth */
	const struct mask *truth;
	size_t truth_index; /* among the truth that was matched */
	size_t place;	    /* in the order of matching */
	/* filled by score_measure */
	size_t intersection, either; /* |prediction and truth|, |prediction or truth| */
	double iou;
	int is_empty;		   /* nothing in the truth */
	int is_in_box, is_in_mask; /* the prediction's peak is in the truth's; 0 where it has none */
	/* filled by score_choices (score/score_choice.h) */
	int is_right; /* it shows its own object more than any other */
};

struct score_pairs {
	size_t n, capacity;
	struct score_pair *items; /* owned */
	size_t unlabelled;	  /* predictions of views without any truth: left out */
	size_t unmatched;	  /* predictions of labelled views that no truth belongs to: left out */
};

struct score {
	size_t pairs;	     /* with something in the truth: those that the figures are of */
	size_t empty_truth;  /* left out of the figures */
	size_t missing;	     /* among the pairs: without a prediction, IoU 0 */
	double miou;	     /* mean IoU */
	double oiou;	     /* sum of intersections / sum of unions */
	double precision[3]; /* share of pairs with IoU >= score_cut[i] */
	double right;	     /* share of pairs that show the right object */
	/* Localisation accuracy: the share of pairs whose peak is in a box of the truth, and in its mask. Of
	 * use where predictions have peaks at all. */
	size_t peaks; /* pairs that have one */
	double in_box, in_mask;
};
extern const double score_cut[3]; /* 0.25, 0.5, 0.75 */

/* Pairs predictions with truth (neither with duplicates):
 *  - a prediction with a ref: the truth of that view and ref; else that of the view and object, one without
 * ref first;
 *  - a prediction without ref: every truth of that view and object, but for those that a prediction's ref
 * names;
 *  - a truth that no prediction met: a pair without a prediction.
 * In that order, and each in the order given. score_pairs_free after a failure too. */
int score_match(struct score_pairs *pairs, const struct mask *truth, size_t truth_n,
	const struct mask *predictions, size_t prediction_n, struct err *e);
void score_pairs_free(struct score_pairs *pairs);

/* Fills a pair's numbers. A prediction of another size is brought to the truth's by rle_resize. */
int score_measure(struct score_pair *pair, struct err *e);
int score_measure_all(struct score_pairs *pairs, struct err *e);

/* Leaves out truth of views that neither list has a mask of: it comes behind the others, and *n becomes the
 * number of those, in order. */
int score_keep_views(struct mask *truth, size_t *n, const struct mask *predictions, size_t prediction_n,
	const struct mask *others, size_t other_n, struct err *e);

/* By object name, then by place: the pairs of an object then lie side by side. */
void score_sort(struct score_pair *pairs, size_t n);

/* The figures of n measured pairs; all 0 where none has anything in its truth. */
void score_sum(struct score *s, const struct score_pair *pairs, size_t n);

/* Two prediction files against one truth: pairs of the one beside pairs of the other. */

/* Brings the pairs of two predictions with the same truth (score_match of the same array) side by side: after
 * it both lists have the same n, and the items of an index are of the same truth and sentence. The sentences
 * of a truth are those whose refs the predictions of either side have; a side without a prediction for one
 * has its mask without ref there, else none (IoU 0). Masks without ref are a pair of their own where both
 * sides have one, or where neither has a ref. The order is that of a; what only b names comes last. Where
 * both sides have the same refs nothing else changes.
 *
 * To be called before score_measure and score_sort; object and place become the same on both sides. On
 * failure both lists are as they were. */
int score_join(struct score_pairs *a, struct score_pairs *b, struct err *e);
