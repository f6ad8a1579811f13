#include "base/mapped_stream.h"

#include "base/file.h"

#include <stdint.h>
#include <stdio_ext.h>
#include <sys/stat.h>

void mapped_stream_take(FILE **stream, char buffer[MAPPED_STREAM_BUFFER])
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
	__fsetlocking(mapped, FSETLOCKING_BYCALLER); /* one thread reads it, a character at a time */
	setvbuf(mapped, buffer, _IOFBF, MAPPED_STREAM_BUFFER);
	fclose(*stream);
	*stream = mapped;
}
