/* NumPy .npy arrays of float32, version 1.0. formats/npy.md. */
#ifndef FORMATS_NPY_H
#define FORMATS_NPY_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

enum { NPY_MAX_DIMS = 8 };

struct npy {
	int dims;		    /* 0: a single number */
	size_t shape[NPY_MAX_DIMS]; /* row-major */
	size_t count;		    /* product of the shape */
	float *values;		    /* (count); owned */
};

/* Reads a whole file or pipe ("-" is stdin): version 1.0 or 2.0, '<f4', C order. */
int npy_read(struct npy *a, const char *path, struct err *e);
void npy_free(struct npy *a);

/* Appears whole. "-" is stdout. dims in 0 to NPY_MAX_DIMS. */
int npy_write(const char *path, const float *values, const size_t *shape, int dims, struct err *e);

#endif
