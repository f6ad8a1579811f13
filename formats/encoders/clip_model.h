/* The folder of a CLIP's text tower: a configuration and safetensors weights, as HuggingFace or OpenCLIP
 * stores them. formats/encoders/clip_model.md. */
#pragma once

#include "base/err.h"
#include "nn/text_tower.h"

/* What is read of the folder beside what a BERT has (BERT_MODEL_PARTS), the tokenizer's files with it. */
#define CLIP_MODEL_PARTS "open_clip_config.json|vocab.json|merges.txt|*.txt.gz"

/* Whether the folder's config.json is of a CLIP, or it has an open_clip_config.json. */
int clip_model_is(const char *dir);

/* Reads the configuration, and the weights as bert_model_read. text_tower_free after a failure too. */
int clip_model_read(struct text_tower *c, const char *dir, struct err *e);
