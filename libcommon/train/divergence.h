/* Whether a training has diverged, as it does where its rates are too high: a loss or a parameter that is not
 * finite, or losses that stay far above those of a model that says nothing. */
#pragma once

#include "base/err.h"
#include "train/train.h"

enum {
	DIVERGENCE_WINDOW = 100, /* steps over which the cross-entropy is averaged; train_state.sum's */
	DIVERGENCE_WINDOWS = 10, /* so many bad ones in a row end the training */
	DIVERGENCE_AT_END = 2,	 /* so many are too many at its end */
};

/* A window is bad where its mean cross-entropy is above this. An answer of 0 everywhere has ln 2 = 0.69. On
 * gs-synth scenes the worst window, the first one, has 0.2 to 4.5, whatever the interaction and with feature
 * rates of 0.0025 to 10; an MLP rate of 0.01 has single windows of 86 and ends at 0.11; 0.1 has 5e6 and does
 * not end below 13. */
#define DIVERGENCE_LIMIT 14.0

struct divergence {
	const struct refer_layout *layout; /* names the array at fault; NULL: it is not named */
	int windows; /* bad ones in a row, the latest included; those cut short by the end do not count */
	long begin;  /* steps before the first of these */
};

/* To be called after every step, while train_state.sum still has its window. 0, or -1 with *e, ERR_CHECK
 * without a file name: the training has diverged, with the step, and
 * the array that is not finite or, where only the loss is not, the one with the largest value. */
int divergence_check(struct divergence *d, const struct train_state *t, const struct step_losses *last,
	int is_end, struct err *e);

/* 1 where the state is good as far as one can tell, so that a checkpoint may replace an earlier one. */
int divergence_is_good(const struct divergence *d, const struct train_state *t);
