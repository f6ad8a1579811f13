/* What BERT's uncased normalisation and CLIP's need of Unicode: which characters they drop, split at and
 * replace. What Unicode says of a character is utf8proc's to know. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { UNICODE_FOLD_MAX = 4 }; /* characters that one may be folded into */

/* Control, format and private-use characters (Cc, Cf, Co) but tab, line feed and carriage return; U+FFFD. */
int unicode_is_dropped(uint32_t c);

/* The property White_Space. */
int unicode_is_space(uint32_t c);

/* Categories P*, and the ASCII symbols: $ + < = > ^ ` | ~ */
int unicode_is_punctuation(uint32_t c);

/* CJK ideographs, each of which is a word. Kana and Hangul are not among them. */
int unicode_is_ideograph(uint32_t c);

/* Canonical decomposition (NFD), without nonspacing marks (Mn), each character in lower case by itself: a
 * final sigma is not treated apart. Returns how many characters go to out, 0 for a mark. Marks that are kept
 * (Mc) are left in their order: no vocabulary tells the orders apart. */
size_t unicode_fold(uint32_t c, uint32_t out[UNICODE_FOLD_MAX]);

/* Categories L* and N*. */
int unicode_is_letter(uint32_t c);
int unicode_is_number(uint32_t c);

/* The character in lower case by itself; returns how many characters go to out, 1 or 2. */
size_t unicode_lower(uint32_t c, uint32_t out[2]);

/* Canonical composition (NFC) of UTF-8, without bytes that are malformed; *length of it. free() it; NULL with
 * *e set when memory is out. */
char *unicode_compose(const char *text, size_t *length, struct err *e);
