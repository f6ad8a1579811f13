/* Uncased WordPiece, as BERT's own tokenizer and HuggingFace's BertNormalizer, BertPreTokenizer and
 * WordPiece: drop control characters, split at white space, around CJK ideographs and around punctuation,
 * decompose (NFD), drop accents, lower the case, then cut each word into the longest pieces of the vocabulary
 * from the left. A word of more than 100 characters, or one that cannot be cut up, is [UNK]. Pieces within a
 * word begin with "##". */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { WORDPIECE_LONGEST = 100 }; /* characters in a word that is not [UNK] */

/* The special tokens. In a text, each that the vocabulary has stands for itself when it is written out. */
enum wordpiece_special {
	WORDPIECE_PAD,
	WORDPIECE_UNK,
	WORDPIECE_CLS,
	WORDPIECE_SEP,
	WORDPIECE_MASK,
	WORDPIECE_SPECIALS
};

struct vocab {
	size_t n, capacity;
	struct vocab_entry {
		char *token;
		int32_t id;
	} * entries;
	size_t slots;			     /* of the hash table: a power of two */
	uint32_t *table;		     /* index of an entry + 1; 0: free */
	int32_t special[WORDPIECE_SPECIALS]; /* ids; -1 where the vocabulary has none */
};

/* Adds a token. 0, or -1 with *e set when memory is out, 1 when the token is there already. */
int vocab_add(struct vocab *v, const char *token, int32_t id, struct err *e);

/* Sorts the entries by id. */
void vocab_sort(struct vocab *v);

/* To be called when all tokens of a BERT are there: sorts them, and finds the special ones. [UNK], [CLS]
 * and [SEP] are needed: the name of one that is missing, else NULL. */
const char *vocab_finish(struct vocab *v);

void vocab_free(struct vocab *v);

/* The id of the `len` bytes at token, or -1. */
int32_t vocab_find(const struct vocab *v, const char *token, size_t len);

/* The token with an id that vocab_find gave, after vocab_sort. */
const char *vocab_token(const struct vocab *v, int32_t id);

/* A growing list of ids. */
struct wordpieces {
	size_t n, capacity;
	int32_t *ids; /* free() it */
};
/* Adds one. Returns 0, or -1 with *e when memory is out. */
int wordpieces_push(struct wordpieces *out, int32_t id, struct err *e);

/* Appends the ids of a text, without [CLS] and [SEP]. Malformed UTF-8 is dropped. -1: memory is out. */
int wordpiece_encode(const struct vocab *v, const char *text, struct wordpieces *out, struct err *e);
