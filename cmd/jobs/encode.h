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

/* What is read, and what is made of it. */
struct encoding {
	struct sentences sentences;
	struct vocab vocab;
	struct bert bert;
	struct encoding_tokens { /* all sentences as token ids, [CLS] and [SEP] included */
		struct wordpieces pieces;
		size_t *starts; /* (sentences.n + 1) */
	} tokens;
	struct text text; /* its strings are those of sentences */
};

/* Encodes the sentences of a file with the encoder in the folder `dir`; *x is zeroed before. is_static: the
 * vectors that the vocabulary has, instead of those that the sentence makes of them. Warns of sentences that
 * are too long for the encoder, which are cut. Returns 0, or -1 with *e set; after either encoding_free is in
 * order. */
int encode(struct encoding *x, const char *dir, const char *path, int is_static, const struct report *to,
	struct err *e);
void encoding_free(struct encoding *x);

#endif
