#include "lang/parser.h"

#include "base/mem.h"
#include "lang/parser_net.h"

#include <stdlib.h>
#include <string.h>

static int learnt_analyse(struct analysis *a, const struct tokens *t, const struct parser *parser,
	const struct parser_vectors *v, double *sure, struct err *e)
{
	const struct parser_weights *w = parser->weights;
	struct parser_batch b;
	struct parser_features features[TOKENS_MOST];
	float *vectors;

	if (parser_batch_make(&b, t->n, 1, w, e))
		return -1;
	vectors = mem_alloc((size_t)t->n, sizeof *vectors * (size_t)w->width, "word vectors", e);
	if (vectors) {
		parser_vectors_of_words(t, v->vectors, v->count, w->width, vectors);
		parser_features_take(features, t);
		parser_batch_add(&b, features, vectors, t->n, w->width);
		parser_forward(w, &b);
		parser_decode(w, &b, 0, t, a, sure);
	}
	free(vectors);
	parser_batch_free(&b);
	return vectors ? 0 : -1;
}

/* 1 where the weights were learnt on vectors such as these. */
static int are_mine(const struct parser *parser, const struct parser_vectors *v)
{
	const struct parser_weights *w = parser->weights;

	if (!w || !v || !v->vectors || v->width != w->width)
		return 0;
	return !w->encoder[0] || !parser->encoder || !parser->encoder[0] ||
	       !strcmp(w->encoder, parser->encoder);
}

int parse_sentence(struct parse *p, const struct parser *parser, const char *text,
	const struct parser_vectors *v, struct err *e)
{
	struct tokens t;
	struct analysis a;
	double sure = 1;

	tokens_take(&t, text, v ? v->pieces : NULL, parser->known, parser->known_count);
	if (!are_mine(parser, v) || !t.n)
		grammar_analyse(&a, &t);
	else if (learnt_analyse(&a, &t, parser, v, &sure, e))
		return -1;
	analysis_apply_rules(&a, &t, parser->without);
	if (parse_build(p, &a, &t, parser->without, e))
		return -1;
	p->confidence *= sure;
	return 0;
}
