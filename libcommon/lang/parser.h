/* Takes sentences apart, by what was learnt on the encoder's word vectors, or on closed-class words alone. */
#pragma once

#include "lang/analysis.h"

struct parser_weights; /* lang/parser_net.h */

struct parser {
	const struct parser_weights *weights;
	const char *const *known; /* words spelt right besides the closed ones: a scene's vocabulary */
	int known_count;
	unsigned without;	  /* rules that do not count (lang/rules.h); 0 */
	const char *encoder;	  /* fingerprint of what made the vectors; NULL or "": not known */
	struct parser_memo *memo; /* what it learns of sentences that come again; NULL: nothing */
};

/* What a parser's network said of sentences, by where their texts are: these must stay, and the parser's
 * words and weights be the same. By one thread at a time. */
struct parser_memo {
	size_t n, capacity;
	struct parser_memory *items; /* owned; parser_memo_free */
};
void parser_memo_free(struct parser_memo *m);

/* What the encoder's middle layer made of the sentence; zeroed where there is none. What a word is to its
 * neighbours is told in the middle of an encoder, what a sentence means at its end: pipelines/parse.md. */
struct parser_vectors {
	const char *pieces;   /* its word pieces with a space between */
	const float *vectors; /* (count, width); NULL: none */
	int count, width;
};

/* No sentence is refused: what the parser cannot place is `unexplained`. -1 only where memory is out. Without
 * vectors, or with vectors of another width or encoder than the weights', their network `grammar` speaks. */
int parse_sentence(struct parse *p, const struct parser *parser, const char *text,
	const struct parser_vectors *v, struct err *e);
