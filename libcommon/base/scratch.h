/* A file without a name, for what has no room in memory: written once, and mapped when it is needed. It goes
 * when it is closed, and when the process ends, however that comes. */
#pragma once

#include "base/err.h"
#include "base/file.h"

/* All 0: none, as long as nothing was put. */
struct scratch {
	const char *path; /* what it would be called: it is in that folder, and messages say so */
	int is_open, fd;
	size_t end;
};

/* A part of the file: pages of memory. */
struct scratch_part {
	size_t at, bytes;
};

/* A piece of what is put. */
struct scratch_piece {
	const void *data;
	size_t bytes;
};

/* Writes pieces one after another as the next part, and makes the file where there is none. Returns 0, or -1
 * with *e set: the disk is full, say. */
int scratch_put(struct scratch *s, const struct scratch_piece *pieces, size_t n, struct scratch_part *part,
	struct err *e);

/* Writes more at the end of the part that was put last. */
int scratch_more(struct scratch *s, const void *data, size_t bytes, struct scratch_part *part, struct err *e);

/* Has the system read a part that is needed soon, without waiting for it. */
void scratch_ahead(const struct scratch *s, const struct scratch_part *part);

/* Maps a part; release with file_unmap. By many threads at a time. */
int scratch_map(
	const struct scratch *s, const struct scratch_part *part, struct file_map *map, struct err *e);

void scratch_close(struct scratch *s);
