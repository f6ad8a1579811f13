/* Checked allocation. Every block is 64-byte aligned and released with free(). Brings <stddef.h>, <stdlib.h>
 * and <string.h>, which those need who have memory. */
#pragma once

#include "base/err.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* *out = a*b; returns 0, or -1 where the product does not fit (then *out is untouched). */
int mem_size(size_t a, size_t b, size_t *out);

/* n items of `size` bytes, not initialised / zeroed. NULL with *e set (ERR_SYSTEM, names `what`) when the
 * product overflows or memory is out. n = 0 gives a valid block. */
void *mem_alloc(size_t n, size_t size, const char *what, struct err *e);
void *mem_zalloc(size_t n, size_t size, const char *what, struct err *e);

/* Grows *block (of *capacity items) to hold at least `need` items, doubling. Returns 0, or -1 with *e set and
 * the block as it was. */
int mem_grow(void **block, size_t *capacity, size_t need, size_t size, const char *what, struct err *e);

/* The same for contents that may be lost: nothing is copied, and capacity is exact but for an eighth, so that
 * needs that vary a little are met at once. On failure *block is NULL and *capacity 0. */
int mem_room(void **block, size_t *capacity, size_t need, size_t size, const char *what, struct err *e);

/* A copy of a string, NULL with *e set when memory is out. */
char *mem_strdup(const char *text, struct err *e);

/* Closes a stream of open_memstream, or NULL where that failed. Its *text, which is free()d: where the
 * writing was `bad`, and *e is set, or memory is out, NULL with *e. */
char *mem_text_end(FILE *stream, char **text, int bad, const char *what, struct err *e);

/* Before a local's declaration that has an initialiser: what it owns is released wherever its block is left.
 * `SCOPED char *path = file_join(...);` for memory, and for what has a function of its address,
 * `SCOPED_BY(scene_free) struct scene s = {0};`. */
#define SCOPED_BY(release) __attribute__((cleanup(release)))
#define SCOPED SCOPED_BY(mem_free_at)

/* free() of the pointer at an address, whatever it points to. */
static inline void mem_free_at(void *address)
{
	void *block;

	memcpy(&block, address, sizeof block);
	free(block);
}

/* free() of each of these pointers, of any types. */
#define mem_free_all(...)                                                                                    \
	mem_free_list((void *[]){__VA_ARGS__}, sizeof((void *[]){__VA_ARGS__}) / sizeof(void *))
void mem_free_list(void *const *blocks, size_t n);

/* Frees n strings and the array of them, which may be NULL. */
void mem_free_strings(char **strings, size_t n);
