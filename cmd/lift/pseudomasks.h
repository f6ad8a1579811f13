/* The masks of objects, out of the candidates that a detector found for their sentences: pseudomask-select.
 * formats/records/masks.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/records/masks.h"
#include "formats/scene/scene.h"
#include "lift/propagate.h"
#include "lift/regions.h"
#include "mask/pool.h"
#include "mask/select.h"

#include <stdio.h>

/* The methods that look at the scene, beside those of enum select_method. */
enum { PSEUDOMASK_FIRST = SELECT_TOP1 + 1, PSEUDOMASK_SCENE };

struct pseudomask_options {
	int method;
	double min_score;	     /* candidates with no more are left out */
	const char *candidates;	     /* file of masks; "-" is stdin */
	const char *scene, *weights; /* for PSEUDOMASK_FIRST and _SCENE */
	const char *spare;	     /* of PSEUDOMASK_SCENE: file for the spare regions; NULL: none */
};

struct pseudomasks {
	const struct pseudomask_options *options;
	FILE *out, *spare;
	size_t seen, left_out, masks, rendered; /* views, and masks in them */
	struct masks set;
	long *lines; /* (set.n) of the file */
	struct pool pool;
	struct scene scene;
	size_t *views;			/* (set.n) of the scene */
	struct propagation propagation; /* of PSEUDOMASK_FIRST */
	struct regions regions;		/* of PSEUDOMASK_SCENE */
};

/* Reads the candidates, selects, and writes the masks to a file ("-": stdout). *w is zeroed before. Returns
 * 0, or -1 with *e set; after either pseudomasks_free is in order. */
int pseudomasks_write(struct pseudomasks *w, const struct pseudomask_options *options, const char *path,
	const struct report *to, struct err *e);
void pseudomasks_free(struct pseudomasks *w);
