/* The weights of the detector of box-detect, in a folder. formats/encoders/nanodet_model.md. */
#pragma once

#include "base/err.h"
#include "nn/nanodet.h"

/* What is read of the folder. */
#define NANODET_MODEL_PARTS "*.safetensors"

/* Of a zeroed *n. Returns 0, or -1 with *e; nanodet_free after either. */
int nanodet_model_read(struct nanodet *n, const char *dir, struct err *e);
