/* What the readers of encoders' folders share: keys of a configuration and tensors of the weights, with
 * messages that name them. formats/encoders/bert_model.md, formats/encoders/clip_model.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/safetensors.h"
#include "nn/text_tower.h"

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

/* How a program names the tensors of a tower, after a prefix. Layers' begin with `layer` and their number. */
struct pretrained_names {
	const char *prefix, *word, *position, *type, *layer, *norm,
		*projection;	  /* type NULL: there is none */
	const char *attention[3]; /* of a layer: query, key and value; where the third is NULL all in one */
	const char *attention_norm, *attention_out, *inner, *outer, *feed_norm;
};

/* Where tensors come from. */
struct pretrained {
	struct safetensors st;
	const char *prefix;
	const struct pretrained_names *names;
	const char *scale, *shift; /* of a norm: ".weight" and ".bias" */
	struct err *e;
};

/* The numbers of a tensor, all of them finite, into out (rows,columns), or (columns) where rows is 0. Where
 * out is NULL the tensor is only looked for: so a reader looks for all of them before it takes memory. */
int pretrained_load(struct pretrained *from, const char *name, float *out, int rows, int columns);

/* All of a tower but the projection, in the same way: only looked for, before t has memory but for its
 * layers. Half floats of its large matrices are checked then, and used where they lie. */
int pretrained_tower(struct pretrained *from, struct text_tower *t);

/* Closes from->st, but for the file's map, which the tower keeps. */
int pretrained_close(struct pretrained *from, struct text_tower *t);
