/* Byte pair encoding as CLIP has it (Sennrich et al. 2016; Radford et al. 2021), and HuggingFace's
 * CLIPTokenizerFast: compose (NFC), lower the case, cut into words (English clitics, letters, single digits,
 * and what is neither) between white space, and take each word's bytes as symbols, of which the last has
 * "</w>" after it. Then the two neighbours whose merge comes first are one symbol, until no merge is left.
 *
 * A byte is written as one character, its letter: itself where that shows, else one from U+0100 on. */
#pragma once

#include "base/err.h"
#include "nn/wordpiece.h"

#include <stdint.h>

#define BPE_START "<|startoftext|>"
#define BPE_END "<|endoftext|>"
#define BPE_LAST "</w>" /* after the symbol that ends a word */

enum { BPE_BYTES = 256, BPE_LETTER_MAX = 3 /* bytes of a letter with its 0 */ };

struct bpe_merge {
	int32_t left, right, id; /* two symbols and what they become */
	uint32_t rank;		 /* from 0 in the order that merges were added */
};

struct bpe {
	struct vocab vocab;
	int32_t bytes[2][BPE_BYTES]; /* ids of the symbols of a byte within a word, and at its end */
	int32_t start, end;	     /* of text */
	size_t n, slots;	     /* of the hash table: a power of two */
	struct bpe_merge *table;     /* left -1: free */
};

/* The letters of all bytes in the order that CLIP's vocabulary has them: those that show first. `byte` is the
 * one at place i, `letter` how it is written. */
void bpe_letter(size_t i, unsigned char *byte, char letter[BPE_LETTER_MAX]);

/* To be called when the vocabulary is there: sorts it, and finds the symbols of all bytes and the two special
 * tokens. 0, or -1 with the name of one that is missing in `missing`. */
enum { BPE_MISSING = 24 };
int bpe_finish(struct bpe *b, char missing[BPE_MISSING]);

/* Adds the next merge, after bpe_finish. 0; 1: there is one of these symbols already; 2: the vocabulary lacks
 * one of them, or what they become; -1 with *e set when memory is out. */
int bpe_add_merge(struct bpe *b, const char *left, const char *right, struct err *e);

void bpe_free(struct bpe *b);

/* Appends the ids of a text, without start and end; each of these stands for itself when it is written out.
 * Malformed UTF-8 is dropped. n log n steps for a word of n bytes. -1 only when memory is out. */
int bpe_encode(const struct bpe *b, const char *text, struct wordpieces *out, struct err *e);

/* How a token reads that comes after the token `before` (-1: none), as word pieces do: bytes for letters
 * where they are whole characters that show, no "</w>", and "##" before it where it does not begin a word.
 * free() it; NULL with *e set. */
char *bpe_read(const struct bpe *b, int32_t id, int32_t before, struct err *e);

/* The merge of two symbols, or NULL. */
const struct bpe_merge *bpe_find(const struct bpe *b, int32_t left, int32_t right);
