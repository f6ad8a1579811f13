/* What a model of any kind answers to sentences before any view is rendered: responses of the Gaussians.
 * Sentences that get the same answer share it, so that it is blended once. */
#pragma once

#include "answer/respond.h"
#include "ask/choose.h"
#include "base/err.h"
#include "geom/camera.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

#include <stdint.h>

/* The sentences, and the scene that they are about. */
struct responses_question {
	const struct splats *splats;
	const struct cameras *cameras;
	const int64_t *offsets;	     /* sentence r has words offsets[r] to offsets[r+1] */
	const float *words, *middle; /* by the encoder's last and middle layer; middle may be NULL */
	char **texts, **pieces;	     /* of each sentence; trained models need none */
	const struct viewpoint
		*from; /* (count) where each of `which` is said; NULL: from the usual viewpoint */
	const struct parser *parser;
	const struct tracks *tracks; /* as of struct choose_scene */
	const size_t *which;	     /* (count) the sentences */
	size_t count;
	char *const *refs; /* of each sentence, and the model's file: for messages */
	const char *model_path;
	int wants_parts; /* of a lifted model: an answer too for each object of several that a sentence means
			  */
};

struct responses {
	size_t answers;
	float *responses; /* (answers,N) as render_pack has them: what is blended */
	double *lifts;	  /* (answers) what calibration added to them */
	size_t *answer;	  /* (count) of each sentence */
	double *sure; /* (count) in [0,1], or NULL: a model of logits says so in each view (respond_mask) */
	double (*when)[2]; /* (count) from when to when, of sentences of motion; NaN: always; NULL: a trained
			      model */
	/* Of a lifted model: answer k is the union of objects[begin[k]] to objects[begin[k + 1] - 1]. */
	size_t *begin; /* (answers + 1), or NULL */
	size_t *objects;
	size_t *alone; /* the answer that is each of `objects` alone, where parts are wanted, else NULL */
};

/* An answer for each sentence, calibrated or as trained. ERR_FORMAT where one is not finite. Returns 0, or -1
 * with *e set; responses_free after either, as of the others. */
int responses_trained(struct responses *a, const struct respond_model *m, const struct responses_question *q,
	int wants_calibration, struct err *e);

/* An answer for each set of objects that a sentence means: their union; and for each alone where parts are
 * wanted. A sentence that is less likely than `least` to mean anything, or that has no words, means nothing
 * that was lifted: its responses are 0. How sure an answer is: the probability that anything is meant, times
 * the mean over its objects of the probability of each to be meant times its confidence, which is about what
 * its masks' IoU is worth. parts: choose()'s. */
#define RESPONSES_LEAST 0.5
int responses_lifted(struct responses *a, const struct lifted *l, const struct responses_question *q,
	unsigned parts, double least, struct err *e);

/* Gaussians that were selected for each of some rows: index[indptr[r]] to index[indptr[r+1] - 1]. */
struct responses_selection {
	size_t gaussians;
	const int64_t *indptr;
	const int32_t *index;
};

/* An answer for each of `count` sentences, from its row: the pixels that selected Gaussians have more than
 * RESPONSES_SELECTED of the weight of. */
#define RESPONSES_SELECTED 0.5f
int responses_selected(struct responses *a, const struct responses_selection *s, const size_t *row,
	size_t count, struct err *e);
void responses_free(struct responses *a);

/* The Gaussians of an answer, those with responses above 0: ids, and these responses (both with room for all
 * `gaussians` of the scene). Returns how many. */
size_t responses_gaussians(
	const struct responses *a, size_t gaussians, size_t answer, int32_t *ids, float *responses);

/* wholes (answers) gets the Gaussians of each answer, those with responses above 0 that are in sight of the
 * cameras (splat/visibility.h), as splats without colour. splats_free each. On failure there are none. */
int responses_wholes(const struct responses *a, const struct splats *s, const struct cameras *cameras,
	struct splats *wholes, struct err *e);
