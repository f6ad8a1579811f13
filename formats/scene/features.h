/* features.safetensors (refer.features): what pictures say of each Gaussian, features or labels.
 * formats/scene/features.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"

#include <stdint.h>

/* Memory is taken for as many labels as the largest one says. */
enum { FEATURES_MAX_CHANNELS = 65536, FEATURES_MAX_LABEL = (1 << 24) - 1 };

struct features {
	size_t gaussians, channels; /* channels: 0 where there are labels in place of features */
	const void *values;	    /* (N,C) float32 or, with is_half, half floats */
	int is_half;
	const int32_t *labels;	  /* (N), or NULL; -1: unseen */
	const float *reliability; /* (N) in [0,1] */
	const float *weight;	  /* (N) sum of blend weights; 0: unseen */
	struct fingerprint scene;
	struct safetensors file; /* of one that was read: keeps the map alive */
};

/* Maps and checks a file. Returns 0, or -1 with *e set; features_close after either. */
int features_open(struct features *f, const char *path, struct err *e);
void features_close(struct features *f);

/* out (n,C): the features from Gaussian `first` on. */
void features_floats(const struct features *f, size_t first, size_t n, float *out);

int features_write(const struct features *f, const char *path, const char *options, struct err *e);
