/* What refer-train reads, put together: scene, weights, text and masks, checked against each other.
 * formats/scene/training.md. */
#ifndef CMD_TRAIN_TRAINING_H
#define CMD_TRAIN_TRAINING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/train/training_views.h"
#include "formats/scene/checkpoint.h"
#include "formats/arrays/precision.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "train/supervision.h"
#include "train/trainer.h"

struct training {
	struct scene scene;
	struct text text;
	size_t sentences;		   /* R training sentences with words, packed from text */
	size_t left_out;		   /* training sentences without words */
	int64_t *offsets;		   /* (R+1) */
	float *words;			   /* (offsets[R], text.width) */
	int *objects;			   /* (R) numbers of the objects */
	const char **refs, **object_names; /* (R) owned by text */
	struct training_views views;	   /* training views that have masks */
	struct supervision masks;
	size_t test_masks;    /* masks of test views, not used */
	size_t pairs;	      /* (view, sentence) pairs to learn from */
	size_t held;	      /* those that are held out */
	struct lifted lifted; /* for a warm start; else empty */
	uint32_t checksum;    /* of everything that training depends on but its options */
};

/* What to read, and what to hold out of it. */
struct training_files {
	const char *scene, *weights, *text, *masks;
	const char *lifted; /* NULL: no warm start */
};

int training_read(struct training *t, const struct training_files *from, double hold_out, uint64_t seed,
	const struct report *to, struct err *e);
/* What a checkpoint of it is of. */
struct checkpoint_of training_identity(
	const struct training *t, const struct training_files *from, const struct trainer_options *o);
/* What a trainer learns from; referred to. */
struct trainer_source training_source(struct training *t, const struct row_views_room *room);
void training_free(struct training *t);

/* Writes the model that was learned. *options: how, but for the number of steps and the precision. */
int training_write(const struct training *t, const struct trainer *learned, enum refer_similarity similarity,
	enum precision precision, const char *path, const char *options, long long seed, struct err *e);

#endif
