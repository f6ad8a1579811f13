/* parses.jsonl: sentences taken apart, one a line (JSON Lines). formats/records/parses.md. */
#pragma once

#include "base/err.h"
#include "lang/parse.h"

#include <stdio.h>

/* One line: the parse of the sentence `text` that is called `ref`. */
int parses_put(FILE *out, const char *ref, const char *text, const struct parse *p, struct err *e);

/* Which relations a sentence speaks of, anywhere in its parse: a bit 1 << enum parse_relation for each. */
struct parse_relations {
	char *ref; /* unique in the file */
	unsigned set;
};

/* That of every sentence of a file ("-" is stdin). 0, or -1 with *e: "path:LINE: reason". parses_free frees
 * after either. */
struct parses {
	size_t n;
	struct parse_relations *items;
};
int parses_read(struct parses *p, const char *path, struct err *e);
void parses_free(struct parses *p);
