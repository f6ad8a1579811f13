/* One stage of training, from files to the model: reads, goes on from a checkpoint, takes the steps, logs
 * them, writes. refer-train. formats/scene/training.md. */
#ifndef CMD_TRAIN_LEARN_H
#define CMD_TRAIN_LEARN_H

#include "base/err.h"
#include "base/file.h"
#include "base/report.h"
#include "cmd/train/training.h"
#include "formats/scene/checkpoint.h"
#include "formats/arrays/precision.h"
#include "formats/records/trainlog.h"
#include "train/divergence.h"
#include "train/trainer.h"

#include <signal.h>

struct learning_options {
	struct training_files from;
	const char *output;		   /* the model; "-" is stdout */
	const char *log;		   /* NULL: none */
	const char *checkpoint_path;	   /* NULL: none */
	int is_resumed;			   /* go on from the checkpoint, if there is one */
	enum precision precision;	   /* of the model */
	long long iterations;		   /* steps */
	long long checkpoint;		   /* one every so many steps; 0: never */
	const volatile sig_atomic_t *stop; /* not 0: to be left after this step, with a checkpoint */
	long long memory;		   /* MiB for the views' weights */
	long long patience;		   /* evaluations that were no better, until it stops */
	struct trainer_options trainer;
};

struct learning {
	const struct learning_options *options;
	struct training data;
	struct trainer trainer;
	struct file_out claim; /* of the model, as long as it is learnt */
	char *scratch;	       /* where weights go that memory has no room for: row_views_room's path */
	struct trainlog log;
	struct divergence divergence;
	struct checkpoint_of of;
	int is_stopped; /* by options->stop: *e of learn says after which step */
	int is_own;	/* the checkpoint is of this training */
	char note[64];	/* the latest losses */
};

/* *l is zeroed before. Returns 0, or -1 with *e set; after either learning_free is in order. The checkpoint
 * goes when the model is written. Where it is stopped it ends with -1 and a checkpoint, unless none is wanted
 * or the loss is too high for one. */
int learn(struct learning *l, const struct learning_options *options, const struct report *to, struct err *e);
void learning_free(struct learning *l);

#endif
