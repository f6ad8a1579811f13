/* The state of an unfinished gs-train, from which it goes on to the same bytes: formats/scene/checkpoint.md.
 */
#pragma once

#include "fit/fit.h"

/* Writes it whole. identity: the options, and the checksum of the inputs. Returns 0, or -1 with *e set. */
int fitting_checkpoint_write(struct fit *f, const char *path, const char *identity, struct err *e);

/* Fills a fit that has been opened on the same input. Returns 0, or -1 with *e set: ERR_FORMAT where the file
 * is of another training. */
int fitting_checkpoint_read(struct fit *f, const char *path, const char *identity, struct err *e);
