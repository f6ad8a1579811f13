/* Held-out supervision: pairs of a view and an object that are not learned from, and how well they are
 * answered all the same, which says when to stop. */
#pragma once

#include "base/err.h"
#include "train/step.h"
#include "train/train.h"
#include "train/view_source.h"

/* Holds out a share of all pairs of a view and an object, at least one and not all: `seed` decides which. In
 * each view their sentences and masks move behind those that are learned from (train_view's held).
 * objects (sentences) has the object of each sentence. ERR_FORMAT, without a file name, where there are
 * fewer than two pairs. */
int held_out_choose(struct train_view *views, size_t view_count, const int *objects, size_t sentences,
	double share, uint64_t seed, struct err *e);

/* Means over the held-out pairs of a view and a sentence. */
struct held_out_score {
	double bce; /* step_losses's */
	double iou; /* of the mask and where the response is above 0; 1 where neither has a pixel */
};

/* Room for scoring. What the views' source refers to stays, with weights over rows. */
struct held_out {
	struct view_source views;
	size_t rows, pairs;
	size_t *order, count;	   /* sentences that have held-out masks, those of an object together */
	float *response, *grouped; /* (rows), (rows,VIEW_GROUP) */
	size_t pixels;
	int threads;
	float *images;		       /* (threads,VIEW_GROUP,pixels) */
	uint8_t *masks;		       /* (threads,pixels) */
	struct held_out_score *scores; /* (views.n) sums of a view's pairs */
};

int held_out_init(struct held_out *h, const struct view_source *views, const int *objects, size_t sentences,
	size_t rows, struct err *e);
void held_out_free(struct held_out *h);

/* Scores what the step answers with these parameters and features. Returns 0, or -1 with *e set where a view
 * cannot be read. */
int held_out_evaluate(struct held_out *h, struct step *s, const float *parameters, const float *x,
	struct held_out_score *score, struct err *e);
