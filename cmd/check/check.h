/* Says what a file of the suite is, by its content, and whether it is well-formed. Reads with the format's
 * own reader, so what passes here is what the tools accept. */
#ifndef CMD_CHECK_CHECK_H
#define CMD_CHECK_CHECK_H

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/arrays/safetensors.h"

enum { CHECK_MAX_FACTS = 6 };

struct check_fact {
	const char *name; /* of what is counted, in the plural: "weights" */
	long long value;
};

struct check {
	const char *kind;      /* "refer.weights", "scene", "masks" ... */
	const char *precision; /* of its numbers; NULL where there is no choice */
	int width, height;     /* of its image or views; 0 where there is none, or more than one */
	struct fingerprint scene, camera, encoder; /* those that the file has */
	int n;
	struct check_fact facts[CHECK_MAX_FACTS];
	struct safetensors
		listing; /* an open safetensors file of somebody else's, to be listed; zeroed otherwise */
};

/* Checks a file or folder; "-" is stdin, which must be seekable (see check_spool). Returns 0 and *c (release
 * with check_free), or -1 with *e: ERR_FORMAT where the file is malformed or of no known kind, ERR_SYSTEM
 * where it cannot be read. */
int check_file(struct check *c, const char *path, struct err *e);
void check_free(struct check *c);

/* Where stdin is a pipe, puts a temporary file with its content in its place, so that it can be read twice.
 */
int check_spool(struct err *e);

#endif
