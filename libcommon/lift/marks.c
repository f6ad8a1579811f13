#include "lift/marks.h"

#include "base/mem.h"
#include "base/ones.h"

enum { WORD = 64 };

static size_t words(size_t gaussians)
{
	return gaussians / WORD + 1;
}

uint64_t *marks_make(size_t gaussians, struct err *e)
{
	return mem_zalloc(words(gaussians), sizeof(uint64_t), "Gaussians", e);
}

size_t marks_count(const uint64_t *marks, size_t gaussians)
{
	size_t n = 0;

	for (size_t word = 0; word < words(gaussians); word++)
		n += ones(marks[word]);
	return n;
}

size_t marks_take(uint64_t *marks, size_t gaussians, int32_t *index)
{
	size_t n = 0;

	for (size_t word = 0; word < words(gaussians); word++) {
		for (uint64_t left = marks[word]; left; left &= left - 1)
			index[n++] = (int32_t)(word * WORD + (size_t)__builtin_ctzll(left));
		marks[word] = 0;
	}
	return n;
}
