/* Random small problems for tests of the referring model. Every number is a float's, so that a float32
 * implementation starts from the same input. */
#ifndef REFERENCE_PROBLEM_H
#define REFERENCE_PROBLEM_H

#include "reference.h"

struct reference_options {
	size_t n;
	int text_width, feature_width;
	size_t sentences;
	uint32_t min_words, max_words;
	size_t pixels;
	uint32_t max_weights; /* a pixel has 0 .. max_weights entries; the first and last pixel none */
	enum refer_interaction interaction;
	enum refer_similarity similarity;
	enum refer_contrast contrast;
	double temperature, lambda, tau;
	double gain;	/* on refer_init's weights: at 1 the softmaxes are nearly flat */
	double x_scale; /* standard deviation of x; 0 is the start of training */
	uint64_t seed;
};

/* N 40, D_text 24, d_r 16, 5 sentences of 3 to 7 words of two objects, 30 pixels of about 6 weights, tau 0.1;
 * temperatures at which neither contrast is saturated. */
struct reference_options reference_defaults(uint64_t seed, enum refer_interaction interaction,
	enum refer_similarity similarity, enum refer_contrast contrast);

/* A problem and all it points to; the arrays may be changed. */
struct reference_sample {
	struct refer_problem problem;
	struct refer_layout layout;
	double *parameters, *x, *position, *words, *weight;
	size_t *offsets;
	int *objects;
	int64_t *indptr;
	int32_t *index;
	uint8_t *mask;
};

/* Ends the program where memory is out. Copies are independent of their source. */
void reference_sample_init(struct reference_sample *s, const struct reference_options *o);
void reference_sample_copy(struct reference_sample *s, const struct reference_sample *from);
void reference_sample_free(struct reference_sample *s);

/* The problem and the reference's answer to it as one JSON object on stdout: for tests/peers/model_torch.py.
 */
void reference_dump(const struct reference_sample *s);

#endif
