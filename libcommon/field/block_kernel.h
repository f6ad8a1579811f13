/* The kernels of field/block.h, included by one file for each instruction set, which names itself BLOCK_ISA
 * and selects its target before (see base/vecmath.h). */
#include "field/block_back.h"

#define PASTE(a, b) a##_##b
#define EXPAND(a, b) PASTE(a, b)
#define TEXT(a) #a
#define NAME_TEXT(a) TEXT(a)

extern const struct block_kernels EXPAND(block_kernels, BLOCK_ISA);
const struct block_kernels EXPAND(block_kernels, BLOCK_ISA) = {
	NAME_TEXT(BLOCK_ISA), hidden, respond, gather, scores_back, hidden_back};
