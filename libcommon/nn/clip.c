#include "nn/clip.h"

#include "base/mem.h"
#include "nn/linear.h"

#include <stdlib.h>
#include <string.h>

static void lay_out(void *of, struct slab *s)
{
	struct clip *c = of;
	size_t width = (size_t)c->body.width;

	c->word = slab_take(s, (size_t)c->words, width);
	c->position = slab_take(s, (size_t)c->positions, width);
	transformer_take(&c->body, s);
	transformer_take_norm(&c->body, &c->norm, s);
	c->projection = slab_take(s, (size_t)c->projected, width);
}

int clip_alloc(struct clip *c, struct err *e)
{
	c->slab = NULL;
	c->body.layers = mem_zalloc((size_t)c->body.layer_count, sizeof *c->body.layers, "encoder", e);
	if (c->body.layers)
		c->slab = slab_alloc(lay_out, c, "encoder", e);
	if (!c->slab) {
		clip_free(c);
		return -1;
	}
	return 0;
}

uint64_t clip_hash(const struct clip *c, uint64_t seed)
{
	struct clip same = *c; /* its arrays are handed out again, where they are */
	struct slab s = {.at = c->slab, .hash = &seed};

	lay_out(&same, &s);
	return seed;
}

void clip_free(struct clip *c)
{
	free(c->body.layers);
	free(c->slab);
	*c = (struct clip){0};
}

int clip_width(const struct clip *c)
{
	return c->projected ? c->projected : c->body.width;
}

static void embed(const struct clip *c, const int32_t *ids, const size_t *starts, size_t n, float *x)
{
	size_t width = (size_t)c->body.width;

#pragma omp parallel for schedule(static)
	for (size_t s = 0; s < n; s++)
		for (size_t r = starts[s]; r < starts[s + 1]; r++) {
			const float *word = c->word + (size_t)ids[r] * width;
			const float *position = c->position + (r - starts[s]) * width;
			float *row = x + (r - starts[0]) * width;
			for (size_t i = 0; i < width; i++)
				row[i] = word[i] + position[i];
		}
}

/* The rows that are projected at the end stand in the scratch, before what the layers need. */
static size_t take_rows(const struct clip *c, size_t rows, struct slab *s)
{
	slab_take(s, rows, c->projected ? (size_t)c->body.width : 0);
	return s->used;
}

int clip_scratch(const struct clip *c, size_t rows, size_t longest, size_t *floats)
{
	struct slab s = {0};
	const size_t before = take_rows(c, rows, &s);

	if (transformer_scratch(&c->body, rows, longest, floats) || s.bad || *floats > SIZE_MAX / 8 - before)
		return -1;
	*floats += before;
	return 0;
}

void clip_forward(
	const struct clip *c, const int32_t *ids, const size_t *starts, size_t n, float *out, float *scratch)
{
	const size_t rows = starts[n] - starts[0], width = (size_t)c->body.width;
	float *x = c->projected ? scratch : out;

	embed(c, ids, starts, n, x);
	transformer_forward(&c->body, starts, n, x, NULL, scratch + take_rows(c, rows, &(struct slab){0}));
#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < rows; r++)
		transformer_normalise(&c->body, x + r * width, &c->norm);
	if (c->projected)
		linear_forward(out, x, c->projection, NULL, rows, width, (size_t)c->projected);
}

void clip_static(const struct clip *c, const int32_t *ids, size_t n, float *out)
{
	const size_t width = (size_t)c->body.width;

	for (size_t k = 0; k < n; k++)
		memcpy(out + k * width, c->word + (size_t)ids[k] * width, width * sizeof *out);
}
