/* model.safetensors (refer.lifted): objects lifted onto the Gaussians. formats/scene/lifted.md. */
#ifndef FORMATS_LIFTED_H
#define FORMATS_LIFTED_H

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"
#include "formats/scene/text.h"
#include "lift/lifted_model.h"

#define LIFTED_NONE ((size_t)-1)

/* ERR_FORMAT where the file is malformed. *origin gets the scene and the encoder that it was made with. */
int lifted_read(struct lifted *l, struct origin *origin, const char *path, struct err *e);
/* The same of a file that is open. */
int lifted_take(struct lifted *l, struct origin *origin, const struct safetensors *st, struct err *e);
/* Shares are kept to 1/255, words as float16. ERR_CHECK where a number is not finite, or too large. */
int lifted_write(const struct lifted *l, const struct origin *origin, const char *path, const char *options,
	struct err *e);

/* Gives lifted objects their names, and the sentences of a text with pieces: object (t->n) has the one that
 * each names, or LIFTED_NONE where it stays out. Copies. 0, or -1 with *e and *l as it can be freed. */
int lifted_add_sentences(struct lifted *l, const struct text *t, const size_t *object,
	const char *const *names, struct err *e);

#endif
