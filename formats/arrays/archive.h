/* Files that lie together, in a zip or in a folder: formats/splats/sog.md, formats/arrays/npy.md. */
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

/* A file of a zip, and where the zip's directory has it. */
struct archive_entry {
	char *name;
	unsigned long long place, number;
};

/* All files of a zip, in its order; archive_free_entries. Returns 0, or -1 with *e. */
int archive_list(struct archive *a, struct archive_entry **entries, size_t *n, struct err *e);
void archive_free_entries(struct archive_entry *entries, size_t n);

/* As archive_read. */
int archive_read_entry(
	struct archive *a, const struct archive_entry *entry, char **data, size_t *len, struct err *e);

#endif
