#include "field/referring_model.h"

#include <math.h>
#include <string.h>

static const char *const interactions[REFER_INTERACTIONS] = {
	"none", "attention", "attention+fp", "add", "pcmi", "pcmi-proj"};
static const char *const similarities[2] = {"dot", "cosine"};
static const char *const queries[2] = {"words", "parses"};
static const char *const blends[2] = {"logits", "shares"};
static const char *const contrasts[] = {"none", "dot", "cosine", "pairs"};

/* The place of a name, or -1. */
static int find_name(const char *const *names, int n, const char *name)
{
	for (int i = 0; i < n; i++)
		if (!strcmp(name, names[i]))
			return i;
	return -1;
}

const char *refer_interaction_name(enum refer_interaction i)
{
	return interactions[i];
}

int refer_interaction_parse(const char *name)
{
	return find_name(interactions, REFER_INTERACTIONS, name);
}

const char *refer_similarity_name(enum refer_similarity s)
{
	return similarities[s];
}

int refer_similarity_parse(const char *name)
{
	return find_name(similarities, 2, name);
}

const char *refer_query_name(enum refer_query q)
{
	return queries[q];
}

int refer_query_parse(const char *name)
{
	return find_name(queries, 2, name);
}

const char *refer_blend_name(enum refer_blend b)
{
	return blends[b];
}

int refer_blend_parse(const char *name)
{
	return find_name(blends, 2, name);
}

const char *refer_contrast_name(enum refer_contrast c)
{
	return contrasts[c];
}

int refer_uses_position(enum refer_interaction i)
{
	return i != REFER_NONE && i != REFER_ATTENTION;
}

void refer_layout_init(
	struct refer_layout *l, enum refer_interaction interaction, int text_width, int feature_width)
{
	const int position = refer_uses_position(interaction), projected = interaction == REFER_PCMI_PROJ;
	const struct {
		const char *weight, *bias;
		int out, in, present;
	} layers[] = {
		{"text.0.weight", "text.0.bias", REFER_T1, text_width, 1},
		{"text.1.weight", "text.1.bias", REFER_T2, REFER_T1, 1},
		{"text.2.weight", "text.2.bias", REFER_D, REFER_T2, 1},
		{"feature.0.weight", "feature.0.bias", REFER_XH, feature_width, 1},
		{"feature.1.weight", "feature.1.bias", REFER_H, REFER_XH, 1},
		{"feature.2.weight", "feature.2.bias", REFER_D, REFER_H, 1},
		{"position.0.weight", "position.0.bias", REFER_PH, 3, position},
		{"position.1.weight", "position.1.bias", REFER_H, REFER_PH, position},
		{"position.2.weight", "position.2.bias", REFER_D, REFER_H, position},
		{"query.weight", "query.bias", REFER_D, REFER_D, projected},
		{"key.weight", "key.bias", REFER_D, REFER_D, projected},
		{"value.weight", "value.bias", REFER_D, REFER_D, projected},
		{"query_position.weight", "query_position.bias", REFER_D, REFER_D, projected},
		{"key_position.weight", "key_position.bias", REFER_D, REFER_D, projected},
		{"norm.weight", "norm.bias", REFER_D, 1, projected},
	};

	*l = (struct refer_layout){
		.interaction = interaction, .text_width = text_width, .feature_width = feature_width};
	for (int i = 0; i < REFER_TENSORS / 2; i++) {
		int rows = layers[i].present ? layers[i].out : 0;
		l->tensors[2 * i].name = layers[i].weight;
		l->tensors[2 * i].rows = rows;
		l->tensors[2 * i].columns = layers[i].in;
		l->tensors[2 * i].offset = l->count;
		l->count += (size_t)rows * (size_t)layers[i].in;
		l->tensors[2 * i + 1].name = layers[i].bias;
		l->tensors[2 * i + 1].rows = rows;
		l->tensors[2 * i + 1].columns = 1;
		l->tensors[2 * i + 1].offset = l->count;
		l->count += (size_t)rows;
	}
}

void refer_init(const struct refer_layout *l, float *parameters, struct rng *r)
{
	for (int i = 0; i < REFER_TENSORS; i++) {
		size_t count = (size_t)l->tensors[i].rows * (size_t)l->tensors[i].columns;
		double bound = 1 / sqrt(l->tensors[i & ~1].columns);
		for (size_t k = 0; k < count; k++) {
			float *at = parameters + l->tensors[i].offset + k;
			if (i >= NORM_WEIGHT)
				*at = i == NORM_WEIGHT;
			else
				*at = (float)rng_range(r, -bound, bound);
		}
	}
}
