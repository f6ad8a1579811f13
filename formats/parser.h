/* parser.safetensors (refer.parser): the weights of the learnt parser. formats/parser.md. */
#ifndef FORMATS_PARSER_H
#define FORMATS_PARSER_H

#include "base/err.h"
#include "lang/parser_net.h"

int parser_read(struct parser_weights *w, const char *path, struct err *e);
/* Stored as half floats. `source`: what they were learnt from. */
int parser_write(const struct parser_weights *w, const char *path, const char *options, long long seed,
	const char *source, struct err *e);

#endif
