#include "answer/respond.h"

#include "base/mem.h"
#include "field/forward.h"
#include "field/panels.h"
#include "field/text_mlp.h"

#include <math.h>

/* What all sentences go through, one at a time. */
struct answering {
	struct text_mlp words;
	struct forward forward;
	float *panels;	 /* features */
	float *position; /* (rows,3) */
	float *response; /* (padded) */
};

/* Words of the longest of these sentences, and the number of sentences up to the last of them. */
static int measure(const int64_t *offsets, const size_t *which, size_t count, size_t *sentences, int *longest,
	struct err *e)
{
	*longest = 0;
	*sentences = 0;
	for (size_t i = 0; i < count; i++) {
		const int64_t n = offsets[which[i] + 1] - offsets[which[i]];
		if (n > BLOCK_WORDS)
			return err_set(e, ERR_FORMAT, "sentence %zu has %lld words, more than %d", which[i],
				(long long)n, BLOCK_WORDS);
		if (n > *longest)
			*longest = (int)n;
		if (which[i] >= *sentences)
			*sentences = which[i] + 1;
	}
	return 0;
}

static void answering_free(struct answering *a)
{
	text_mlp_free(&a->words);
	forward_free(&a->forward);
	mem_free_all(a->panels, a->position, a->response);
}

static int answering_init(struct answering *a, const struct respond_model *m, const int64_t *offsets,
	const float *words, size_t sentences, int longest, struct err *e)
{
	const size_t rows = m->rows->n, padded = panels_padded(rows);
	const int width = m->layout->feature_width;

	a->panels = mem_alloc(padded, (size_t)width * sizeof *a->panels, "features", e);
	a->position = mem_alloc(rows, 3 * sizeof *a->position, "positions", e);
	a->response = mem_alloc(padded, sizeof *a->response, "responses", e);
	if (!a->panels || !a->position || !a->response ||
		rows_positions(m->rows, m->means, m->low, m->high, a->position, e))
		return -1;
	const struct forward_setup setup = {.layout = m->layout,
		.similarity = m->similarity,
		.gaussians = rows,
		.position = a->position,
		.longest = longest,
		.batch = 1};
	panels_pack(m->features, rows, width, a->panels);
	return -(forward_init(&a->forward, &setup, e) ||
		 text_mlp_init(&a->words, m->layout, sentences, offsets, words, TEXT_MLP_ANSWERING, e));
}

/* a->response gets the responses of the rows to one sentence. */
static void answer_sentence(struct answering *a, const float *parameters, size_t sentence)
{
	struct forward *f = &a->forward;

	text_mlp_choose(&a->words, &sentence, 1);
	text_mlp_hidden(&a->words, parameters);
	text_mlp_vectors(&a->words, parameters, 0, f->vectors);
	f->first[1] = (int)a->words.at[1];
	forward_fold(f, parameters, 1);
	forward_hidden(f, a->panels);
	forward_scores(f);
	forward_respond(f);
	panels_get(f->arrays.m, f->padded, 1, 0, a->response);
}

int respond_all(const struct respond_model *m, const int64_t *offsets, const float *words,
	const size_t *which, size_t count, float *out, struct err *e)
{
	const size_t gaussians = m->rows->gaussians;
	SCOPED_BY(answering_free) struct answering a = {0};
	size_t sentences;
	int longest;

	memset(out, 0, sizeof *out * count * gaussians);
	if (measure(offsets, which, count, &sentences, &longest, e))
		return -1;
	if (!longest || !m->rows->n)
		return 0;
	const int bad = answering_init(&a, m, offsets, words, sentences, longest, e);
	for (size_t i = 0; i < count && !bad; i++) {
		if (offsets[which[i] + 1] == offsets[which[i]])
			continue;
		answer_sentence(&a, m->parameters, which[i]);
		rows_spread(m->rows, a.response, out + i * gaussians);
	}
	return bad;
}

double respond_mask(const float *image, size_t pixels, double lift, uint8_t *mask)
{
	double sum = 0;
	size_t area = 0;

	for (size_t p = 0; p < pixels; p++)
		mask[p] = image[p] > 0;
	for (size_t p = 0; p < pixels;) {
		uint64_t eight = 1;
		if (pixels - p >= 8)
			memcpy(&eight, mask + p, 8);
		if (!eight) { /* most are background */
			p += 8;
			continue;
		}
		for (size_t end = pixels - p < 8 ? pixels : p + 8; p < end; p++) {
			if (!mask[p])
				continue;
			sum += 1 / (1 + exp(lift - (double)image[p]));
			area++;
		}
	}
	return area ? sum / (double)area : 0;
}
