#include "answer/respond.h"

#include "base/mem.h"
#include "train/step.h"
#include "train/train.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct step *make_step(const struct respond_model *m, const float *position, const int64_t *offsets,
	const float *words, size_t sentences, struct err *e)
{
	const struct step_setup setup = {.layout = m->layout,
		.similarity = m->similarity,
		.temperature = 1,
		.gaussians = m->rows->n,
		.position = position,
		.sentences = sentences,
		.offsets = offsets,
		.words = words,
		.batch = 1};

	return step_new(&setup, e);
}

int respond_all(const struct respond_model *m, const int64_t *offsets, const float *words,
	const size_t *which, size_t count, float *out, struct err *e)
{
	const size_t width = (size_t)m->layout->text_width;
	const int channels = m->layout->feature_width;
	const size_t rows = m->rows->n, gaussians = m->rows->gaussians;
	float *panels = mem_alloc(step_padded(rows), (size_t)channels * sizeof(float), "features", e);
	float *position = mem_alloc(rows, 3 * sizeof(float), "positions", e);
	float *response = mem_alloc(rows, sizeof *response, "responses", e);
	int bad = !panels || !position || !response ||
				  rows_positions(m->rows, m->means, m->low, m->high, position, e)
			  ? -1
			  : 0;

	if (!bad)
		step_pack(m->features, rows, channels, panels);
	/* One sentence at a time: the buffers are then as large as its own words ask. */
	for (size_t i = 0; i < count && !bad; i++) {
		const int64_t own[2] = {0, offsets[which[i] + 1] - offsets[which[i]]};
		memset(out + i * gaussians, 0, sizeof *out * gaussians);
		if (!own[1] || !rows)
			continue;
		struct step *s = make_step(m, position, own, words + (size_t)offsets[which[i]] * width, 1, e);
		if (s)
			step_respond(s, m->parameters, panels, 0, response);
		else
			bad = -1;
		if (s)
			rows_spread(m->rows, response, out + i * gaussians);
		step_free(s);
	}
	free(panels);
	free(position);
	free(response);
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
