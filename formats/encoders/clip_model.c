#include "formats/encoders/clip_model.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/encoders/pretrained.h"
#include "formats/records/json.h"

#include <stdio.h>

#define OPEN_CLIP "open_clip_config.json"
static const char *const names[] = {"hidden_size", "num_attention_heads", "max_position_embeddings"};

static int is_of_clip(const cJSON *config)
{
	const cJSON *type = json_get(config, "model_type");

	return json_is(type, "clip") || json_is(type, "clip_text_model");
}

/* Whether a file is a configuration of a CLIP as HuggingFace writes it. */
static int is_config(const char *path)
{
	struct err e = {0};
	SCOPED_BY(json_release) cJSON *config = file_exists(path) ? json_read(path, &e) : NULL;

	return is_of_clip(config);
}

/* DIR/config.json, where it is of a CLIP, or DIR/open_clip_config.json, where there is one; *is_open says
 * which. NULL with *e set where there is neither. */
static char *find_config(const char *dir, int *is_open, struct err *e)
{
	char *usual = file_join(dir, "config.json", "", e), *other = file_join(dir, OPEN_CLIP, "", e);
	const int is_usual = usual && is_config(usual);

	*is_open = !is_usual && usual && other && file_exists(other);
	if (usual && other && !is_usual && !*is_open)
		err_file(e, usual, "key 'model_type' is not \"clip\" or \"clip_text_model\"");
	free(is_usual ? other : usual);
	if (is_usual || *is_open)
		return is_usual ? usual : other;
	free(other);
	return NULL;
}

int clip_model_is(const char *dir)
{
	struct err e = {0};
	int is_open;
	SCOPED char *path = find_config(dir, &is_open, &e);
	return path != NULL;
}

/* What a configuration says beside the sizes. */
struct kind {
	int is_projected; /* the weights must have a projection */
	int width;	  /* of it */
	int is_open;	  /* the configuration is OpenCLIP's */
};

static int read_activation(struct text_tower *c, const cJSON *config, const char *path, struct err *e)
{
	static const struct pretrained_activation known[] = {
		{"quick_gelu", TRANSFORMER_QUICK_GELU}, {"gelu", TRANSFORMER_GELU}};

	return pretrained_activation(
		config, known, 2, "quick_gelu or gelu", "quick_gelu", &c->body.activation, path, e);
}

/* HuggingFace's: of the text tower alone, or of both with the text tower's in `text_config`. Keys that are
 * absent have the values of CLIP ViT-B/32. */
static int read_keys(
	struct text_tower *c, struct kind *kind, const cJSON *config, const char *path, struct err *e)
{
	const cJSON *nested = json_get(config, "text_config"),
		    *text = cJSON_IsObject(nested) ? nested : config;
	const cJSON *own = json_get(config, "projection_dim");
	struct transformer *t = &c->body;

	kind->is_projected = json_is(json_get(config, "model_type"), "clip") ||
			     json_is(cJSON_GetArrayItem(json_get(config, "architectures"), 0),
				     "CLIPTextModelWithProjection");
	return -(pretrained_int(text, "vocab_size", 10000000, 49408, &c->words, path, e) ||
		 pretrained_int(text, names[0], 65536, 512, &t->width, path, e) ||
		 pretrained_int(text, "num_hidden_layers", 1000, 12, &t->layer_count, path, e) ||
		 pretrained_int(text, names[1], 65536, 8, &t->heads, path, e) ||
		 pretrained_int(text, "intermediate_size", 1 << 20, 2048, &t->inner, path, e) ||
		 pretrained_int(text, names[2], 1 << 20, 77, &c->positions, path, e) ||
		 pretrained_int(own ? config : text, "projection_dim", 65536, 512, &kind->width, path, e) ||
		 read_activation(c, text, path, e) || pretrained_sizes(t, c->positions, names, path, e) ||
		 pretrained_eps(text, 1e-5, &t->eps, path, e));
}

/* OpenCLIP's own; what it does not say is as in its code. */
static int read_open_keys(
	struct text_tower *c, struct kind *kind, const cJSON *config, const char *path, struct err *e)
{
	static const char *const own[] = {"width", "heads", "context_length"};
	static const char *const refused[] = {"hf_model_name", "hf_tokenizer_name", "embed_cls",
		"no_causal_mask", "pool_type", "mlp_ratio", "act_kwargs", "norm_kwargs"};
	const cJSON *model = cJSON_IsObject(json_get(config, "model_cfg")) ? json_get(config, "model_cfg")
									   : config,
		    *text = json_get(model, "text_cfg");
	struct transformer *t = &c->body;

	if (!cJSON_IsObject(text))
		return err_file(e, path, "key 'text_cfg' is not an object");
	for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
		if (json_get(text, refused[i]))
			return err_file(
				e, path, "key '%s': text towers of this kind are not read", refused[i]);
	if (pretrained_int(model, "embed_dim", 65536, 0, &kind->width, path, e) ||
		pretrained_int(text, "vocab_size", 10000000, 49408, &c->words, path, e) ||
		pretrained_int(text, own[0], 65536, 512, &t->width, path, e) ||
		pretrained_int(text, "layers", 1000, 12, &t->layer_count, path, e) ||
		pretrained_int(text, own[1], 65536, 8, &t->heads, path, e) ||
		pretrained_int(text, own[2], 1 << 20, 77, &c->positions, path, e))
		return -1;
	t->inner = 4 * t->width;
	t->eps = 1e-5;
	t->activation =
		cJSON_IsTrue(json_get(model, "quick_gelu")) ? TRANSFORMER_QUICK_GELU : TRANSFORMER_GELU;
	kind->is_projected = 1;
	return pretrained_sizes(t, c->positions, own, path, e);
}

static int read_config(struct text_tower *c, struct kind *kind, const char *dir, struct err *e)
{
	SCOPED char *path = find_config(dir, &kind->is_open, e);
	SCOPED_BY(json_release) cJSON *config = path ? json_read(path, e) : NULL;

	if (!config)
		return -1;
	if (!cJSON_IsObject(config))
		return err_file(e, path, "not a JSON object");
	return kind->is_open ? read_open_keys(c, kind, config, path, e) : read_keys(c, kind, config, path, e);
}

#define HUGGING_FACE                                                                                         \
	"embeddings.token_embedding.weight", "embeddings.position_embedding.weight", NULL,                   \
		"encoder.layers.", "final_layer_norm", "text_projection.weight",                             \
		{"self_attn.q_proj", "self_attn.k_proj", "self_attn.v_proj"}, "layer_norm1",                 \
		"self_attn.out_proj", "mlp.fc1", "mlp.fc2", "layer_norm2"
#define OPEN_CLIP_NAMES                                                                                      \
	"token_embedding.weight", "positional_embedding", NULL, "transformer.resblocks.", "ln_final",        \
		"text_projection", {"attn.in_proj_weight", "attn.in_proj_bias", NULL}, "ln_1",               \
		"attn.out_proj", "mlp.c_fc", "mlp.c_proj", "ln_2"

static const struct pretrained_names layouts[] = {
	{"text_model.", HUGGING_FACE}, {"", HUGGING_FACE}, {"", OPEN_CLIP_NAMES}, {"text.", OPEN_CLIP_NAMES}};

enum { NAME = 160 };

static const struct pretrained_names *find_layout(const struct safetensors *st)
{
	char full[NAME];

	for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
		snprintf(full, sizeof full, "%s%s", layouts[i].prefix, layouts[i].word);
		if (safetensors_find(st, full))
			return &layouts[i];
	}
	return layouts;
}

/* Whether query, key and value are one tensor: then the projection has a prefix, as HuggingFace's has not,
 * and is (width,projected). */
static int is_open_clip(const struct pretrained *s)
{
	return !s->names->attention[2];
}

static int load_projection(const struct pretrained *s, const struct text_tower *c)
{
	const int rows = c->projected, columns = c->body.width;
	struct pretrained from = *s;

	if (!is_open_clip(s)) {
		from.prefix = "";
		return pretrained_load(&from, s->names->projection, c->projection, rows, columns);
	}
	SCOPED float *turned = mem_alloc((size_t)rows * (size_t)columns, sizeof *turned, "encoder", from.e);
	const int bad = !turned || pretrained_load(&from, s->names->projection, turned, columns, rows);
	for (int r = 0; r < rows && !bad; r++)
		for (int k = 0; k < columns; k++)
			c->projection[(size_t)r * (size_t)columns + (size_t)k] =
				turned[(size_t)k * (size_t)rows + (size_t)r];
	return bad ? -1 : 0;
}

/* Whether there is a projection, of the right size. */
static int find_projection(const struct pretrained *s, struct text_tower *c, const struct kind *kind)
{
	const int turned = is_open_clip(s), sides[2] = {kind->width, c->body.width};
	char full[NAME];

	snprintf(full, sizeof full, "%s%s", turned ? s->prefix : "", s->names->projection);
	if (!kind->is_projected && !safetensors_find(&s->st, full))
		return 0;
	c->projected = kind->width;
	return pretrained_need(&s->st, full, sides[turned], sides[!turned], s->e) ? 0 : -1;
}

/* That the file has all tensors is known before memory is taken for them. */
static int load_all(struct pretrained *s, struct text_tower *c, const struct kind *kind)
{
	s->names = find_layout(&s->st);
	s->prefix = s->names->prefix;
	return -(text_tower_alloc_layers(c, s->e) || pretrained_tower(s, c) || find_projection(s, c, kind) ||
		 text_tower_alloc(c, s->e) || pretrained_tower(s, c) ||
		 (c->projected && load_projection(s, c)));
}

int clip_model_read(struct text_tower *c, const char *dir, struct err *e)
{
	struct pretrained s = {.scale = ".weight", .shift = ".bias", .e = e};
	struct kind kind = {0};

	*c = (struct text_tower){.body = {.is_causal = 1, .is_norm_first = 1}};
	int bad = read_config(c, &kind, dir, e) ||
		  pretrained_open(&s.st, dir, kind.is_open ? "open_clip_model.safetensors" : NULL, e) ||
		  load_all(&s, c, &kind);
	bad |= pretrained_close(&s, c);
	return bad ? -1 : 0;
}
