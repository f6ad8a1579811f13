/* The logistic function, which ends softly what would be a threshold. */
#pragma once

#include <math.h>

/* 1 / (1 + e^-x) in (0,1): never 0, however small x is. */
static inline double logistic(double x)
{
	return 1 / (1 + exp(-fmin(fmax(x, -40), 40)));
}
