/* Adam (Kingma and Ba 2015, algorithm 1), with PyTorch's torch.optim.Adam as the model of details: eps is
 * added after the bias correction, no weight decay. Parameters, gradients and both moments are slabs, so one
 * call is the step. */
#pragma once

#include <stddef.h>

/* One step over n parameters; m and v are the first and second moments, zero before the first step. `step`
 * counts from 1 and sets the bias correction: m = beta1 m + (1-beta1) g,  v = beta2 v + (1-beta2) g^2
 *   parameter -= rate / (1-beta1^step) * m / (sqrt(v / (1-beta2^step)) + eps)
 * The scalars are double since 1 - 0.999f is already wrong in the fifth digit. Each element depends on its
 * own four numbers only: the bytes do not depend on the number of threads. */
void adam_step(float *parameters, const float *gradient, float *m, float *v, size_t n, double rate,
	double beta1, double beta2, double eps, long step);
