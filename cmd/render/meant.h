/* What a sentence's record says that it means, and whether an answer is that. */
#ifndef CMD_RENDER_MEANT_H
#define CMD_RENDER_MEANT_H

#include "formats/scene/text.h"
#include "lift/lifted_model.h"

#include <cjson/cJSON.h>

/* The names that a sentence's record has for what it means; cJSON_Delete. NULL where it says nothing. */
cJSON *meant_names(const struct text *t, size_t sentence);

/* 1 where the names answered are those meant and no others, 0 where they are not, -1 where nothing is said
 * (meant is NULL) or the model does not have all that is meant. */
int meant_is(const cJSON *meant, const struct lifted *l, const cJSON *answered);

#endif
