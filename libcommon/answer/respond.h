/* A trained model's answers: responses of Gaussians, and the mask of an image of them. */
#pragma once

#include "base/err.h"
#include "field/referring_model.h"
#include "field/rows.h"

#include <stdint.h>

struct respond_model {
	const struct refer_layout *layout;
	enum refer_similarity similarity;
	const struct rows *rows;
	enum refer_blend blend;
	const float *features; /* (rows,d_r) */
	const float *parameters;
	const float *means;	  /* (N,3) of the rows' scene */
	const double *low, *high; /* (3) what means are scaled by */
};

/* out (count,N): responses to the sentences `which` (count), whose words are words[offsets[r]..]. A sentence
 * without words has no answer: all zero. */
int respond_all(const struct respond_model *m, const int64_t *offsets, const float *words,
	const size_t *which, size_t count, float *out, struct err *e);

/* mask = image > 0; returns how sure it is: the mean of sigmoid(image - lift) over the mask, 0 for an empty
 * one. `lift` is what calibration added. */
double respond_mask(const float *image, size_t pixels, double lift, uint8_t *mask);
