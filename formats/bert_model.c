#include "formats/bert_model.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/json.h"
#include "formats/safetensors.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int config_int(
	const cJSON *config, const char *key, int max, int *out, const char *path, struct err *e)
{
	const cJSON *item = cJSON_GetObjectItemCaseSensitive(config, key);
	double v = cJSON_IsNumber(item) ? item->valuedouble : 0;

	if (!(v >= 1 && v <= max) || v != floor(v))
		return err_set(
			e, ERR_FORMAT, "%s: key '%s' is not a whole number from 1 to %d", path, key, max);
	*out = (int)v;
	return 0;
}

/* A string that must be `wanted` where it is given. */
static int config_is(
	const cJSON *config, const char *key, const char *wanted, const char *path, struct err *e)
{
	const cJSON *item = cJSON_GetObjectItemCaseSensitive(config, key);

	if (!item || (cJSON_IsString(item) && !strcmp(item->valuestring, wanted)))
		return 0;
	return err_set(e, ERR_FORMAT, "%s: key '%s' is not \"%s\"", path, key, wanted);
}

static int config_activation(struct bert *b, const cJSON *config, const char *path, struct err *e)
{
	static const struct {
		const char *name;
		enum bert_activation activation;
	} known[] = {{"gelu", BERT_GELU}, {"gelu_new", BERT_GELU_TANH}, {"gelu_pytorch_tanh", BERT_GELU_TANH},
		{"relu", BERT_RELU}};
	const cJSON *item = cJSON_GetObjectItemCaseSensitive(config, "hidden_act");
	const char *name = cJSON_IsString(item) ? item->valuestring : "";

	for (size_t i = 0; i < sizeof known / sizeof *known; i++)
		if (!strcmp(known[i].name, name)) {
			b->activation = known[i].activation;
			return 0;
		}
	return err_set(e, ERR_FORMAT,
		"%s: key 'hidden_act' is '%s', not gelu, gelu_new, gelu_pytorch_tanh or relu", path, name);
}

static int read_keys(struct bert *b, const cJSON *config, const char *path, struct err *e)
{
	const cJSON *eps = cJSON_GetObjectItemCaseSensitive(config, "layer_norm_eps");

	if (!cJSON_IsObject(config))
		return err_set(e, ERR_FORMAT, "%s: not a JSON object", path);
	if (config_is(config, "model_type", "bert", path, e) ||
		config_is(config, "position_embedding_type", "absolute", path, e) ||
		config_int(config, "vocab_size", 10000000, &b->words, path, e) ||
		config_int(config, "hidden_size", 65536, &b->width, path, e) ||
		config_int(config, "num_hidden_layers", 1000, &b->layer_count, path, e) ||
		config_int(config, "num_attention_heads", 65536, &b->heads, path, e) ||
		config_int(config, "intermediate_size", 1 << 20, &b->inner, path, e) ||
		config_int(config, "max_position_embeddings", 1 << 20, &b->positions, path, e) ||
		config_int(config, "type_vocab_size", 65536, &b->types, path, e) ||
		config_activation(b, config, path, e))
		return -1;
	if (b->width % b->heads)
		return err_set(e, ERR_FORMAT,
			"%s: hidden_size %d is not a multiple of num_attention_heads %d", path, b->width,
			b->heads);
	if (b->positions < 3)
		return err_set(e, ERR_FORMAT, "%s: max_position_embeddings %d leaves no room for words", path,
			b->positions);
	b->eps = eps ? eps->valuedouble : 1e-12;
	if ((eps && !cJSON_IsNumber(eps)) || !(b->eps >= 0 && b->eps <= 1))
		return err_set(e, ERR_FORMAT, "%s: key 'layer_norm_eps' is not a number from 0 to 1", path);
	return 0;
}

static int read_config(struct bert *b, const char *dir, struct err *e)
{
	char *path = file_join(dir, "config.json", "", e);
	cJSON *config = path ? json_read(path, e) : NULL;
	int bad = config ? read_keys(b, config, path, e) : -1;

	cJSON_Delete(config);
	free(path);
	return bad;
}

/* The path of the weights: DIR/model.safetensors or the only *.safetensors. NULL with *e set. */
static char *find_weights(const char *dir, struct err *e)
{
	static const char ending[] = ".safetensors";
	char *path = file_join(dir, "model.safetensors", "", e), *only = NULL;
	size_t count = 0;
	struct dirent *entry;

	if (!path || file_exists(path))
		return path;
	free(path);
	DIR *list = opendir(dir);
	if (!list) {
		err_errno(e, "%s", dir);
		return NULL;
	}
	while ((entry = readdir(list))) {
		size_t len = strlen(entry->d_name);
		if (len < sizeof ending || strcmp(entry->d_name + len - (sizeof ending - 1), ending) ||
			count++)
			continue;
		only = file_join(dir, entry->d_name, "", e);
		if (!only)
			break;
	}
	closedir(list);
	if (count == 1)
		return only;
	free(only);
	if (count)
		err_set(e, ERR_FORMAT, "%s: has %zu *.safetensors files and none is model.safetensors", dir,
			count);
	else
		err_set(e, ERR_SYSTEM, "%s: has no *.safetensors file", dir);
	return NULL;
}

/* Where the tensors come from, and the names that this file gives them. */
struct source {
	struct safetensors st;
	const char *prefix;	   /* "bert." or "" */
	const char *scale, *shift; /* "weight" and "bias"; "gamma" and "beta" in old checkpoints */
	int is_trial;		   /* tensors are looked for, and nothing is read */
	struct err *e;
};

/* The tensor `name`.`part`, a vector of `columns` where rows is 0; NULL with *e set when it is not so. */
static const struct st_tensor *need(
	struct source *s, const char *name, const char *part, int rows, int columns)
{
	char full[256];
	int64_t shape[2] = {rows, columns};

	snprintf(full, sizeof full, "%s%s.%s", s->prefix, name, part);
	const struct st_tensor *t = safetensors_find(&s->st, full);
	int is_other = t && (t->dtype == ST_F16 || t->dtype == ST_BF16 || t->dtype == ST_F64);
	return safetensors_need(
		&s->st, full, is_other ? t->dtype : ST_F32, rows ? 2 : 1, rows ? shape : shape + 1, s->e);
}

static int load(struct source *s, const char *name, const char *part, float *out, int rows, int columns)
{
	const struct st_tensor *t = need(s, name, part, rows, columns);
	size_t count = (size_t)columns * (rows ? (size_t)rows : 1);

	if (!t || (!s->is_trial && safetensors_to_float(t, out, count, s->e)))
		return -1;
	if (s->is_trial)
		return 0;
	for (size_t i = 0; i < count; i++)
		if (!isfinite(out[i]))
			return err_set(s->e, ERR_FORMAT, "%s: tensor '%s': item %zu is not finite",
				s->st.path, t->name, i);
	return 0;
}

static int load_linear(
	struct source *s, const char *layer, const char *name, const struct bert_linear *l, int in, int out)
{
	char full[128];

	snprintf(full, sizeof full, "%s%s", layer, name);
	return load(s, full, "weight", l->weight, out, in) || load(s, full, "bias", l->bias, 0, out) ? -1 : 0;
}

static int load_norm(
	struct source *s, const char *layer, const char *name, const struct bert_norm *n, int width)
{
	char full[128];

	snprintf(full, sizeof full, "%s%s", layer, name);
	return load(s, full, s->scale, n->scale, 0, width) || load(s, full, s->shift, n->shift, 0, width) ? -1
													  : 0;
}

static int load_layer(struct source *s, const struct bert *b, int i)
{
	static const struct bert_layer none;
	const struct bert_layer *l = s->is_trial ? &none : &b->layers[i];
	int width = b->width;
	char at[64];

	snprintf(at, sizeof at, "encoder.layer.%d.", i);
	int bad = load_linear(s, at, "attention.self.query", &l->query, width, width) ||
		  load_linear(s, at, "attention.self.key", &l->key, width, width) ||
		  load_linear(s, at, "attention.self.value", &l->value, width, width) ||
		  load_linear(s, at, "attention.output.dense", &l->attention_out, width, width) ||
		  load_norm(s, at, "attention.output.LayerNorm", &l->attention_norm, width) ||
		  load_linear(s, at, "intermediate.dense", &l->inner, width, b->inner) ||
		  load_linear(s, at, "output.dense", &l->outer, b->inner, width) ||
		  load_norm(s, at, "output.LayerNorm", &l->norm, width);
	return bad ? -1 : 0;
}

static void find_names(struct source *s)
{
	if (safetensors_find(&s->st, "bert.embeddings.word_embeddings.weight"))
		s->prefix = "bert.";
	if (safetensors_find(
		    &s->st, *s->prefix ? "bert.embeddings.LayerNorm.gamma" : "embeddings.LayerNorm.gamma")) {
		s->scale = "gamma";
		s->shift = "beta";
	}
}

static int load_tensors(struct source *s, const struct bert *b)
{
	if (load(s, "embeddings.word_embeddings", "weight", b->word, b->words, b->width) ||
		load(s, "embeddings.position_embeddings", "weight", b->position, b->positions, b->width) ||
		load(s, "embeddings.token_type_embeddings", "weight", b->type, b->types, b->width) ||
		load_norm(s, "", "embeddings.LayerNorm", &b->norm, b->width))
		return -1;
	for (int i = 0; i < b->layer_count; i++)
		if (load_layer(s, b, i))
			return -1;
	return 0;
}

/* That the file has all tensors is known before memory is taken for them. */
static int load_all(struct source *s, struct bert *b)
{
	find_names(s);
	s->is_trial = 1;
	if (load_tensors(s, b) || bert_alloc(b, s->e))
		return -1;
	s->is_trial = 0;
	return load_tensors(s, b);
}

int bert_model_read(struct bert *b, const char *dir, struct err *e)
{
	struct source s = {.prefix = "", .scale = "weight", .shift = "bias", .e = e};
	int bad = -1;

	*b = (struct bert){0};
	if (read_config(b, dir, e))
		return -1;
	char *path = find_weights(dir, e);
	if (path && !safetensors_open(&s.st, path, e)) {
		bad = load_all(&s, b);
		safetensors_close(&s.st);
	}
	free(path);
	if (bad)
		bert_free(b);
	return bad ? -1 : 0;
}
