/* A BERT encoder's folder: config.json and safetensors weights, as HuggingFace stores them.
 * formats/encoders/bert_model.md. */
#pragma once

#include "base/err.h"
#include "nn/text_tower.h"

/* What is read of the folder, the tokenizer's files with it. */
#define BERT_MODEL_PARTS "config.json|tokenizer.json|tokenizer_config.json|vocab.txt|*.safetensors"

/* Reads DIR/config.json and DIR/model.safetensors or, where there is none, the only *.safetensors in DIR.
 * Weights may be F32, F16, BF16 or F64. text_tower_free after a failure too. */
int bert_model_read(struct text_tower *b, const char *dir, struct err *e);
