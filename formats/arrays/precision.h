/* Matrices of numbers as tensors of a safetensors file: exact, or in fewer bits (formats/scene/model.md). */
#pragma once

#include "base/err.h"
#include "formats/arrays/arrays_out.h"

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

/* Puts x (rows,columns), which must last until the end, as tensors of that name: with u8 also NAME.low and
 * NAME.step, F32 [rows,1] or [1,columns]. ERR_CHECK where a number is not finite or too large. */
void precision_put(struct arrays_out *out, const char *name, enum precision p, enum precision_group group,
	size_t rows, size_t columns, const float *x);

/* The numbers of a matrix of exactly that shape, as float32; errors as safetensors_need's, and ERR_FORMAT
 * where one is not finite. */
int precision_get(const struct safetensors *st, const char *name, enum precision p,
	enum precision_group group, size_t rows, size_t columns, float *x, struct err *e);

/* Numbers to be written as they are, all of them finite: else ERR_CHECK, as above. */
void precision_put_vector(struct arrays_out *out, const char *name, size_t n, const float *x);
