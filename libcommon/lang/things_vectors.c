#include "lang/things_vectors.h"

#include "base/embed.h"
#include "base/mem.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

EMBED(things_vectors, "libcommon/lang/things.vectors");
extern const unsigned char things_vectors_begin[], things_vectors_end[];

int things_vectors_open(struct things_vectors *t, const char *encoder, int width, struct err *e)
{
	const char *const begin = (const char *)things_vectors_begin;
	char of[17];

	*t = (struct things_vectors){0};
	if (sscanf(begin, "refer.things 1 %16s %d %d %8" SCNx32, of, &t->lines, &t->width, &t->hash) != 4 ||
		t->width != width || !encoder || strcmp(encoder, of) != 0) {
		t->lines = 0;
		return 0;
	}
	t->of = (const int8_t *)(strchr(begin, '\n') + 1);
	t->length = mem_alloc((size_t)t->lines, sizeof *t->length, "things", e);
	for (int i = 0; i < t->lines && t->length; i++) {
		const int8_t *line = t->of + (size_t)i * (size_t)width;
		double square = 0;
		for (int d = 0; d < width; d++)
			square += line[d] * line[d];
		t->length[i] = (float)sqrt(square);
	}
	return t->length ? 0 : -1;
}

void things_vectors_free(struct things_vectors *t)
{
	free(t->length);
	*t = (struct things_vectors){0};
}

double things_vectors_between(
	const struct things_vectors *t, const int *a, size_t a_n, const int *b, size_t b_n)
{
	const size_t width = (size_t)t->width;
	double best = -1;

	for (size_t i = 0; i < a_n && t->lines; i++)
		for (size_t k = 0; k < b_n; k++) {
			const int8_t *x = t->of + (size_t)a[i] * width, *y = t->of + (size_t)b[k] * width;
			int sum = 0;
			for (size_t d = 0; d < width; d++)
				sum += x[d] * y[d];
			best = fmax(best, (double)sum / (double)t->length[a[i]] / (double)t->length[b[k]]);
		}
	return best;
}

enum { LANES = 16 }; /* sums side by side */

void things_vectors_cosines(const struct things_vectors *t, const float *direction, float *cosine)
{
	for (int i = 0; i < t->lines; i++) {
		const int8_t *line = t->of + (size_t)i * (size_t)t->width;
		float sum[LANES] = {0};
		int d = 0;
		for (; d + LANES <= t->width; d += LANES)
			for (int k = 0; k < LANES; k++)
				sum[k] += direction[d + k] * (float)line[d + k];
		for (; d < t->width; d++)
			sum[0] += direction[d] * (float)line[d];
		for (int k = 1; k < LANES; k++)
			sum[0] += sum[k];
		cosine[i] = sum[0] / t->length[i];
	}
}
