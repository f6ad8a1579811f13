/* safetensors: named arrays in one file. Ours carry a crc32 for each tensor; foreign ones are read too.
 * formats/arrays/safetensors.md describes the bytes. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "base/names.h"

#include <stdint.h>

enum st_dtype {
	ST_U8,
	ST_I8,
	ST_I32,
	ST_I64,
	ST_F16,
	ST_BF16,
	ST_F32,
	ST_F64,
	ST_BOOL, /* this one and those after it: only in foreign files */
	ST_I16,
	ST_U16,
	ST_U32,
	ST_U64,
	ST_F8_E4M3,
	ST_F8_E5M2,
	ST_DTYPES
};

enum { ST_MAX_DIMS = 8 };

struct st_tensor {
	const char *name;
	enum st_dtype dtype;
	int dims;
	int64_t shape[ST_MAX_DIMS]; /* row-major */
	const void *data;	    /* little-endian; in a foreign file at any alignment: copy, never cast */
	size_t bytes;		    /* set by the reader; ignored by the writer, which takes the shape's */
};

struct st_meta {
	const char *key, *value;
};

struct safetensors {
	char *path;
	size_t n, meta_count;
	struct st_tensor *tensors; /* in the order of the file's data */
	struct st_meta *meta;
	struct names tensor_names, meta_keys;
	struct file_map map;
	int is_borrowed; /* the bytes are not the reader's to free */
};

/* Opens and checks a whole file: header, ranges, no overlap or hole, crc32 where it is given. The tensors
 * point into the file's map until safetensors_close. Messages name the path and the tensor or offset. */
int safetensors_open(struct safetensors *st, const char *path, struct err *e);
/* The same of bytes in memory, which stay the caller's; messages call them `name`. */
int safetensors_open_bytes(
	struct safetensors *st, const char *name, const unsigned char *bytes, size_t len, struct err *e);
void safetensors_close(struct safetensors *st);

/* The tensor / metadata value of that name, or NULL. */
const struct st_tensor *safetensors_find(const struct safetensors *st, const char *name);
const char *safetensors_meta(const struct safetensors *st, const char *key);

/* A metadata value that is a whole number in [low,high]: digits, after a minus sign or none. Returns 0, or -1
 * with *e set (ERR_FORMAT, "path: metadata 'key' is ..."). */
int safetensors_meta_int(const struct safetensors *st, const char *key, long long low, long long high,
	long long *value, struct err *e);

/* The tensor of that name with exactly this type and shape (-1 in shape matches any length); NULL with *e set
 * (ERR_FORMAT, "path: tensor 'x': ..."). */
const struct st_tensor *safetensors_need(const struct safetensors *st, const char *name, enum st_dtype dtype,
	int dims, const int64_t *shape, struct err *e);

/* A copy of the data of such a tensor, and in *n (may be NULL) the first length of its shape. free() it. */
void *safetensors_copy(const struct safetensors *st, const char *name, enum st_dtype dtype, int dims,
	const int64_t *shape, size_t *n, struct err *e);

/* 0 where all numbers of a tensor are finite, else -1 with *e (ERR_FORMAT, "path: tensor 'name': item I is
 * not finite"). */
int safetensors_check_finite(
	const struct safetensors *st, const char *name, const float *x, size_t n, struct err *e);

/* The file's own `format` must be this (e.g. "refer.weights") and its `version` not above `version`; every
 * tensor must be aligned to its type, so that it may be used in place. */
int safetensors_need_format(const struct safetensors *st, const char *format, int version, struct err *e);

/* In files of ours every tensor is aligned to its type and may be used in place. This copies any F32, F16,
 * BF16 or F64 tensor to float, at whatever alignment. `out` holds `count` items, the shape's product. */
int safetensors_to_float(const struct st_tensor *t, float *out, size_t count, struct err *e);

/* A tensor to write, of one or two dimensions. */
static inline struct st_tensor st_vector(const char *name, enum st_dtype dtype, int64_t n, const void *data)
{
	return (struct st_tensor){.name = name, .dtype = dtype, .dims = 1, .shape = {n}, .data = data};
}

static inline struct st_tensor st_matrix(
	const char *name, enum st_dtype dtype, int64_t rows, int64_t columns, const void *data)
{
	return (struct st_tensor){
		.name = name, .dtype = dtype, .dims = 2, .shape = {rows, columns}, .data = data};
}

/* Writes path whole ("-" is stdout). Adds crc32.<tensor> for each tensor; `meta` should hold format, version,
 * tool, options and seed; a key whose value is NULL is left out. Data begin on a 64-byte boundary; tensors
 * are laid out widest type first, so that each is aligned to its own type. */
int safetensors_write(const char *path, const struct st_tensor *tensors, size_t n, const struct st_meta *meta,
	size_t meta_count, struct err *e);

/* The key of a tensor's checksum; free() it. */
char *st_crc_key(const char *tensor, struct err *e);

/* Size of one item, and the name ("F32"). */
size_t st_dtype_size(enum st_dtype t);
const char *st_dtype_name(enum st_dtype t);
