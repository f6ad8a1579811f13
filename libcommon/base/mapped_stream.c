#include "base/mapped_stream.h"

#include "base/file.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/stat.h>

/* A stream of memory has a buffer too, which is filled anew after each seek: of about a line of WordNet's. */
enum { BUFFER = 512 };

void mapped_stream_take(FILE **stream)
{
	struct file_map map;
	struct stat st;
	struct err e;

	if (!*stream || fstat(fileno(*stream), &st) || !S_ISREG(st.st_mode) || !st.st_size ||
		file_map_part(fileno(*stream), "a mapped stream", 0, (size_t)st.st_size, &map, &e))
		return;
	FILE *mapped = fmemopen((void *)(uintptr_t)map.data, map.len, "r");
	if (!mapped) {
		file_unmap(&map);
		return;
	}
	setvbuf(mapped, malloc(BUFFER), _IOFBF, BUFFER); /* its own buffer where there is no memory */
	fclose(*stream);
	*stream = mapped;
}
