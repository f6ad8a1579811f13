/* Files that lie together, in a zip or in a folder: formats/sog.md. */
#ifndef FORMATS_ARCHIVE_H
#define FORMATS_ARCHIVE_H

#include "base/err.h"
#include "base/file.h"

#include <stddef.h>

struct archive {
	const char *name;	 /* as messages name it */
	const char *folder;	 /* the files are there; NULL: in a zip */
	void *zip;		 /* minizip's */
	struct file_map map;	 /* of the zip */
	unsigned long long seek; /* the zip reader's place in it */
};

/* A zip that is in memory, which is the archive's from then on; released on failure. Returns 0, or -1 with
 * *e. */
int archive_open_zip(struct archive *a, const char *name, struct file_map *map, struct err *e);

/* The files of a folder, which must outlive the archive. */
void archive_open_folder(struct archive *a, const char *folder);
void archive_close(struct archive *a);

/* A whole file: *data gets len bytes and a NUL after them; free() it. Names have no folders. Returns 0, or -1
 * with *e.
 */
int archive_read(struct archive *a, const char *file, char **data, size_t *len, struct err *e);

#endif
