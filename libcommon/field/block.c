#include "field/block.h"

#include "base/cpu.h"

#include <string.h>

extern const struct block_kernels block_kernels_avx512, block_kernels_avx2, block_kernels_plain;

const struct block_kernels *block_select(const char *name)
{
#if defined __x86_64__
	const enum cpu_level level = cpu_level();

	if (level >= CPU_AVX512 && (!name || !strcmp(name, "avx512")))
		return &block_kernels_avx512;
	if (level >= CPU_AVX2 && (!name || !strcmp(name, "avx2")))
		return &block_kernels_avx2;
#endif
	return !name || !strcmp(name, "plain") ? &block_kernels_plain : NULL;
}

size_t block_scratch_floats(const struct block_model *b)
{
	const size_t lanes = BLOCK_LANES, block = BLOCK_SIZE, words = (size_t)b->words, z = (size_t)b->z_size;
	size_t back = 2 * block * BLOCK_G + 2 * block * REFER_XH +
		      lanes * (2 * words > 2 * BLOCK_G ? 2 * words : 2 * BLOCK_G);
	size_t most = back;

	if (words * block > most)
		most = words * block;
	if (block * (words + z + 1) + z * lanes > most)
		most = block * (words + z + 1) + z * lanes;
	return most;
}
