/* What the files of nn/bpe.h share. */
#ifndef NN_BPE_PRIVATE_H
#define NN_BPE_PRIVATE_H

#include "nn/bpe.h"

/* The merge of two symbols, or NULL. */
const struct bpe_merge *bpe_find(const struct bpe *b, int32_t left, int32_t right);

#endif
