/* model.safetensors (refer.lifted): objects lifted onto the Gaussians. formats/lifted.md. */
#ifndef FORMATS_LIFTED_H
#define FORMATS_LIFTED_H

#include "base/err.h"
#include "formats/safetensors.h"
#include "refer/lifted.h"

/* ERR_FORMAT where the file is malformed. */
int lifted_read(struct lifted *l, const char *path, struct err *e);
/* The same of a file that is open. */
int lifted_take(struct lifted *l, const struct safetensors *st, struct err *e);
/* Shares are kept to 1/255, words as float16. ERR_CHECK where a number is not finite, or too large. */
int lifted_write(const struct lifted *l, const char *path, const char *options, struct err *e);

#endif
