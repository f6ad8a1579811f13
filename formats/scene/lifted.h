/* model.safetensors (refer.lifted): objects lifted onto the Gaussians. formats/scene/lifted.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"
#include "lift/lifted_model.h"

/* ERR_FORMAT where the file is malformed. *origin gets the scene and the encoder that it was made with. */
int lifted_read(struct lifted *l, struct origin *origin, const char *path, struct err *e);
/* The same of a file that is open. */
int lifted_take(struct lifted *l, struct origin *origin, const struct safetensors *st, struct err *e);
/* Shares are kept to 1/255, words as float16. ERR_CHECK where a number is not finite, or too large. */
int lifted_write(const struct lifted *l, const struct origin *origin, const char *path, const char *options,
	struct err *e);
