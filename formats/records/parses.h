/* parses.jsonl: sentences taken apart, one a line (JSON Lines). formats/records/parses.md. */
#ifndef FORMATS_PARSES_H
#define FORMATS_PARSES_H

#include "base/err.h"
#include "lang/parse.h"

#include <stdio.h>

/* One line: the parse of the sentence `text` that is called `ref`. */
int parses_put(FILE *out, const char *ref, const char *text, const struct parse *p, struct err *e);

#endif
