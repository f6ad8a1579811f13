/* selection.safetensors (refer.selection): the Gaussians that each sentence selects.
 * formats/scene/selection.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"

#include <stdint.h>

struct selection {
	size_t gaussians, n; /* N of the scene, R sentences */
	char **refs;	     /* (n) different */
	int64_t *indptr; /* (n+1): sentence r has the Gaussians index[indptr[r]] to index[indptr[r+1] - 1] */
	int32_t *index;	 /* rising within a sentence */
	struct fingerprint scene;
};

/* The selection of a file that is open; of its own memory. 0, or -1 with *e and nothing to free. */
int selection_take(struct selection *s, const struct safetensors *st, struct err *e);
int selection_read(struct selection *s, const char *path, struct err *e);
void selection_free(struct selection *s);

int selection_write(const struct selection *s, const char *path, const char *options, struct err *e);
