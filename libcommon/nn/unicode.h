/* What BERT's uncased normalisation needs of Unicode: which characters it drops, splits at and replaces. */
#ifndef NN_UNICODE_H
#define NN_UNICODE_H

#include <stddef.h>
#include <stdint.h>

enum { UNICODE_FOLD_MAX = 3 }; /* characters that one may be folded into */

/* Control, format and private-use characters (Cc, Cf, Co) but for tab, line feed and carriage return; U+FFFD.
 */
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

/* The tables, in unicode_tables.c; all in rising order. */
struct unicode_range {
	uint32_t first, last;
};
struct unicode_run { /* first + i step becomes to + i to_step, for i < count */
	uint32_t first;
	uint8_t count, step;
	uint32_t to;
	uint8_t to_step;
};
struct unicode_list { /* one character becomes two or three; 0 ends them */
	uint32_t from, to[UNICODE_FOLD_MAX];
};
extern const struct unicode_range unicode_dropped[], unicode_marks[], unicode_punctuation[];
extern const struct unicode_run unicode_runs[];
extern const struct unicode_list unicode_lists[];
extern const size_t unicode_dropped_count, unicode_marks_count, unicode_punctuation_count, unicode_runs_count,
	unicode_lists_count;

#endif
