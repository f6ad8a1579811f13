/* JSON Lines: one object a line, read as a stream. formats/records/jsonl.md. */
#pragma once

#include "base/err.h"
#include "base/name.h"
#include "base/number.h"

#include <cjson/cJSON.h>
#include <stdio.h>

enum { JSONL_LINE_MAX = 64 << 20 }; /* bytes */

struct jsonl {
	FILE *in;
	const char *path; /* as messages name it */
	char where[1024]; /* of the object last returned, "path:LINE", for json_string and its like */
	char *line;
	char *text; /* where the file is UTF-16: all of it as UTF-8, which `in` reads */
	size_t capacity;
	size_t peeked;	  /* the length of a line that was looked at before it is asked for */
	long line_number; /* of the line last returned, from 1 */
	long records;	  /* objects that were asked for */
};

/* "-" is stdin. `path` must outlive the reader. */
int jsonl_open(struct jsonl *j, const char *path, struct err *e);

/* The next line's object: 1 and *object (the caller's, cJSON_Delete), 0 at the end, -1 with *e
 * ("path:LINE: reason"). Empty lines are skipped. */
int jsonl_next(struct jsonl *j, cJSON **object, struct err *e);

/* The next line that is not blank, in j->line, of which jsonl_next or jsonl_text is next: 1, 0, -1. */
int jsonl_peek(struct jsonl *j, struct err *e);

/* The next line that is not blank, in j->line without its end, of a file that is no JSON: 1, 0 at the end, -1
 * with *e. */
int jsonl_text(struct jsonl *j, struct err *e);
void jsonl_close(struct jsonl *j);

/* All objects as records of `size` bytes, each zeroed and then filled by `read`, which returns 0, or -1 with
 * *e; *records (*n) and the line of each in *lines (may be NULL): free() these. After an error, -1 with *e,
 * there are none: `release` has had each. */
int jsonl_records(struct jsonl *j, size_t size,
	int (*read)(const struct jsonl *j, const cJSON *object, void *record, struct err *e),
	void (*release)(void *record), void **records, size_t *n, long **lines, struct err *e);

/* ERR_FORMAT where two of such records have one ref, the `char *` at `offset`; lines: where they are. */
int jsonl_check_refs(const struct jsonl *j, const void *records, size_t size, size_t offset, size_t n,
	const long *lines, struct err *e);

/* Sets ERR_FORMAT with "path:LINE: reason". Always returns -1. */
int jsonl_err(const struct jsonl *j, struct err *e, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

/* The text of a name, which may be a whole number; NULL where it is neither. */
const char *jsonl_name_text(const cJSON *item, char digits[NUMBER_SIZE]);

/* A copy of a name in *name, which stays as it was where the key is absent or null. What base/name.h does not
 * take as a name is an error. Returns 0, or -1 with *e. */
int jsonl_name(const struct jsonl *j, const cJSON *object, const char *key, enum name_kind kind, int need,
	char **name, struct err *e);

/* A finite number; NAN where the key is absent or null. Returns 0, or -1 with *e. */
int jsonl_number(const struct jsonl *j, const cJSON *object, const char *key, double *number, struct err *e);

/* Writes `before`, then the text as a JSON string. */
void jsonl_put_string(FILE *out, const char *before, const char *text);

/* Writes `before`, n numbers with the fewest digits, whole ones without an exponent, and "]". */
void jsonl_put_numbers(FILE *out, const char *before, const double *x, int n);
