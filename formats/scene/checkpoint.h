/* Training checkpoints (refer.checkpoint): everything that continues a training to the same bytes.
 * formats/scene/checkpoint.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "train/trainer.h"

enum { CHECKPOINT_IDENTITY = 640 };

/* What must be the same for a training to be gone on with. */
struct checkpoint_of {
	char identity[CHECKPOINT_IDENTITY]; /* its options and the checksum of its inputs */
	struct origin origin;
	const char *scene_path, *text_path; /* for messages */
};

void checkpoint_identity(char text[CHECKPOINT_IDENTITY], const struct trainer_options *o, uint32_t inputs);

/* MODEL.checkpoint, where a training of MODEL leaves its state; free() it. NULL with *e. */
char *checkpoint_path(const char *model, struct err *e);

/* Writes the state whole, so that a kill at any time leaves the old or the new file. */
int checkpoint_write(
	const struct train_state *t, const char *path, const struct checkpoint_of *of, struct err *e);

/* Fills a state of the same sizes; after an error its arrays may be half filled. ERR_FORMAT where the file
 * is of another training. */
int checkpoint_read(struct train_state *t, const char *path, const struct checkpoint_of *of, struct err *e);

/* The same; ERR_FORMAT also where it has more steps than `most`. */
int checkpoint_resume(struct train_state *t, const char *path, const struct checkpoint_of *of, long long most,
	struct err *e);
