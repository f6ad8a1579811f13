/* What the readers of encoders' folders share: keys of a configuration and tensors of the weights, with
 * messages that name them. formats/encoders/bert_model.md, formats/encoders/clip_model.md. */
#ifndef FORMATS_PRETRAINED_H
#define FORMATS_PRETRAINED_H

#include "base/err.h"
#include "formats/arrays/safetensors.h"
#include "nn/transformer.h"

#include <cjson/cJSON.h>

/* A whole number from 1 to max; `usual` where the key is absent, 0: it must be there. Returns 0, or -1 with
 * *e ("path: key 'k' ..."), as the others. */
int pretrained_int(
	const cJSON *config, const char *key, int max, int usual, int *out, const char *path, struct err *e);

/* A string that must be `wanted` where it is given. */
int pretrained_is(const cJSON *config, const char *key, const char *wanted, const char *path, struct err *e);

/* hidden_act, one of the names in `known`, which `list` has for the message; `usual`: a name, or NULL. */
struct pretrained_activation {
	const char *name;
	enum transformer_activation activation;
};
int pretrained_activation(const cJSON *config, const struct pretrained_activation *known, size_t n,
	const char *list, const char *usual, enum transformer_activation *out, const char *path,
	struct err *e);

/* layer_norm_eps, 0 to 1; `usual` where it is absent. */
int pretrained_eps(const cJSON *config, double usual, double *out, const char *path, struct err *e);

/* Whether heads divide the width (key names for the message), and `positions` leave room for words. */
int pretrained_sizes(const struct transformer *t, int positions, const char *const names[3], const char *path,
	struct err *e);

/* The weights of the folder `dir`: `first`, unless it is NULL or not there, else model.safetensors or the
 * only *.safetensors. Close with safetensors_close. */
int pretrained_open(struct safetensors *st, const char *dir, const char *first, struct err *e);

/* The tensor, of floats of any size: (rows,columns), or (columns) where rows is 0. NULL with *e. */
const struct st_tensor *pretrained_need(
	const struct safetensors *st, const char *name, int rows, int columns, struct err *e);

/* Its numbers, all of them finite, into out (rows,columns). Where out is NULL the tensor is only looked for,
 * as by pretrained_need: so a reader looks for all of them before it takes memory for them. */
int pretrained_load(
	const struct safetensors *st, const char *name, float *out, int rows, int columns, struct err *e);

/* The part of a tensor that begins at row `first` of (of,columns), or at place `first` of (of) where columns
 * is 0: its next `rows`. */
int pretrained_load_part(const struct safetensors *st, const char *name, float *out, int of, int first,
	int rows, int columns, struct err *e);

#endif
