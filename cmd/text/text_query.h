/* What stands for encoded sentences in a trained field that goes by parses. */
#pragma once

#include "field/query.h"
#include "formats/encoders/parser_weights.h"
#include "formats/scene/text.h"

/* Of all sentences of a text, whose path is for messages. ERR_FORMAT where it has nothing to parse by.
 * Returns 0, or -1 with *e set; query_free after either. */
int text_query(const struct text *t, const char *path, const struct parser_weights *weights, struct query *q,
	struct err *e);
