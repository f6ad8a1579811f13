/* parses.jsonl: sentences taken apart, one a line (JSON Lines). formats/records/parses.md. */
#ifndef FORMATS_PARSES_H
#define FORMATS_PARSES_H

#include "base/err.h"
#include "lang/parse.h"

#include <stddef.h>
#include <stdio.h>

/* One line: the parse of the sentence `text` that is called `ref`. */
int parses_put(FILE *out, const char *ref, const char *text, const struct parse *p, struct err *e);

struct parse_record {
	char *ref, *text;
	struct parse parse; /* words of the text, then those of the record that the text does not have; no
			       pieces */
};

struct parse_set {
	size_t n;
	struct parse_record *records;
};

/* "-" is stdin. Two records of one ref are an error. */
int parses_read(struct parse_set *s, const char *path, struct err *e);
void parses_free(struct parse_set *s);

/* The record of that ref, or NULL. */
const struct parse_record *parses_find(const struct parse_set *s, const char *ref);

#endif
