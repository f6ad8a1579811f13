/* A warm start: before it learns from images, a training is fitted to the fields of lifted objects. The step
 * is the usual one; what it sees is a view whose pixels are the rows of features themselves, each with its
 * own response at full weight: M = m. The mask of a sentence is where the share of its object is above one
 * half. That is one weight a pixel where an image of a scene has dozens. The features begin with a direction
 * for each object, so that the networks, which learn slowly, have something to tell apart from the first
 * step. */
#pragma once

#include "base/err.h"
#include "field/rows.h"
#include "lift/lifted_model.h"
#include "train/train.h"

/* What is fitted. */
struct warm_start_source {
	const struct lifted *lifted; /* of the rows' scene */
	const struct rows *rows;
	const double *weight; /* (gaussians) how much each counts in its row */
	size_t sentences;
	const char *const *names; /* (sentences) of their objects; "": nothing is there */
};

struct warm_start {
	size_t objects;		/* that were lifted and have sentences */
	float *share;		/* (objects, rows) the mean over each row's Gaussians, by weight */
	struct train_view view; /* W = 1; pixels of small objects several times */
	struct train_order order;
	/* What view refers to. */
	int64_t *indptr;
	int32_t *index;
	float *weight;
	uint8_t *bits; /* (objects + 1, bits_bytes(pixels)), the last empty */
};

enum {
	WARM_START_BATCH = 16,	  /* sentences in a step */
	WARM_START_MLP_RATE = 10, /* times the usual rate of the networks: what they fit is free of noise */
};

/* The view, and the order of its sentences. Those whose object was not lifted have no mask, those
 * that mean nothing an empty one. */
int warm_start_init(struct warm_start *w, const struct warm_start_source *from,
	const struct train_contrast *contrast, uint64_t seed, struct err *e);
void warm_start_free(struct warm_start *w);

/* x (rows, width): the sum over objects of their share times a direction of the object's, random but at right
 * angles, as far as the width has room. */
int warm_start_features(const struct warm_start *w, int width, uint64_t seed, float *x, struct err *e);
