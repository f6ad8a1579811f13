/* What the files of nn/bpe.h share. */
#pragma once

#include "nn/bpe.h"

/* The merge of two symbols, or NULL. */
const struct bpe_merge *bpe_find(const struct bpe *b, int32_t left, int32_t right);
