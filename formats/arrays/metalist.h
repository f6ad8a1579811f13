/* Lists of strings as text: a JSON list each, as metadata of safetensors are strings
 * (formats/arrays/safetensors.md). */
#pragma once

#include <stddef.h>

/* n strings as such a text, to be freed; NULL when memory is out. */
char *metalist_print(char *const *strings, size_t n);

/* Such a text taken apart: mem_free_strings them. NULL with *reason where it is none of UTF-8 strings, or
 * memory is out. Of no strings it is not NULL. */
enum { METALIST_REASON = 64 };
char **metalist_parse(const char *text, size_t *n, char reason[METALIST_REASON]);
