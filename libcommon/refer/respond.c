#include "refer/respond.h"

#include "base/mem.h"
#include "refer/step.h"
#include "refer/train.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct step *make_step(const struct respond_model *m, const float *position, const int64_t *offsets,
	const float *words, size_t sentences, struct err *e)
{
	const struct step_setup setup = {.layout = m->layout,
		.similarity = m->similarity,
		.temperature = 1,
		.gaussians = m->n,
		.ids = m->ids,
		.scene_gaussians = m->scene_gaussians,
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
	float *panels = mem_alloc(step_padded(m->n), REFER_X * sizeof(float), "features", e);
	float *position = mem_alloc(m->n, 3 * sizeof(float), "positions", e);
	int bad = !panels || !position ? -1 : 0;

	if (!bad) {
		step_pack(m->features, m->n, panels);
		train_positions(m->means, m->ids, m->n, m->low, m->high, position);
	}
	/* One sentence at a time: the buffers are then as large as its own words ask. */
	for (size_t i = 0; i < count && !bad; i++) {
		const int64_t own[2] = {0, offsets[which[i] + 1] - offsets[which[i]]};
		float *m_out = out + i * m->scene_gaussians;
		memset(m_out, 0, sizeof *m_out * m->scene_gaussians);
		if (!own[1] || !m->n)
			continue;
		struct step *s = make_step(m, position, own, words + (size_t)offsets[which[i]] * width, 1, e);
		if (s)
			step_respond(s, m->parameters, panels, 0, m_out);
		else
			bad = -1;
		step_free(s);
	}
	free(panels);
	free(position);
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
