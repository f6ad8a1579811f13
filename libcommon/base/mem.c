#define _DEFAULT_SOURCE /* madvise */

#include "base/mem.h"

#include <stdint.h>
#include <sys/mman.h>

/* Blocks of at least LARGE are asked for in huge pages: a view's weights take a hundred megabytes, and
 * faulting them in by 4 KiB costs as much as rendering them. */
enum { ALIGNMENT = 64, HUGE_PAGE = 2 << 20, LARGE = 8 << 20 };

int mem_size(size_t a, size_t b, size_t *out)
{
	if (b && a > (SIZE_MAX - 64) / b)
		return -1;
	*out = a * b;
	return 0;
}

void *mem_alloc(size_t n, size_t size, const char *what, struct err *e)
{
	size_t bytes;
	void *block = NULL;

	if (mem_size(n, size, &bytes) || bytes > PTRDIFF_MAX) {
		err_set(e, ERR_SYSTEM, "%s: %zu items of %zu bytes do not fit in memory", what, n, size);
		return NULL;
	}
	if (posix_memalign(&block, bytes >= LARGE ? HUGE_PAGE : ALIGNMENT, bytes ? bytes : 1)) {
		err_set(e, ERR_SYSTEM, "%s: out of memory for %zu bytes", what, bytes);
		return NULL;
	}
#ifdef MADV_HUGEPAGE
	if (bytes >= LARGE)
		madvise(block, bytes, MADV_HUGEPAGE); /* advice only: nothing depends on the answer */
#endif
	return block;
}

void *mem_zalloc(size_t n, size_t size, const char *what, struct err *e)
{
	void *block = mem_alloc(n, size, what, e);

	if (block)
		memset(block, 0, n * size);
	return block;
}

int mem_grow(void **block, size_t *capacity, size_t need, size_t size, const char *what, struct err *e)
{
	if (need <= *capacity)
		return 0;
	size_t grown = *capacity ? *capacity : 16;
	while (grown < need) {
		if (grown > SIZE_MAX / 2)
			return err_set(e, ERR_SYSTEM, "%s: %zu items do not fit in memory", what, need);
		grown *= 2;
	}
	void *moved = mem_alloc(grown, size, what, e);
	if (!moved)
		return -1;
	if (*capacity)
		memcpy(moved, *block, *capacity * size);
	free(*block);
	*block = moved;
	*capacity = grown;
	return 0;
}

int mem_room(void **block, size_t *capacity, size_t need, size_t size, const char *what, struct err *e)
{
	if (*block && need <= *capacity)
		return 0;
	free(*block);
	*capacity = need <= SIZE_MAX - need / 8 ? need + need / 8 : need;
	*block = mem_alloc(*capacity, size, what, e);
	if (*block)
		return 0;
	*capacity = 0;
	return -1;
}

char *mem_strdup(const char *text, struct err *e)
{
	size_t bytes = strlen(text) + 1;
	char *copy = mem_alloc(bytes, 1, "string", e);

	if (copy)
		memcpy(copy, text, bytes);
	return copy;
}

char *mem_text_end(FILE *stream, char **text, int bad, const char *what, struct err *e)
{
	if ((!stream || fclose(stream)) && !bad)
		bad = err_set(e, ERR_SYSTEM, "%s: out of memory", what);
	if (!bad)
		return *text;
	free(*text);
	return NULL;
}

void mem_free_strings(char **strings, size_t n)
{
	for (size_t i = 0; strings && i < n; i++)
		free(strings[i]);
	free(strings);
}

void mem_free_list(void *const *blocks, size_t n)
{
	for (size_t i = 0; i < n; i++)
		free(blocks[i]);
}
