#include "cmd/text/text_query.h"

#include "base/file.h"

int text_query(const struct text *t, const char *path, const struct parser_weights *weights, struct query *q,
	struct err *e)
{
	const struct query_text from = {t->n, t->width, t->offsets, t->words, t->middle, t->texts, t->pieces};
	const struct parser parser = {.weights = weights, .encoder = t->encoder.hex};

	*q = (struct query){0};
	if (!t->pieces)
		return err_set(e, ERR_FORMAT,
			"%s: no word pieces, which parses need: encode its sentences again", file_name(path));
	return parser_weights_need_middle(weights, file_name(path), t->middle, &t->encoder, e) ||
			       query_make(q, &from, &parser, e)
		       ? -1
		       : 0;
}
