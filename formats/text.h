/* text.safetensors (refer.text): a sentence's word vectors from the language encoder. formats/text.md. */
#ifndef FORMATS_TEXT_H
#define FORMATS_TEXT_H

#include "base/err.h"
#include "geom/camera.h"

#include <stddef.h>
#include <stdint.h>

struct text {
	size_t n;	  /* R sentences */
	int width;	  /* D_text */
	int64_t *offsets; /* (n+1): sentence r has words offsets[r] to offsets[r+1] */
	float *words;	  /* (offsets[n], width), [CLS] and [SEP] left out */
	float *sentences; /* (n, width), mean of the words; zero for a sentence without words */
	char **refs, **objects, **texts;
	char **pieces; /* (n) word pieces with a space between, one for each word; NULL where the file has
			  none */
	enum camera_split *splits;
};

int text_read(struct text *t, const char *path, struct err *e);
int text_write(const struct text *t, const char *path, const char *options, struct err *e);
/* sentences from words. ERR_FORMAT, with the ref, where one is not finite. */
int text_take_means(struct text *t, struct err *e);
void text_free(struct text *t);

/* Sets chosen[r] (n) to 1 for the refs in a comma-separated list, the value of an option. 0, or -1 with *e:
 * ERR_USAGE for a ref that no sentence has. */
int text_mark(const struct text *t, const char *list, const char *option, char *chosen, struct err *e);

#endif
