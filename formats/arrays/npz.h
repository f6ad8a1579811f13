/* NumPy's .npz: arrays in a zip. formats/arrays/npy.md. */
#pragma once

#include "formats/arrays/archive.h"
#include "formats/arrays/npy.h"

struct npz {
	char *path;
	struct archive zip; /* of files "NAME.npy"; points to itself: a struct npz is not copied */
};

/* Returns 0, or -1 with *e; npz_close after either. */
int npz_open(struct npz *z, const char *path, struct err *e);
void npz_close(struct npz *z);

/* Whether it has the array "NAME" + "SUFFIX". */
int npz_has(const struct npz *z, const char *name, const char *suffix, struct err *e);

/* Opens that array, in memory; npy_close it. *called (may be NULL): how messages name it, "FILE: NAME.npy";
 * free() it. Returns 0, or -1 with *e. */
int npz_array(const struct npz *z, const char *name, const char *suffix, struct npy *a, char **called,
	struct err *e);

/* Opens the array of that place among the entries, as npz_array does. */
int npz_entry(const struct npz *z, size_t place, struct npy *a, char **called, struct err *e);

/* The first of two names that an array has; NULL with *e where none has. And that array of a file. */
const char *npz_main(const struct npz *z, const char *const names[2], struct err *e);
int npz_open_main(const char *path, const char *const names[2], struct npy *a, char **called, struct err *e);
