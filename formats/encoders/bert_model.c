#include "formats/encoders/bert_model.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/encoders/pretrained.h"
#include "formats/records/json.h"

static int read_activation(struct text_tower *b, const cJSON *config, const char *path, struct err *e)
{
	static const struct pretrained_activation known[] = {{"gelu", TRANSFORMER_GELU},
		{"gelu_new", TRANSFORMER_GELU_TANH}, {"gelu_pytorch_tanh", TRANSFORMER_GELU_TANH},
		{"relu", TRANSFORMER_RELU}};

	return pretrained_activation(config, known, sizeof known / sizeof *known,
		"gelu, gelu_new, gelu_pytorch_tanh or relu", NULL, &b->body.activation, path, e);
}

static int read_keys(struct text_tower *b, const cJSON *config, const char *path, struct err *e)
{
	static const char *const keys[] = {"hidden_size", "num_attention_heads", "max_position_embeddings"};
	struct transformer *t = &b->body;

	if (!cJSON_IsObject(config))
		return err_file(e, path, "not a JSON object");
	if (pretrained_is(config, "model_type", "bert", path, e) ||
		pretrained_is(config, "position_embedding_type", "absolute", path, e) ||
		pretrained_int(config, "vocab_size", 10000000, 0, &b->words, path, e) ||
		pretrained_int(config, keys[0], 65536, 0, &t->width, path, e) ||
		pretrained_int(config, "num_hidden_layers", 1000, 0, &t->layer_count, path, e) ||
		pretrained_int(config, keys[1], 65536, 0, &t->heads, path, e) ||
		pretrained_int(config, "intermediate_size", 1 << 20, 0, &t->inner, path, e) ||
		pretrained_int(config, keys[2], 1 << 20, 0, &b->positions, path, e) ||
		pretrained_int(config, "type_vocab_size", 65536, 0, &b->types, path, e) ||
		read_activation(b, config, path, e))
		return -1;
	return -(pretrained_sizes(t, b->positions, keys, path, e) ||
		 pretrained_eps(config, 1e-12, &t->eps, path, e));
}

static int read_config(struct text_tower *b, const char *dir, struct err *e)
{
	SCOPED char *path = file_join(dir, "config.json", "", e);
	SCOPED_BY(json_release) cJSON *config = path ? json_read(path, e) : NULL;

	return config ? read_keys(b, config, path, e) : -1;
}

static const struct pretrained_names names = {.word = "embeddings.word_embeddings.weight",
	.position = "embeddings.position_embeddings.weight",
	.type = "embeddings.token_type_embeddings.weight",
	.layer = "encoder.layer.",
	.norm = "embeddings.LayerNorm",
	.attention = {"attention.self.query", "attention.self.key", "attention.self.value"},
	.attention_norm = "attention.output.LayerNorm",
	.attention_out = "attention.output.dense",
	.inner = "intermediate.dense",
	.outer = "output.dense",
	.feed_norm = "output.LayerNorm"};

/* Names have a prefix or none; those of old checkpoints' norms are others. */
static void find_names(struct pretrained *s)
{
	if (safetensors_find(&s->st, "bert.embeddings.word_embeddings.weight"))
		s->prefix = "bert.";
	if (safetensors_find(
		    &s->st, *s->prefix ? "bert.embeddings.LayerNorm.gamma" : "embeddings.LayerNorm.gamma")) {
		s->scale = ".gamma";
		s->shift = ".beta";
	}
}

/* That the file has all tensors is known before memory is taken for them. */
static int load_all(struct pretrained *s, struct text_tower *b)
{
	find_names(s);
	return -(text_tower_alloc_layers(b, s->e) || pretrained_tower(s, b) || text_tower_alloc(b, s->e) ||
		 pretrained_tower(s, b));
}

int bert_model_read(struct text_tower *b, const char *dir, struct err *e)
{
	struct pretrained s = {.prefix = "", .names = &names, .scale = ".weight", .shift = ".bias", .e = e};

	*b = (struct text_tower){0};
	int bad = read_config(b, dir, e) || pretrained_open(&s.st, dir, NULL, e) || load_all(&s, b);
	bad |= pretrained_close(&s, b);
	return bad ? -1 : 0;
}
