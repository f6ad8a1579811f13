/* UTF-8 as Unicode defines it: no overlong forms, no surrogates, nothing above U+10FFFF. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Decodes the character at *at (before `len`) and steps over it. A malformed byte gives U+FFFD and is stepped
 * over alone, so that decoding never fails and always ends. */
uint32_t utf8_next(const char *text, size_t len, size_t *at);

/* Appends one character (at most 4 bytes) to out; returns how many. */
size_t utf8_put(char *out, uint32_t c);

/* In place, never longer: blanks of any width become spaces, full-width forms of ASCII become ASCII, what is
 * not seen (of no width, soft hyphens, marks of direction) goes, and accents are composed. */
void utf8_plain(char *text);

/* The offset of the first malformed byte, or len where all is well. */
size_t utf8_check(const char *text, size_t len);
