#include "nn/bert.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static void lay_out(void *of, struct slab *s)
{
	struct bert *b = of;
	size_t width = (size_t)b->body.width;

	b->word = slab_take(s, (size_t)b->words, width);
	b->position = slab_take(s, (size_t)b->positions, width);
	b->type = slab_take(s, (size_t)b->types, width);
	transformer_take_norm(&b->body, &b->norm, s);
	transformer_take(&b->body, s);
}

int bert_alloc(struct bert *b, struct err *e)
{
	b->slab = NULL;
	b->body.layers = mem_zalloc((size_t)b->body.layer_count, sizeof *b->body.layers, "encoder", e);
	if (b->body.layers)
		b->slab = slab_alloc(lay_out, b, "encoder", e);
	if (!b->slab) {
		bert_free(b);
		return -1;
	}
	return 0;
}

uint64_t bert_hash(const struct bert *b, uint64_t seed)
{
	struct bert same = *b; /* its arrays are handed out again, where they are */
	struct slab s = {.at = b->slab, .hash = &seed};

	lay_out(&same, &s);
	return seed;
}

void bert_free(struct bert *b)
{
	free(b->body.layers);
	free(b->slab);
	*b = (struct bert){0};
}

static void embed(const struct bert *b, const int32_t *ids, const size_t *starts, size_t n, float *x)
{
	size_t width = (size_t)b->body.width;

#pragma omp parallel for schedule(static)
	for (size_t s = 0; s < n; s++)
		for (size_t r = starts[s]; r < starts[s + 1]; r++) {
			const float *word = b->word + (size_t)ids[r] * width;
			const float *position = b->position + (r - starts[s]) * width;
			float *row = x + (r - starts[0]) * width;
			for (size_t i = 0; i < width; i++)
				row[i] = word[i] + b->type[i] + position[i];
			transformer_normalise(&b->body, row, &b->norm);
		}
}

int bert_scratch(const struct bert *b, size_t rows, size_t longest, size_t *floats)
{
	return transformer_scratch(&b->body, rows, longest, floats);
}

void bert_forward(const struct bert *b, const int32_t *ids, const size_t *starts, size_t n, float *out,
	float *middle, float *scratch)
{
	embed(b, ids, starts, n, out);
	transformer_forward(&b->body, starts, n, out, middle, scratch);
}

void bert_static(const struct bert *b, const int32_t *ids, size_t n, float *out)
{
	const size_t width = (size_t)b->body.width;

	for (size_t k = 0; k < n; k++)
		memcpy(out + k * width, b->word + (size_t)ids[k] * width, width * sizeof *out);
}
