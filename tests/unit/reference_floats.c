#include "reference_floats.h"

#include "base/mem.h"
#include "mask/bits.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static float *to_floats(const double *from, size_t count)
{
	struct err e;
	float *to = mem_alloc(count, sizeof *to, "test", &e);

	for (size_t i = 0; i < count; i++)
		to[i] = (float)from[i];
	return to;
}

void floats_init(struct floats *f, const struct reference_sample *s)
{
	const struct refer_problem *p = &s->problem;
	const int width = s->layout.feature_width;
	const size_t features = p->n * (size_t)width, padded = panels_padded(p->n) * (size_t)width;
	struct err e;

	f->parameters = to_floats(p->parameters, s->layout.count);
	f->x = to_floats(p->x, features);
	f->position = to_floats(p->position, p->n * 3);
	f->words = to_floats(p->words, p->offsets[p->sentences] * (size_t)s->layout.text_width);
	f->weight = to_floats(p->weight, (size_t)p->indptr[p->pixels]);
	f->panels = mem_alloc(padded, sizeof(float), "test", &e);
	f->dpanels = mem_alloc(padded, sizeof(float), "test", &e);
	f->dx = mem_alloc(features, sizeof(float), "test", &e);
	f->gradient = mem_alloc(s->layout.count, sizeof(float), "test", &e);
	f->offsets = mem_alloc(p->sentences + 1, sizeof *f->offsets, "test", &e);
	f->mask = mem_alloc(bits_bytes(p->pixels), 1, "test", &e);
	bits_pack(p->mask, p->pixels, f->mask);
	for (size_t r = 0; r <= p->sentences; r++)
		f->offsets[r] = (int64_t)p->offsets[r];
	panels_pack(f->x, p->n, width, f->panels);
}

void floats_free(struct floats *f)
{
	float *all[] = {f->parameters, f->x, f->panels, f->position, f->words, f->weight, f->gradient,
		f->dpanels, f->dx};

	for (size_t i = 0; i < sizeof all / sizeof *all; i++)
		free(all[i]);
	free(f->offsets);
	free(f->mask);
}

double distance(const float *a, const double *b, size_t count)
{
	double difference = 0, size = 0;

	for (size_t i = 0; i < count; i++) {
		difference += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
		size += b[i] * b[i];
	}
	return size > 0 ? sqrt(difference / size) : sqrt(difference);
}

struct step *make_step(
	const struct reference_sample *s, const struct floats *f, int batch, const char *kernels)
{
	const struct refer_problem *p = &s->problem;
	struct err e = {0};
	struct step_setup setup = {.layout = &s->layout,
		.similarity = p->similarity,
		.contrast = p->contrast,
		.temperature = p->temperature,
		.lambda = p->lambda,
		.gaussians = p->n,
		.position = f->position,
		.counts = p->counts,
		.sentences = p->sentences,
		.offsets = f->offsets,
		.words = f->words,
		.objects = p->objects,
		.pixels = p->pixels,
		.batch = batch,
		.kernels = block_select(kernels)};
	struct step *step = step_new(&setup, &e);

	if (!step)
		fprintf(stderr, "%s\n", e.message);
	return step;
}

struct view_weights view_of(const struct refer_problem *p, const struct floats *f)
{
	return (struct view_weights){p->pixels, p->n, p->indptr, p->index, f->weight};
}

size_t top_count(const struct refer_problem *p)
{
	double all = 0;

	for (size_t i = 0; i < p->n; i++)
		all += p->counts ? p->counts[i] : 1;
	const size_t k = (size_t)(p->tau * all);
	return k ? k : 1;
}
