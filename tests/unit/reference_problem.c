#include "reference_problem.h"

#include "base/mem.h"
#include "base/rng.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *get(size_t count, size_t size)
{
	struct err e;
	void *block = mem_zalloc(count, size, "sample", &e);

	if (!block) {
		fprintf(stderr, "%s\n", e.message);
		exit(1);
	}
	return block;
}

struct reference_options reference_defaults(uint64_t seed, enum refer_interaction interaction,
	enum refer_similarity similarity, enum refer_contrast contrast)
{
	return (struct reference_options){
		.n = 40,
		.text_width = 24,
		.feature_width = 16,
		.sentences = 5, /* of the objects 0 1 0 1 0; the middle one is the target */
		.min_words = 3,
		.max_words = 7,
		.pixels = 30,
		.max_weights = 12,
		.interaction = interaction,
		.similarity = similarity,
		.contrast = contrast,
		.temperature = contrast == REFER_CONTRAST_DOT ? 10 : 0.2,
		.lambda = 0.5,
		.tau = 0.1,
		.gain = 2,
		.x_scale = 1,
		.seed = seed,
	};
}

/* The problem's pointers, after the arrays are in place. */
static void link_arrays(struct reference_sample *s)
{
	s->problem.layout = &s->layout;
	s->problem.parameters = s->parameters;
	s->problem.x = s->x;
	s->problem.position = s->position;
	s->problem.offsets = s->offsets;
	s->problem.words = s->words;
	s->problem.objects = s->objects;
	s->problem.indptr = s->indptr;
	s->problem.index = s->index;
	s->problem.weight = s->weight;
	s->problem.mask = s->mask;
}

static void draw_parameters(struct reference_sample *s, double gain, struct rng *r)
{
	float *initial = get(s->layout.count, sizeof *initial);

	refer_init(&s->layout, initial, r);
	for (size_t k = 0; k < s->layout.count; k++)
		s->parameters[k] = (float)(gain * (double)initial[k]);
	free(initial);
	for (size_t d = 0; d < (size_t)s->layout.tensors[NORM_WEIGHT].rows; d++) {
		s->parameters[s->layout.tensors[NORM_WEIGHT].offset + d] = (float)rng_range(r, 0.5, 1.5);
		s->parameters[s->layout.tensors[NORM_BIAS].offset + d] = (float)rng_range(r, -0.5, 0.5);
	}
}

static void draw_sentences(struct reference_sample *s, const struct reference_options *o, struct rng *r)
{
	s->offsets = get(o->sentences + 1, sizeof *s->offsets);
	s->objects = get(o->sentences, sizeof *s->objects);
	for (size_t k = 0; k < o->sentences; k++) {
		s->offsets[k + 1] =
			s->offsets[k] + o->min_words + rng_below(r, o->max_words - o->min_words + 1);
		s->objects[k] = (int)(k % 2);
	}
	const size_t numbers = s->offsets[o->sentences] * (size_t)o->text_width;
	s->words = get(numbers, sizeof *s->words);
	for (size_t k = 0; k < numbers; k++)
		s->words[k] = (float)rng_normal(r);
}

static void draw_view(struct reference_sample *s, const struct reference_options *o, struct rng *r)
{
	s->indptr = get(o->pixels + 1, sizeof *s->indptr);
	s->index = get(o->pixels * o->max_weights, sizeof *s->index);
	s->weight = get(o->pixels * o->max_weights, sizeof *s->weight);
	s->mask = get(o->pixels, sizeof *s->mask);
	for (size_t v = 0; v < o->pixels; v++) {
		const int is_empty = v == 0 || v == o->pixels - 1;
		const uint32_t count = is_empty ? 0 : rng_below(r, o->max_weights + 1);
		double left = 1;
		s->indptr[v + 1] = s->indptr[v] + count;
		for (int64_t k = s->indptr[v]; k < s->indptr[v + 1]; k++) {
			const double a = rng_range(r, 0.01, 0.6);
			s->index[k] = (int32_t)rng_below(r, (uint32_t)o->n);
			s->weight[k] = (float)(left * a);
			left *= 1 - a;
		}
		s->mask[v] = (uint8_t)rng_below(r, 2);
	}
}

void reference_sample_init(struct reference_sample *s, const struct reference_options *o)
{
	struct rng r;

	*s = (struct reference_sample){0};
	rng_seed(&r, o->seed, 7);
	refer_layout_init(&s->layout, o->interaction, o->text_width, o->feature_width);
	const size_t features = o->n * (size_t)o->feature_width;
	s->parameters = get(s->layout.count, sizeof *s->parameters);
	s->x = get(features, sizeof *s->x);
	s->position = get(o->n * 3, sizeof *s->position);
	draw_parameters(s, o->gain, &r);
	for (size_t k = 0; k < features; k++)
		s->x[k] = (float)(o->x_scale * rng_normal(&r));
	for (size_t k = 0; k < o->n * 3; k++)
		s->position[k] = (float)rng_range(&r, -1, 1);
	draw_sentences(s, o, &r);
	draw_view(s, o, &r);
	s->problem = (struct refer_problem){
		.n = o->n,
		.sentences = o->sentences,
		.target = o->sentences / 2,
		.pixels = o->pixels,
		.similarity = o->similarity,
		.contrast = o->contrast,
		.temperature = o->temperature,
		.lambda = o->lambda,
		.tau = o->tau,
	};
	link_arrays(s);
}

static void *copy_of(const void *block, size_t count, size_t size)
{
	void *copy = get(count, size);

	memcpy(copy, block, count * size);
	return copy;
}

void reference_sample_copy(struct reference_sample *s, const struct reference_sample *from)
{
	const struct refer_problem *p = &from->problem;
	const size_t entries = (size_t)from->indptr[p->pixels];
	const size_t words = from->offsets[p->sentences] * (size_t)from->layout.text_width;

	*s = *from;
	s->parameters = copy_of(from->parameters, from->layout.count, sizeof *s->parameters);
	s->x = copy_of(from->x, p->n * (size_t)from->layout.feature_width, sizeof *s->x);
	s->position = copy_of(from->position, p->n * 3, sizeof *s->position);
	s->offsets = copy_of(from->offsets, p->sentences + 1, sizeof *s->offsets);
	s->words = copy_of(from->words, words, sizeof *s->words);
	s->objects = copy_of(from->objects, p->sentences, sizeof *s->objects);
	s->indptr = copy_of(from->indptr, p->pixels + 1, sizeof *s->indptr);
	s->index = copy_of(from->index, entries, sizeof *s->index);
	s->weight = copy_of(from->weight, entries, sizeof *s->weight);
	s->mask = copy_of(from->mask, p->pixels, sizeof *s->mask);
	link_arrays(s);
}

void reference_sample_free(struct reference_sample *s)
{
	free(s->parameters);
	free(s->x);
	free(s->position);
	free(s->offsets);
	free(s->words);
	free(s->objects);
	free(s->indptr);
	free(s->index);
	free(s->weight);
	free(s->mask);
	*s = (struct reference_sample){0};
}
