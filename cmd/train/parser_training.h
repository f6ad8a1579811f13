/* The weights of text-parse, learnt from sentences with marks (formats/records/marked.md): parse-train. */
#pragma once

#include "base/err.h"
#include "base/report.h"

struct parser_training_options {
	const char *marked; /* sentences with marks */
	const char *text;   /* the same, encoded */
	const char *output;
	const char *source; /* what the weights say that they were learnt from */
	long long epochs, seed;
	long long members; /* networks, whose scores are averaged */
};

/* Learns, and writes the weights. Returns 0, or -1 with *e set. */
int parser_train(const struct parser_training_options *o, const struct report *to, struct err *e);

/* Writes the sentences of a file of marked ones (JSON Lines), or the parses that their marks stand for
 * (formats/records/parses.md), whose words are spelt as where they were encoded (NULL: as without an
 * encoder). Likewise. */
int parser_marked_write(
	const char *marked, const char *encoded, int is_parses, const char *output, struct err *e);
