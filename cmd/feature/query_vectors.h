/* Vectors of texts, as any encoder makes them: rows of a file. formats/scene/selection.md. */
#ifndef CMD_FEATURE_QUERY_VECTORS_H
#define CMD_FEATURE_QUERY_VECTORS_H

#include "base/err.h"
#include "formats/scene/text.h"

#include <stddef.h>

struct query_vectors {
	size_t n, channels;
	float *values; /* (n,channels), brought to length 1; owned */
};

/* The vectors of the sentences in a file of text-encode, else of the one two-dimensional tensor of floats in
 * a safetensors file, or those of a .npy file, or of the array vectors, else arr_0, of a .npz file.
 * ERR_FORMAT where there are other than `channels` of them for each. Returns 0, or -1 with *e set and nothing
 * to free. */
int query_vectors_read(struct query_vectors *v, const char *path, size_t channels, struct err *e);
/* The same of the sentences of a text that was read from a path. */
int query_vectors_of_text(
	struct query_vectors *v, const struct text *text, const char *path, size_t channels, struct err *e);
void query_vectors_free(struct query_vectors *v);

#endif
