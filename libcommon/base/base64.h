/* Bytes as text: base64 of RFC 4648, padded, without line ends. */
#pragma once

#include "base/err.h"

/* `before`, then the bytes as base64, as one string: free() it. NULL with *e set when memory is out. */
char *base64_text(const char *before, const void *bytes, size_t n, struct err *e);

/* What a text of it is of, up to the first character that is none of its digits: the bytes, *n of them;
 * free() it. NULL with *e set when memory is out. */
void *base64_bytes(const char *text, size_t *n, struct err *e);
