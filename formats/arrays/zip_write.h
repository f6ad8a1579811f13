/* A zip of a few files as they are, written without going back, so that it can go into a pipe.
 * formats/splats/sog.md. */
#ifndef FORMATS_ZIP_WRITE_H
#define FORMATS_ZIP_WRITE_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

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

#endif
