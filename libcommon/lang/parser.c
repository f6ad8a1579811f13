#include "lang/parser.h"

int parse_sentence(struct parse *p, const struct parser *parser, const char *text,
	const struct parser_vectors *v, struct err *e)
{
	struct tokens t;
	struct analysis a;

	tokens_take(&t, text, parser->known, parser->known_count);
	if (v && v->pieces)
		tokens_pieces(&t, text, v->pieces);
	grammar_analyse(&a, &t);
	return parse_build(p, &a, &t, e);
}
