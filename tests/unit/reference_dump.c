#include "reference_problem.h"

#include <stdio.h>
#include <stdlib.h>

static void put_reals(const char *name, const double *values, size_t count)
{
	printf(",\n\"%s\":[", name);
	for (size_t i = 0; i < count; i++)
		printf("%s%.17g", i ? "," : "", values[i]);
	printf("]");
}

static void put_integers(const char *name, const long long *values, size_t count)
{
	printf(",\n\"%s\":[", name);
	for (size_t i = 0; i < count; i++)
		printf("%s%lld", i ? "," : "", values[i]);
	printf("]");
}

/* Prints an array of any integer type. */
#define PUT_INTEGERS(name, values, count)                                                                    \
	do {                                                                                                 \
		long long *wide = malloc(((count) + 1) * sizeof *wide);                                      \
		for (size_t at = 0; at < (count); at++)                                                      \
			wide[at] = (long long)(values)[at];                                                  \
		put_integers(name, wide, count);                                                             \
		free(wide);                                                                                  \
	} while (0)

static void put_tensors(const struct refer_layout *l)
{
	const char *separator = "";

	printf(",\n\"tensors\":{");
	for (int a = 0; a < REFER_TENSORS; a++) {
		if (!l->tensors[a].rows)
			continue;
		printf("%s\"%s\":[%zu,%d,%d]", separator, l->tensors[a].name, l->tensors[a].offset,
			l->tensors[a].rows, l->tensors[a].columns);
		separator = ",";
	}
	printf("}");
}

static void put_answer(const struct reference_sample *s)
{
	const struct refer_problem *p = &s->problem;
	const size_t features = p->n * (size_t)s->layout.feature_width;
	double *dx = malloc(features * sizeof *dx), *d = malloc(s->layout.count * sizeof *d);
	struct refer_result r;
	struct err e = {0};

	if (reference_forward(p, &r, &e) || reference_backward(p, &r, dx, d, &e)) {
		fprintf(stderr, "%s\n", e.message);
		exit(1);
	}
	printf(",\n\"bce\":%.17g,\"contrast_loss\":%.17g,\"loss\":%.17g", r.bce, r.contrast, r.loss);
	put_reals("m", r.m, p->n);
	put_reals("image", r.image, p->pixels);
	PUT_INTEGERS("top", r.top, r.top_count);
	put_reals("dx", dx, features);
	put_reals("dparameters", d, s->layout.count);
	reference_free(&r);
	free(dx);
	free(d);
}

void reference_dump(const struct reference_sample *s)
{
	const struct refer_problem *p = &s->problem;
	const size_t entries = (size_t)p->indptr[p->pixels];

	printf("{\"interaction\":\"%s\",\"similarity\":\"%s\",\"contrast\":%d,\n",
		refer_interaction_name(s->layout.interaction), refer_similarity_name(p->similarity),
		(int)p->contrast);
	printf("\"temperature\":%.17g,\"lambda\":%.17g,\"tau\":%.17g,\"target\":%zu", p->temperature,
		p->lambda, p->tau, p->target);
	put_tensors(&s->layout);
	put_reals("parameters", p->parameters, s->layout.count);
	put_reals("x", p->x, p->n * (size_t)s->layout.feature_width);
	put_reals("position", p->position, p->n * 3);
	put_reals("words", p->words, p->offsets[p->sentences] * (size_t)s->layout.text_width);
	put_reals("weight", p->weight, entries);
	PUT_INTEGERS("offsets", p->offsets, p->sentences + 1);
	PUT_INTEGERS("objects", p->objects, p->sentences);
	PUT_INTEGERS("indptr", p->indptr, p->pixels + 1);
	PUT_INTEGERS("index", p->index, entries);
	PUT_INTEGERS("mask", p->mask, p->pixels);
	put_answer(s);
	printf("}\n");
}
