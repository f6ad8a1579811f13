/* model.safetensors (refer.model): a trained referring model. formats/scene/model.md. */
#pragma once

#include "base/err.h"
#include "field/referring_model.h"
#include "field/rows.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/precision.h"
#include "formats/arrays/safetensors.h"

#include <stdint.h>

struct model {
	struct refer_layout layout;
	enum refer_similarity similarity;
	enum refer_query query;
	enum refer_blend blend;
	enum precision precision; /* of features and weights in the file; here they are float32 */
	size_t scene_gaussians;	  /* N of the scene that it belongs to */
	size_t n;		  /* M rows of features */
	int has_leaves;		  /* a row is of a leaf, or of one Gaussian */
	size_t learning;	  /* Gaussians that have a row; M without leaves */
	int32_t *ids; /* (learning) these, rising indices in the scene; NULL: all that lie in a leaf */
	struct octree octree;	/* of M leaves */
	float *features;	/* (M, layout.feature_width) */
	float *parameters;	/* (layout.count) */
	struct origin origin;	/* the scene and the encoder that it was made with */
	double low[3], high[3]; /* what the scene's means are scaled to [-1,1] by */
};

/* ERR_FORMAT where the file is malformed. */
int model_read(struct model *m, const char *path, struct err *e);
/* The same of a file that is open. */
int model_take(struct model *m, const struct safetensors *st, struct err *e);
/* ERR_CHECK where a number is not finite, or too large for the precision. */
int model_write(const struct model *m, const char *path, const char *options, long long seed, struct err *e);
void model_free(struct model *m);

/* Which row serves each Gaussian of the scene (scene_gaussians), with means (scene_gaussians,3). */
int model_rows(const struct model *m, const float *means, struct rows *rows, struct err *e);
