/* The weights of the detector of box-detect, in a folder. formats/encoders/nanodet_model.md. */
#pragma once

#include "base/err.h"
#include "nn/nanodet.h"

/* What is read of the folder. */
#define NANODET_MODEL_PARTS "*.safetensors"

/* Returns 0 and *n (nanodet_free), or -1 with *e, and then there is nothing to free. */
int nanodet_model_read(struct nanodet *n, const char *dir, struct err *e);
