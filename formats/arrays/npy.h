/* NumPy .npy arrays, versions 1.0 and 2.0: any numbers are read, float32 written (formats/arrays/npy.md). */
#pragma once

#include "base/err.h"
#include "base/file.h"

#include <stdint.h>

enum { NPY_MAX_DIMS = 8 };

/* An array in place: nothing is read before it is asked for. */
enum npy_type {
	NPY_F16,
	NPY_F32,
	NPY_F64,
	NPY_U8,
	NPY_I8,
	NPY_U16,
	NPY_I16,
	NPY_U32,
	NPY_I32,
	NPY_I64,
	NPY_TYPES
};

struct npy {
	int dims;
	size_t shape[NPY_MAX_DIMS];
	size_t count;
	enum npy_type type;
	const unsigned char *data; /* (count) little-endian, at any alignment */
	struct file_map map;
};

/* C order, little-endian. Returns 0, or -1 with *e; npy_close after either. */
int npy_open(struct npy *a, const char *path, struct err *e);
/* The same of bytes in memory, which are a's from then on; messages call them `name`. */
int npy_open_bytes(struct npy *a, char *data, size_t len, const char *name, struct err *e);
void npy_close(struct npy *a);

double npy_value(const struct npy *a, size_t i);
/* out (n): the values from `first` on. */
void npy_floats(const struct npy *a, size_t first, size_t n, float *out);

/* Appears whole. "-" is stdout. dims in 0 to NPY_MAX_DIMS. */
int npy_write(const char *path, const float *values, const size_t *shape, int dims, struct err *e);
