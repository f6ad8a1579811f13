/* The two lines of words under an overlay: the sentence, and the answer. */
#ifndef CMD_RENDER_OVERLAY_WORDS_H
#define CMD_RENDER_OVERLAY_WORDS_H

#include "cmd/render/request.h"

#include <stddef.h>

/* out: of the request's sentence i, with the score that its mask has, what was answered: the names of a
 * lifted model's things, and whether they are the ones that the sentence's record names, where the model
 * knows these. What has no room is cut. */
void overlay_words(const struct request *r, size_t i, double score, char *out, size_t size);

#endif
