#include "encoder_files.h"

#include "base/file.h"
#include "base/half.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int same_bytes(const void *a, const void *b, size_t n)
{
	return !memcmp(a, b, n);
}

int copy_file(const char *from, const char *to)
{
	struct err e = {0};
	char *data;
	size_t len;

	if (file_read(from, &data, &len, &e))
		return -1;
	FILE *out = fopen(to, "wb");
	const int bad = !out || fwrite(data, 1, len, out) != len || fclose(out);
	free(data);
	return bad ? -1 : 0;
}

/* Rounding to nearest even. */
static uint16_t to_bfloat(float f)
{
	uint32_t bits;

	memcpy(&bits, &f, 4);
	if ((bits & 0x7fffffff) > 0x7f800000)
		return (uint16_t)(bits >> 16 | 64);
	bits += 0x7fff + (bits >> 16 & 1);
	return (uint16_t)(bits >> 16);
}

int store_as(struct st_tensor *t, enum st_dtype dtype, void *data)
{
	const size_t count = t->bytes / st_dtype_size(t->dtype);
	float *floats = malloc(count * sizeof *floats + 1);
	struct err e = {0};

	const int bad = safetensors_to_float(t, floats, count, &e);
	for (size_t k = 0; k < count && !bad; k++) {
		uint16_t half = dtype == ST_F16 ? half_of_float(floats[k]) : to_bfloat(floats[k]);
		if (dtype == ST_F32)
			memcpy((char *)data + 4 * k, &floats[k], 4);
		else
			memcpy((char *)data + 2 * k, &half, 2);
	}
	t->dtype = dtype;
	t->data = data;
	free(floats);
	return bad;
}

double number_at(const struct st_tensor *t, size_t i)
{
	const char *at = (const char *)t->data + i * st_dtype_size(t->dtype);
	int32_t whole;
	int64_t large;
	float real;

	if (t->dtype == ST_I32)
		return memcpy(&whole, at, 4), whole;
	if (t->dtype == ST_I64)
		return memcpy(&large, at, 8), (double)large;
	return t->dtype == ST_F32 ? (memcpy(&real, at, 4), (double)real) : (double)NAN;
}
