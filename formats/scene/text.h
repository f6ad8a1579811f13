/* text.safetensors (refer.text): a sentence's word vectors from the encoder. formats/scene/text.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "geom/camera.h"

#include <stdint.h>

struct text {
	size_t n;	  /* R sentences */
	int width;	  /* D_text */
	int64_t *offsets; /* (n+1): sentence r has words offsets[r] to offsets[r+1] */
	float *words;	  /* (offsets[n], width), tokens that begin and end a sentence left out */
	float *middle;	  /* of the shape of words: of the encoder's middle layer, which a sentence is taken
			     apart    by; NULL where the file has none */
	float *sentences; /* (n, width), mean of the words, zero for a sentence without words; or CLIP's */
	char **refs, **objects, **texts; /* objects: "" where several are meant, or none */
	char **pieces; /* (n) word pieces with a space between, one for each word; NULL where the file has
			  none */
	enum camera_split *splits;
	struct fingerprint encoder; /* what made the words */
	/* What sentences that say more than their object's name say (formats/records/sentences.md). (n) each,
	 * NULL where no sentence of the file says it. */
	char **object_lists; /* a JSON list of the names of the objects meant; "" where the sentence has none
			      */
	char **views, **kinds; /* "" where the sentence has none */
};

int text_read(struct text *t, const char *path, struct err *e);
int text_write(const struct text *t, const char *path, const char *options, struct err *e);
void text_free(struct text *t);

/* The words of a sentence by the middle layer; NULL where the file has none. */
const float *text_middle(const struct text *t, size_t sentence);

/* The name that a sentence's masks and boxes go by; NULL where it means several objects or none. */
const char *text_object(const struct text *t, size_t sentence);

/* Sets chosen[r] (n) to 1 for the refs in a comma-separated list, the value of an option. 0, or -1 with *e:
 * ERR_USAGE for a ref that no sentence has. */
int text_mark(const struct text *t, const char *list, const char *option, char *chosen, struct err *e);
