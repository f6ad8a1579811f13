/* Sentences to word vectors by a BERT encoder: text-encode. formats/text.md. */
#ifndef CMD_JOBS_ENCODE_H
#define CMD_JOBS_ENCODE_H

#include "base/err.h"
#include "base/report.h"
#include "formats/sentences.h"
#include "formats/text.h"
#include "nn/bert.h"
#include "nn/wordpiece.h"

#include <stddef.h>

/* A BERT and its vocabulary. */
struct encoder {
	struct vocab vocab;
	struct bert bert;
	int is_static; /* vectors as the vocabulary has them, not as the sentence makes them */
	struct fingerprint fingerprint; /* of all of it */
};

/* Where `make encoder` puts an encoder: refersplat/encoder in $XDG_CACHE_HOME or ~/.cache. free() it; NULL
 * with *e set, also where there is none. */
char *encoder_default(struct err *e);

/* Reads the encoder in the folder `dir`; *x is zeroed before. Returns 0, or -1 with *e set; encoder_free
 * after either. */
int encoder_read(struct encoder *x, const char *dir, int is_static, struct err *e);
void encoder_free(struct encoder *x);

/* Sentences, and what is made of them. */
struct encoding {
	struct sentences sentences;
	struct encoding_tokens { /* all sentences as token ids, [CLS] and [SEP] included */
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
