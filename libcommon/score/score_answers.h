/* Scoring answers to sentences that may mean one object, several or none: which objects a mask shows, as F1,
 * and whether nothing is answered where nothing is meant. As Multi3DRefer scores (Zhang, Gong, Chang, ICCV
 * 2023), but for masks in views; and the figures of GRES (Liu, Ding, Jiang, CVPR 2023). See scores.md. */
#pragma once

#include "score/score.h"

enum { ANSWER_CUTS = 2 };
extern const double answer_cut[ANSWER_CUTS]; /* 0.25, 0.5 */

/* Strings are the caller's. */
struct answer_sentence {
	const char *ref;
	const char *kind; /* may be NULL */
	const char *view; /* the only view where it is scored; NULL: every one, or those of `views` */
	size_t object_count, view_count;
	char *const *objects; /* that it means */
	char *const *views;
	const double
		*when; /* from, to: it means them then, and nothing in views of other times; NULL: always */
};

/* A sentence in a view that shows something of what it means, or of a sentence that means nothing. */
struct answer {
	const struct answer_sentence *sentence;
	const char *view;
	int is_outside; /* the view's time is not that of the sentence: such an answer only counts for
			   accuracy */
	int is_missing; /* there is no prediction */
	int is_refused; /* its mask is empty */
	int is_right;	/* one: its IoU with the object's mask is above 0 and no less than with another's;
			   several:   those it shows are those that are meant; none: refused */
	double iou;	/* with the union of the meant objects' masks; 1 for a refused none, else 0 */
	size_t intersection,
		either; /* |prediction and union|, |prediction or union|; of a none 0 and |prediction| */
	double f1[ANSWER_CUTS]; /* of the objects of which it covers more than the share */
};

struct answers {
	size_t n, capacity;
	struct answer *items; /* owned; by sentence, then by view in byte order */
	size_t out_of_sight;  /* pairs with nothing of what is meant to be seen: left out */
	size_t unknown;	      /* sentences that mean an object that the truth nowhere has */
	size_t unmatched;     /* predictions of no sentence's ref: left out */
};

/* Truth and predictions are without duplicates; a truth's object is what it goes by, its ref does not count.
 * A prediction is found by its ref. Sizes may differ, as for score_measure. Release with answers_free. */
int answers_make(struct answers *a, const struct answer_sentence *sentences, size_t n,
	const struct mask *truth, size_t truth_n, const struct mask *predictions, size_t prediction_n,
	struct err *e);
void answers_free(struct answers *a);

/* Of some answers. The figures are means over them; 0 where there are none. */
struct answer_score {
	size_t pairs, missing;
	double right, miou, refused, f1[ANSWER_CUTS];
	double oiou; /* sum of intersections / sum of unions; 1 where all are empty */
	/* Of the sentences that have a time, as 4D LangSplat (Li et al., CVPR 2025) scores: over a sentence's
	 * views the share in which it is answered or refused as its time says; over the views that are of its
	 * time or answered the sum of the IoU in those that are both (viou), and their share (tiou). Means
	 * over the sentences. */
	size_t timed;
	double accuracy, viou, tiou;
};

enum answer_targets { ANSWER_ANY, ANSWER_ONE, ANSWER_SEVERAL, ANSWER_NONE, ANSWER_TARGETS };

/* Those that mean so many objects and, where kind is not NULL, are of that kind (NULL kinds go as ""). */
void answer_score_sum(
	struct answer_score *s, const struct answers *a, enum answer_targets targets, const char *kind);

/* The figures that GRES has for targets: of the sentences that mean nothing the share that is refused
 * (N-acc), and of all others the share that is answered at all (T-acc). Each is NAN where there are none. */
void answer_target_accuracy(double *none, double *some, const struct answers *a);
