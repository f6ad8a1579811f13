/* A problem of the float64 reference in the form that the float32 step takes. */
#ifndef REFERENCE_FLOATS_H
#define REFERENCE_FLOATS_H

#include "reference_problem.h"
#include "train/step.h"

/* A sample's arrays in the types that the step takes. */
struct floats {
	float *parameters, *x, *panels, *position, *words, *weight, *gradient, *dpanels, *dx;
	int64_t *offsets;
	uint8_t *mask; /* as bits */
};

void floats_init(struct floats *f, const struct reference_sample *s);
void floats_free(struct floats *f);

/* |a - b| / |b| over an array. */
double distance(const float *a, const double *b, size_t count);

/* A step over the sample, by the kernels of that name; NULL, said on stderr, for want of memory. */
struct step *make_step(
	const struct reference_sample *s, const struct floats *f, int batch, const char *kernels);

struct view_weights view_of(const struct refer_problem *p, const struct floats *f);
size_t top_count(const struct refer_problem *p);

#endif
