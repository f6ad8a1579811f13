/* The vocabulary and merges of a CLIP: vocab.json with merges.txt, tokenizer.json, or OpenCLIP's list of
 * merges. formats/encoders/merges.md. */
#pragma once

#include "base/err.h"
#include "nn/bpe.h"

/* Reads the first of these that DIR has. `words` is the encoder's number of tokens, which says how many
 * merges of a list without a vocabulary count. bpe_free after a failure too. */
int merges_read(struct bpe *b, const char *dir, int words, struct err *e);

/* n ids written out as word pieces (bpe_read) with a space between; free() it. NULL when memory is out. */
char *merges_print(const struct bpe *b, const int32_t *ids, size_t n, struct err *e);
