/* The masks that a training learns from, and with them its views. formats/scene/training.md. */
#ifndef CMD_TRAIN_TRAINING_MASKS_H
#define CMD_TRAIN_TRAINING_MASKS_H

#include "cmd/train/training.h"

/* Fills t->masks and, of the training views that they name, in the order in which they do, t->views,
 * t->weights and t->cameras. The scene has been read. Returns 0, or -1 with *e set. */
int training_read_masks(
	struct training *t, const char *weights, const char *path, const struct report *to, struct err *e);

#endif
