/* Text from files: UTF-8, with or without its mark, and the UTF-16 of Windows programs, as UTF-8. */
#pragma once

#include "base/err.h"

/* 1 where text begins as UTF-16 does: with its mark, or with two characters of which a byte is 0. */
int textfile_is_wide(const char *text, size_t len);

/* Decodes the bytes of a whole file, which have a NUL after them: *text is another block where they were
 * UTF-16. Returns 0, or -1 with *e ("name: ...") and *text still to be freed. */
int textfile_decode(char **text, size_t *len, const char *name, struct err *e);

/* As file_read, decoded. *text is NULL on failure. */
int textfile_read(const char *path, char **text, size_t *len, struct err *e);

/* After an error of what a file says: that it is UTF-16, where it is and can be read again, goes behind the
 * message. -1. */
int textfile_note(const char *path, struct err *e);
