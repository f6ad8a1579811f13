/* Sentences to word vectors by a language encoder: text-encode. formats/scene/text.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/arrays/fingerprint.h"
#include "formats/encoders/bert_model.h"
#include "formats/encoders/clip_model.h"
#include "formats/records/sentences.h"
#include "formats/scene/text.h"
#include "nn/bpe.h"
#include "nn/wordpiece.h"

/* Where make puts what it fetches. */

/* refersplat/NAME in $XDG_CACHE_HOME or ~/.cache, whether it is there or not. free() it; NULL with *e set
 * (ERR_USAGE: HOME is not set). */
char *cache_folder(const char *name, struct err *e);

/* The same of the "encoder" or the "detector", which `make encoder` and `make detector` put there: an error
 * (ERR_SYSTEM) where it is not there. */
char *cached_model(const char *what, struct err *e);

/* A language encoder, of one of two kinds: a BERT or CLIP's text tower, with its vocabulary. */

/* What is read of an encoder's folder. */
#define ENCODER_PARTS BERT_MODEL_PARTS "|" CLIP_MODEL_PARTS

struct encoder {
	int is_clip; /* bpe, else vocab */
	struct vocab vocab;
	struct bpe bpe;
	struct text_tower tower;
	int is_static; /* vectors as the vocabulary has them, not as the sentence makes them */
	struct fingerprint fingerprint; /* of all of it */
};

/* Reads the encoder in the folder `dir`; *x is zeroed before. Returns 0, or -1 with *e set; encoder_free
 * after either. */
int encoder_read(struct encoder *x, const char *dir, int is_static, struct err *e);
void encoder_free(struct encoder *x);

/* Columns of its vectors. */
int encoder_width(const struct encoder *x);

/* The most tokens of a sentence, with the one that begins it and the one that ends it. */
size_t encoder_positions(const struct encoder *x);
int32_t encoder_first(const struct encoder *x);
int32_t encoder_last(const struct encoder *x);

/* Whether a sentence's vector is that of its first encoder_last, and not the mean of its words. */
int encoder_pools(const struct encoder *x);

/* Appends the tokens of a text, without first and last. Returns 0, or -1 with *e set. */
int encoder_cut(const struct encoder *x, const char *text, struct wordpieces *out, struct err *e);

/* n tokens written out, with a space between; free() it. NULL with *e set. */
char *encoder_print(const struct encoder *x, const int32_t *ids, size_t n, struct err *e);

/* Whether it says what its middle layer makes of a word, which is what sentences are taken apart by: a BERT
 * does. */
int encoder_has_middle(const struct encoder *x);

/* As text_tower_forward, or what the vocabulary has where x->is_static. middle is NULL where it is not
 * wanted, or where there is none. */
void encoder_forward(const struct encoder *x, const int32_t *ids, const size_t *starts, size_t n, float *out,
	float *middle, float *scratch);

/* Sentences, and what is made of them. */
struct encoding {
	struct sentences sentences;
	struct encoding_tokens { /* all sentences as token ids, those that begin and end one included */
		struct wordpieces pieces;
		size_t *starts; /* (sentences.n + 1) */
	} tokens;
	struct text text;
};

/* Reads x->sentences: sentences_read_any's, or the names of the objects of mask records as training
 * sentences. Returns 0, or -1 with *e set; after either encoding_free is in order. */
int encoding_read(struct encoding *x, const char *path, int is_of_masks, struct err *e);

/* Encodes x->sentences, which the caller has set; the rest is zeroed before. Warns of sentences that are too
 * long for the encoder, which are cut. Returns 0, or -1 with *e set; after either encoding_free is in order.
 */
int encode(struct encoding *x, const struct encoder *with, const struct report *to, struct err *e);
void encoding_free(struct encoding *x);
