/* Matrices of numbers as tensors of a safetensors file: exact, or in fewer bits. formats/scene/model.md has
 * the bytes. */
#ifndef FORMATS_PRECISION_H
#define FORMATS_PRECISION_H

#include "base/err.h"
#include "formats/arrays/safetensors.h"

#include <stddef.h>

/* In the order of the choices. */
enum precision {
	PRECISION_F32,
	PRECISION_F16, /* rounded to the nearest half */
	PRECISION_U8, /* x = low + step * q, with low and step of the number's row or column: off by step/2 */
	PRECISIONS
};

#define PRECISION_CHOICES "f32|f16|u8"

/* The name, and back (-1: unknown). */
const char *precision_name(enum precision p);
int precision_parse(const char *name);

/* What a matrix's items are in a file. */
enum st_dtype precision_dtype(enum precision p);

/* What the numbers of a matrix have a low and a step in common with. */
enum precision_group { PRECISION_ROWS, PRECISION_COLUMNS };

/* A matrix to be written: `count` tensors, whose data belong to it, or to the caller (f32). */
struct precision_matrix {
	struct st_tensor
		tensors[3]; /* NAME; with u8 also NAME.low and NAME.step, F32 [rows,1] or [1,columns] */
	int count;
	float *owned;
	char low[64], step[64];
};

/* x (rows,columns) becomes tensors of that name (at most 50 characters). ERR_CHECK with `path` where a number
 * is not finite or too large for the precision. Free in any case. */
int precision_put(struct precision_matrix *m, const char *name, enum precision p, enum precision_group group,
	size_t rows, size_t columns, const float *x, const char *path, struct err *e);
void precision_free(struct precision_matrix *m);

/* The numbers of a matrix of exactly that shape, as float32; errors as safetensors_need's, and ERR_FORMAT
 * where one is not finite. */
int precision_get(const struct safetensors *st, const char *name, enum precision p,
	enum precision_group group, size_t rows, size_t columns, float *x, struct err *e);

/* 0 where all n numbers are within +-limit, else -1 with *e ("path: tensor 'name': item I is ..."). */
int precision_check(const float *x, size_t n, double limit, enum err_code code, const char *path,
	const char *name, struct err *e);

#endif
