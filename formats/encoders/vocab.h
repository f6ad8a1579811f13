/* The vocabulary of an uncased BERT: tokenizer.json or vocab.txt. formats/encoders/vocab.md. */
#pragma once

#include "base/err.h"
#include "nn/wordpiece.h"

#include <cjson/cJSON.h>

/* Reads DIR/tokenizer.json or, where there is none, DIR/vocab.txt (with tokenizer_config.json, if it is
 * there). Tokenizers that wordpiece_encode does not do are refused. vocab_free after a failure too. */
int vocab_read(struct vocab *v, const char *dir, struct err *e);

/* Adds the tokens of a JSON object, token to id. Returns 0, or -1 with *e. */
int vocab_add_all(struct vocab *v, const cJSON *tokens, const char *path, struct err *e);

/* n ids of the vocabulary written out as tokens with a space between; free() it. NULL when memory is out. */
char *vocab_print(const struct vocab *v, const int32_t *ids, size_t n, struct err *e);
