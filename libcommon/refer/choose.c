#include "refer/choose.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* The unit vector of the mean of the words; zero where there are none. */
static void sentence_mean(const float *words, size_t n, int width, float *mean)
{
	double sum = 0;

	for (int d = 0; d < width; d++) {
		double s = 0;
		for (size_t w = 0; w < n; w++)
			s += words[w * (size_t)width + (size_t)d];
		mean[d] = (float)s;
		sum += s * s;
	}
	for (int d = 0; d < width && sum > 0; d++)
		mean[d] = (float)(mean[d] / sqrt(sum));
}

static double dot(const float *a, const float *b, int width)
{
	double sum = 0;

	for (int d = 0; d < width; d++)
		sum += (double)a[d] * b[d];
	return sum;
}

int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	float *probability, struct err *e)
{
	enum { TEMPERATURE = 20 };
	const struct lifted *l = s->lifted;
	const size_t width = (size_t)l->width;
	float *means = mem_zalloc(l->sentences + 1, width * sizeof *means, "sentences", e);
	double *best = mem_alloc(l->objects, sizeof *best, "sentences", e);

	if (!means || !best) {
		free(means);
		free(best);
		return -1;
	}
	float *mine = means + l->sentences * width;
	for (size_t r = 0; r < l->sentences; r++)
		sentence_mean(l->words + (size_t)l->offsets[r] * width,
			(size_t)(l->offsets[r + 1] - l->offsets[r]), l->width, means + r * width);
	for (size_t i = 0; i < n; i++) {
		double sum = 0;
		sentence_mean(sentences[i].vectors, sentences[i].words, l->width, mine);
		for (size_t o = 0; o < l->objects; o++)
			best[o] = -1;
		for (size_t r = 0; r < l->sentences && parts & 1U << CHOOSE_SENTENCE; r++) {
			double match = dot(mine, means + r * width, l->width);
			if (match > best[l->object[r]])
				best[l->object[r]] = match;
		}
		for (size_t o = 0; o < l->objects; o++)
			sum += exp(TEMPERATURE * best[o]);
		for (size_t o = 0; o < l->objects; o++)
			probability[i * l->objects + o] = (float)(exp(TEMPERATURE * best[o]) / sum);
	}
	free(means);
	free(best);
	return 0;
}
