/* What readers of our safetensors files take out of them: copies of tensors and lists of strings, checked as
 * they are taken. The first thing that is wrong stays in *e, what follows is passed over and gives NULL or 0,
 * and `bad` is set: a reader looks at that once. Messages: "PATH: tensor 'NAME' ...", "PATH: metadata 'KEY'
 * ...". formats/arrays/safetensors.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/safetensors.h"

#include <stdint.h>

struct arrays_in {
	const struct safetensors *st;
	struct err *e;
	int bad;
};

/* Of a file that must be of that format, and at most of that version. */
void arrays_in_begin(
	struct arrays_in *in, const struct safetensors *st, const char *format, int version, struct err *e);

/* A whole number from 0 to INT32_MAX in the metadata. */
size_t arrays_in_count(struct arrays_in *in, const char *key);

/* A vector of n items (-1: any) where it lies in the file, and in *count (may be NULL) how many. */
const void *arrays_in_place(
	struct arrays_in *in, const char *name, enum st_dtype dtype, int64_t n, size_t *count);
/* The same as a copy; free() it. */
void *arrays_in_vector(struct arrays_in *in, const char *name, enum st_dtype dtype, int64_t n, size_t *count);

/* n float32 numbers, all of them finite, into `to`. */
void arrays_in_fill(struct arrays_in *in, const char *name, float *to, size_t n);

/* A copy of a float32 matrix, all of it finite. */
float *arrays_in_floats(struct arrays_in *in, const char *name, size_t rows, int columns);

/* The columns of a matrix, 1 to 65536, and in *rows its rows. */
int arrays_in_width(struct arrays_in *in, const char *name, enum st_dtype dtype, size_t *rows);

/* The offsets that share out rows among *n `of` ("sentences"), one more than these; and that they begin with
 * 0, never fall and end with the count of the rows, which are `of` ("words"). */
int64_t *arrays_in_offsets(struct arrays_in *in, const char *name, const char *of, size_t *n);
void arrays_in_check_offsets(struct arrays_in *in, const char *name, const int64_t *offsets, size_t n,
	size_t count, const char *of);

/* Tensor 'index' rises within each of n `of` ("object"), from 0 to below `limit`. */
void arrays_in_check_index(struct arrays_in *in, const int32_t *index, const int64_t *indptr, size_t n,
	size_t limit, const char *of);

/* A list of strings, one for each of n `of` ("sentences"): mem_free_strings. */
char **arrays_in_list(struct arrays_in *in, const char *key, size_t n, const char *of);

/* They are names of refs or objects (base/name.h), or empty where they may be; no two are the same. */
void arrays_in_check_names(
	struct arrays_in *in, char *const *strings, size_t n, int may_be_empty, const char *key);
void arrays_in_check_unique(struct arrays_in *in, char *const *strings, size_t n, const char *key);

/* Metadata 'pieces': string i has offsets[i+1] - offsets[i] pieces, one space between and none around. */
void arrays_in_check_pieces(struct arrays_in *in, char *const *pieces, const int64_t *offsets, size_t n);
