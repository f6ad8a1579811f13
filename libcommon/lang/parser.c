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

/* Where what is said begins anew after "no, wait" or "scratch that" that ends before word i; else 0. */
static int corrected_at(const struct tokens *t, int i)
{
	static const char *const sorry[] = {"sorry", "correction", "oops", NULL};
	static const char *const no[] = {"no", "nope", NULL};
	const int is_wait = (tokens_is_any(t, i - 2, no) && tokens_is(t, i - 1, "wait")) ||
			    (tokens_is(t, i - 2, "wait") && tokens_is_any(t, i - 1, no));

	return i > 2 && (is_wait || tokens_is_any(t, i - 1, sorry) ||
				(tokens_is(t, i - 2, "scratch") && tokens_is(t, i - 1, "that")));
}

/* Who corrects himself means what he says last. */
static void take_correction(struct tokens *t)
{
	int from = 0;

	for (int i = 3; i + 2 <= t->n; i++)
		from = corrected_at(t, i) ? i : from;
	memmove(t->word, t->word + from, sizeof *t->word * (size_t)(t->n - from));
	t->n -= from;
}

int parse_sentence(struct parse *p, const struct parser *parser, const char *text,
	const struct parser_vectors *v, struct err *e)
{
	struct tokens t;
	struct analysis a, grammar;
	double sure = 1;

	tokens_take(&t, text, v ? v->pieces : NULL, parser->known, parser->known_count);
	take_correction(&t);
	grammar_analyse(&grammar, &t);
	if (!are_mine(parser, v) || !t.n)
		a = grammar;
	else if (learnt_analyse(&a, &t, parser, v, &sure, e))
		return -1;
	analysis_mend(&a, &grammar, &t);
	if (parse_build(p, &a, &t, e))
		return -1;
	p->confidence *= sure;
	return 0;
}
