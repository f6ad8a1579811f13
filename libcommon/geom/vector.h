/* Vectors of three. */
#pragma once

#include <math.h>

#define PI 3.14159265358979323846

static inline double vector_dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vector_length(const double a[3])
{
	return sqrt(vector_dot(a, a));
}

/* To length 1. */
static inline void vector_normalise(double a[3])
{
	double length = vector_length(a);

	for (int k = 0; k < 3; k++)
		a[k] /= length;
}

/* out = a x b; `out` may not be either. */
static inline void vector_cross(const double a[3], const double b[3], double out[3])
{
	out[0] = a[1] * b[2] - a[2] * b[1];
	out[1] = a[2] * b[0] - a[0] * b[2];
	out[2] = a[0] * b[1] - a[1] * b[0];
}
