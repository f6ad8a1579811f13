/* parser.safetensors (refer.parser): the weights of the learnt parser. formats/encoders/parser_weights.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "lang/parser_net.h"

int parser_weights_read(struct parser_weights *w, const char *path, struct err *e);
/* Those that come with the program, of all-MiniLM-L6-v2. */
int parser_weights_default(struct parser_weights *w, struct err *e);
/* Matrices are rounded to 127 steps of a row's largest number, vectors to half floats. `source`: what they
 * were learnt from. */
int parser_weights_write(
	const struct parser_weights *w, const char *path, long long seed, const char *source, struct err *e);

/* ERR_FORMAT where a file of the encoder that the weights are of has no words of its middle layer, so that
 * its sentences would be taken apart by grammar alone. middle: those words, or NULL. */
int parser_weights_need_middle(const struct parser_weights *w, const char *path, const float *middle,
	const struct fingerprint *encoder, struct err *e);
