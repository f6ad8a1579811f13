/* Sentences to word vectors by a language encoder: text-encode. formats/scene/text.md. */
#ifndef CMD_TEXT_ENCODE_H
#define CMD_TEXT_ENCODE_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/text/encoder.h"
#include "formats/records/sentences.h"
#include "formats/scene/text.h"
#include "nn/wordpiece.h"

#include <stddef.h>

/* Sentences, and what is made of them. */
struct encoding {
	struct sentences sentences;
	struct encoding_tokens { /* all sentences as token ids, those that begin and end one included */
		struct wordpieces pieces;
		size_t *starts; /* (sentences.n + 1) */
	} tokens;
	struct text text; /* its strings are those of sentences */
};

/* Reads x->sentences: sentences_read_any's, or the names of the objects of mask records as training
 * sentences. Returns 0, or -1 with *e set; after either encoding_free is in order. */
int encoding_read(struct encoding *x, const char *path, int is_of_masks, struct err *e);

/* Encodes x->sentences, which the caller has set; the rest is zeroed before. Warns of sentences that are too
 * long for the encoder, which are cut. Returns 0, or -1 with *e set; after either encoding_free is in order.
 */
int encode(struct encoding *x, const struct encoder *with, const struct report *to, struct err *e);
void encoding_free(struct encoding *x);

#endif
