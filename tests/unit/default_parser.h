/* A parser of text-parse's own weights, which takes sentences apart by closed words where they have no
 * vectors. */
#pragma once

#include "base/err.h"
#include "formats/encoders/parser_weights.h"
#include "lang/parser.h"
#include "lang/parser_net.h"

#include <stdio.h>
#include <stdlib.h>

static inline struct parser default_parser(void)
{
	static struct parser_weights w;
	struct err e;

	if (!w.slab && parser_weights_default(&w, &e)) {
		fprintf(stderr, "%s\n", e.message);
		exit(1);
	}
	return (struct parser){.weights = &w};
}
