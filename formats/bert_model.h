/* A BERT encoder's folder: config.json and safetensors weights, as HuggingFace stores them.
 * formats/bert_model.md. */
#ifndef FORMATS_BERT_MODEL_H
#define FORMATS_BERT_MODEL_H

#include "base/err.h"
#include "nn/bert.h"

/* Reads DIR/config.json and DIR/model.safetensors or, where there is none, the only *.safetensors in DIR.
 * Weights may be F32, F16, BF16 or F64. Release with bert_free. */
int bert_model_read(struct bert *b, const char *dir, struct err *e);

#endif
