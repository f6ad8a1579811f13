/* Lists of strings in the metadata of safetensors, each a JSON list (metadata are strings), and the offsets
 * that share out the rows of a tensor among them: what sentences are in formats/scene/text.md and
 * formats/scene/lifted.md. */
#ifndef FORMATS_METALIST_H
#define FORMATS_METALIST_H

#include "base/err.h"
#include "formats/arrays/safetensors.h"

#include <stddef.h>
#include <stdint.h>

/* The metadata value `key`, a list of one string for each of n `of` ("sentences"). The strings are UTF-8;
 * metalist_free them. NULL with *e (ERR_FORMAT, "path: metadata 'key' ..."). */
char **metalist_read(const struct safetensors *st, const char *key, size_t n, const char *of, struct err *e);
void metalist_free(char **strings, size_t n);

/* n strings as such a value, to be freed; NULL when memory is out. */
char *metalist_print(char *const *strings, size_t n);

/* All are names of refs or objects (base/name.h), or empty where they may be: 0, or -1 with *e. */
int metalist_check_names(
	char *const *strings, size_t n, int may_be_empty, const char *key, const char *path, struct err *e);

/* Such a value taken apart, whatever its length: NULL with *e (ERR_FORMAT: no list of UTF-8 strings). Of no
 * strings it is not NULL. */
char **metalist_parse(const char *value, size_t *n, struct err *e);

/* No two are the same: 0, or -1 with *e. */
int metalist_check_unique(char *const *strings, size_t n, const char *key, const char *path, struct err *e);

/* Tensor `name` (n+1) begins with 0, never falls and ends with the count of the rows, which are `of`
 * ("words"): 0, or -1 with *e. */
int metalist_check_offsets(const char *name, const int64_t *offsets, size_t n, int64_t count, const char *of,
	const char *path, struct err *e);

/* Metadata 'pieces': string i has pieces with one space between and none around, offsets[i+1] - offsets[i] of
 * them. 0, or -1 with *e. */
int metalist_check_pieces(
	char *const *pieces, const int64_t *offsets, size_t n, const char *path, struct err *e);

#endif
