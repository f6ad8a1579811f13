/* Files that lie together, in a zip or in a folder: formats/splats/sog.md, formats/arrays/npy.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "base/names.h"

#include <stdint.h>
#include <stdio.h>

/* A file of a zip, and where the zip's directory has it. */
struct archive_entry {
	char *name;
	unsigned long long place, number;
};

struct archive {
	const char *name;    /* as messages name it */
	const char *folder;  /* the files are there; NULL: in a zip */
	void *zip;	     /* minizip's */
	struct file_map map; /* of the zip */
	size_t n, room;
	struct archive_entry *entries; /* (n) all files of a zip, in its order */
	struct names index;	       /* of their names */
};

/* A zip that is in memory, which is the archive's from then on. 0, or -1 with *e; archive_close after either.
 */
int archive_open_zip(struct archive *a, const char *name, struct file_map *map, struct err *e);

/* The files of a folder, which must outlive the archive. */
void archive_open_folder(struct archive *a, const char *folder);
void archive_close(struct archive *a);

/* A whole file: *data gets len bytes and a NUL; free() it. Names have no folders. 0, or -1 with *e. */
int archive_read(struct archive *a, const char *file, char **data, size_t *len, struct err *e);

/* The same of one of the entries. */
int archive_read_entry(const struct archive *a, size_t entry, char **data, size_t *len, struct err *e);

/* A zip of a few files as they are, written without going back, so that it can go into a pipe. */
enum { ZIP_FILES_MOST = 16, ZIP_NAME_MOST = 32 };

struct zip_write {
	FILE *out;
	const char *path; /* for messages */
	uint64_t at;
	int n;
	struct {
		char name[ZIP_NAME_MOST];
		uint32_t crc, size, at;
	} files[ZIP_FILES_MOST];
};

void zip_write_start(struct zip_write *z, FILE *out, const char *path);

/* Returns 0, or -1 with *e set: ERR_FORMAT where it would be more than 4 GiB. */
int zip_write_file(struct zip_write *z, const char *name, const void *bytes, size_t length, struct err *e);
/* The list of files, which ends it. */
int zip_write_end(struct zip_write *z, struct err *e);
