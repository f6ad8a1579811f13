/* What the tests of encoders do with their files. */
#ifndef UNIT_ENCODER_FILES_H
#define UNIT_ENCODER_FILES_H

#include "formats/arrays/safetensors.h"

#include <stddef.h>

/* Through void, as floats are meant to be compared to the bit here. */
int same_bytes(const void *a, const void *b, size_t n);

/* Copies a file: 0, or -1. */
int copy_file(const char *from, const char *to);

/* Makes a tensor of one of another type, F32, F16 or BF16, with its numbers in `data`: 0, or -1. */
int store_as(struct st_tensor *t, enum st_dtype dtype, void *data);

/* The i-th number of an I32, I64 or F32 tensor, else NaN. */
double number_at(const struct st_tensor *t, size_t i);

#endif
