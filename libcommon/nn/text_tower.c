#include "nn/text_tower.h"

#include "base/mem.h"
#include "nn/linear.h"

/* In the order in which weights are hashed. */
static void lay_out(void *of, struct slab *s)
{
	struct text_tower *t = of;
	const size_t width = (size_t)t->body.width;

	slab_take_weight(s, &t->word, (size_t)t->words, width);
	t->position = slab_take(s, (size_t)t->positions, width);
	if (t->body.is_norm_first) {
		transformer_take(&t->body, s);
		transformer_take_norm(&t->body, &t->norm, s);
		t->projection = slab_take(s, (size_t)t->projected, width);
	} else {
		t->type = slab_take(s, (size_t)t->types, width);
		transformer_take_norm(&t->body, &t->norm, s);
		transformer_take(&t->body, s);
	}
}

int text_tower_alloc_layers(struct text_tower *t, struct err *e)
{
	t->body.layers = mem_zalloc((size_t)t->body.layer_count, sizeof *t->body.layers, "encoder", e);
	return t->body.layers ? 0 : -1;
}

int text_tower_alloc(struct text_tower *t, struct err *e)
{
	t->slab = slab_alloc(lay_out, t, "encoder", e);
	return t->slab ? 0 : -1;
}

uint64_t text_tower_hash(const struct text_tower *t, uint64_t seed)
{
	struct text_tower same = *t; /* its arrays are handed out again, where they are */
	struct slab s = {.at = t->slab, .hash = &seed};

	lay_out(&same, &s);
	return seed;
}

void text_tower_free(struct text_tower *t)
{
	mem_free_all(t->body.layers, t->slab);
	if (t->file)
		t->close(t->file);
	*t = (struct text_tower){0};
}

int text_tower_width(const struct text_tower *t)
{
	return t->projected ? t->projected : t->body.width;
}

static void embed(const struct text_tower *t, const int32_t *ids, const size_t *starts, size_t n, float *x)
{
	const size_t width = (size_t)t->body.width;

#pragma omp parallel for schedule(static)
	for (size_t s = 0; s < n; s++)
		for (size_t r = starts[s]; r < starts[s + 1]; r++) {
			const float *position = t->position + (r - starts[s]) * width;
			float *row = x + (r - starts[0]) * width;
			linear_weight_take(row, &t->word, (size_t)ids[r] * width, width);
			for (size_t i = 0; i < width; i++)
				row[i] = (t->type ? row[i] + t->type[i] : row[i]) + position[i];
			if (!t->body.is_norm_first)
				transformer_normalise(&t->body, row, &t->norm);
		}
}

/* The rows that are projected at the end stand in the scratch, before what the layers need. */
static size_t take_rows(const struct text_tower *t, size_t rows, struct slab *s)
{
	slab_take(s, rows, t->projected ? (size_t)t->body.width : 0);
	return s->used;
}

int text_tower_scratch(const struct text_tower *t, size_t rows, size_t longest, size_t *floats)
{
	struct slab s = {0};
	const size_t before = take_rows(t, rows, &s);

	if (transformer_scratch(&t->body, rows, longest, floats) || s.bad || *floats > SIZE_MAX / 8 - before)
		return -1;
	*floats += before;
	return 0;
}

void text_tower_forward(const struct text_tower *t, const int32_t *ids, const size_t *starts, size_t n,
	float *out, float *middle, float *scratch)
{
	const size_t rows = starts[n] - starts[0], width = (size_t)t->body.width;
	float *x = t->projected ? scratch : out;

	embed(t, ids, starts, n, x);
	transformer_forward(&t->body, starts, n, x, middle, scratch + take_rows(t, rows, &(struct slab){0}));
	if (!t->body.is_norm_first)
		return;
#pragma omp parallel for schedule(static)
	for (size_t r = 0; r < rows; r++)
		transformer_normalise(&t->body, x + r * width, &t->norm);
	if (t->projected)
		linear_forward(out, x, t->projection, NULL, rows, width, (size_t)t->projected);
}

void text_tower_static(const struct text_tower *t, const int32_t *ids, size_t n, float *out)
{
	const size_t width = (size_t)t->body.width;

	for (size_t k = 0; k < n; k++)
		linear_weight_take(out + k * width, &t->word, (size_t)ids[k] * width, width);
}
