/* Training checkpoints (refer.checkpoint): everything that continues a training to the same bytes. formats/checkpoint.md. */
#ifndef FORMATS_CHECKPOINT_H
#define FORMATS_CHECKPOINT_H

#include "base/err.h"
#include "refer/train.h"

/* Writes the state whole, so that a kill at any time leaves the old or the new file. `identity` says what is trained: the
 * options and checksums of the inputs. */
int checkpoint_write(const struct train_state *t, const char *path, const char *identity, struct err *e);

/* Fills a state of the same sizes. ERR_FORMAT where the file's identity is another. */
int checkpoint_read(struct train_state *t, const char *path, const char *identity, struct err *e);

#endif
