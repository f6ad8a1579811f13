#include "lang/parser.h"

#include "base/mem.h"
#include "lang/parser_net.h"

#include <string.h>

static int analyse(struct analysis *a, const struct tokens *t, const struct parser_weights *w,
	const struct parser_vectors *v, double *sure, struct err *e)
{
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

/* The weights where they were learnt on vectors such as these, else those of grammar alone. */
static const struct parser_weights *weights_for(const struct parser *parser, const struct parser_vectors *v)
{
	const struct parser_weights *w = parser->weights;
	const int is_known = w->encoder[0] && parser->encoder && parser->encoder[0];

	if (!v->vectors || v->width != w->width)
		return w->grammar;
	return is_known && strcmp(w->encoder, parser->encoder) ? w->grammar : w;
}

struct parser_memory {
	const char *text;
	int known_count;
	double sure;
	struct analysis said;
};

void parser_memo_free(struct parser_memo *m)
{
	free(m->items);
	*m = (struct parser_memo){0};
}

/* analyse(), or what it said before. */
static int analyse_once(struct analysis *a, const struct tokens *t, const struct parser *parser,
	const char *text, const struct parser_vectors *v, double *sure, struct err *e)
{
	struct parser_memo *m = parser->memo;

	for (size_t i = 0; m && i < m->n; i++)
		if (m->items[i].text == text && m->items[i].known_count == parser->known_count) {
			*a = m->items[i].said;
			*sure = m->items[i].sure;
			return 0;
		}
	if (analyse(a, t, weights_for(parser, v), v, sure, e) ||
		(m && mem_grow((void **)&m->items, &m->capacity, m->n + 1, sizeof *m->items, "sentences", e)))
		return -1;
	if (m)
		m->items[m->n++] = (struct parser_memory){text, parser->known_count, *sure, *a};
	return 0;
}

int parse_sentence(struct parse *p, const struct parser *parser, const char *text,
	const struct parser_vectors *v, struct err *e)
{
	const struct parser_vectors none = {0};
	struct analysis a = {0};
	struct tokens t;
	double sure = 1;

	v = v ? v : &none;
	tokens_take(&t, text, v->pieces, parser->known, parser->known_count);
	if (t.n && analyse_once(&a, &t, parser, text, v, &sure, e))
		return -1;
	analysis_apply_rules(&a, &t, parser->without);
	if (parse_build(p, &a, &t, parser->without, e))
		return -1;
	p->confidence *= sure;
	return 0;
}
