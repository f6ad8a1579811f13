/* Files: whole reads, and outputs that appear under their name only when whole. "-" is stdin or stdout. */
#pragma once

#include "base/err.h"

#include <stdio.h>

/* Reads a whole file or pipe. *data gets len bytes and a NUL after them; free() it. 0, or -1 with *e. */
int file_read(const char *path, char **data, size_t *len, struct err *e);

/* A read-only map of a regular file (or a read copy of a pipe). Release with file_unmap. */
struct file_map {
	const unsigned char *data;
	size_t len;
	int is_mapped; /* else data was read */
};
int file_map(const char *path, struct file_map *map, struct err *e);
/* The same of a part of an open file that begins with a page of memory; `name` is what file_at gives. */
int file_map_part(int fd, const char *name, size_t at, size_t len, struct file_map *map, struct err *e);
void file_unmap(struct file_map *map);

/* The path of the mapped file that has this address, or NULL. For the handler of SIGBUS, which comes where a
 * page cannot be read or the file was cut short meanwhile. Of many maps at a time only some are known. */
const char *file_at(const void *address);

/* An input stream for path; "-" gives stdin. NULL with *e set. Close with file_close. */
FILE *file_open(const char *path, struct err *e);
void file_close(FILE *in);
/* Of a local, where its block is left: SCOPED_BY(file_release) FILE *in = file_open(...). */
void file_release(FILE **in);

/* The name that messages use for a path: "stdin" for "-". */
const char *file_name(const char *path);

struct temporary;

/* An output. Data go to a temporary file in the same folder (base/temporary.h); file_out_commit syncs it and
 * renames it over `path`; file_out_abort removes it. Where `path` is a symbolic link, its target is replaced;
 * a file that is replaced hands on its mode. "-", devices and pipes are written to directly. */
struct file_out {
	FILE *stream;
	char *path, *target;
	struct temporary *temporary; /* NULL where the output is written to directly */
};
int file_out_open(struct file_out *out, const char *path, struct err *e);
int file_out_commit(struct file_out *out, struct err *e); /* closes in any case */
void file_out_abort(struct file_out *out);		  /* harmless after commit, and on a zeroed struct */

/* Commits, or where writing was bad (*e says why, but for the device) aborts. 0, or -1 with *e. */
int file_out_end(struct file_out *out, int bad, struct err *e);

/* Opens, writes by `put`, in which nothing but the device can fail, and ends. */
int file_out_put(const char *path, void (*put)(FILE *out, const void *what), const void *what, struct err *e);

/* Fails where an output of that name could not be opened: before long work. Leaves nothing behind. */
int file_out_probe(const char *path, struct err *e);

/* The same for the time that long work takes: what is left of it is file_out_abort's. A second run into one
 * regular file fails: "path: another run is writing it". */
int file_out_claim(struct file_out *out, const char *path, struct err *e);

/* Makes a directory and its parents. An existing directory is fine. */
int file_make_dir(const char *path, struct err *e);

/* 1 when path exists (as a directory, with file_is_dir). */
int file_exists(const char *path);
int file_is_dir(const char *path);

/* 1 where a path is a pipe, which cannot be read twice: a named one, or one of a shell's <(...). "-" is none.
 */
int file_is_pipe(const char *path);

/* dir + "/" + name (+ suffix); name itself where it is absolute. NULL with *e set when memory is out. */
char *file_join(const char *dir, const char *name, const char *suffix, struct err *e);

/* The same of what is there, else NULL: *e is set where memory is out alone. */
char *file_find(const char *dir, const char *name, struct err *e);

/* The folder part of path, "." where there is none. */
char *file_dir(const char *path, struct err *e);
