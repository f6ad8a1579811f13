#include "refer/asked.h"

#include "base/mem.h"
#include "refer/calibrate.h"
#include "refer/choose.h"
#include "splat/render.h"

#include <stdlib.h>
#include <string.h>

void asked_free(struct asked *a)
{
	free(a->responses);
	free(a->lifts);
	free(a->channel);
	free(a->sure);
	*a = (struct asked){0};
}

static int alloc_channels(struct asked *a, size_t channels, size_t gaussians, struct err *e)
{
	size_t bytes;

	if (mem_size(gaussians, sizeof *a->responses, &bytes))
		return err_set(e, ERR_SYSTEM, "responses: %zu Gaussians do not fit in memory", gaussians);
	a->channels = channels;
	a->responses = mem_alloc(channels, bytes, "responses", e);
	a->lifts = mem_zalloc(channels, sizeof *a->lifts, "responses", e);
	return a->responses && a->lifts ? 0 : -1;
}

static int ask_trained(struct asked *a, const struct respond_model *m, const struct asked_of *q,
	int wants_calibration, struct err *e)
{
	a->channel = mem_alloc(q->count, sizeof *a->channel, "sentences", e);
	if (!a->channel || alloc_channels(a, q->count, q->splats->n, e))
		return -1;
	for (size_t i = 0; i < q->count; i++)
		a->channel[i] = i;
	if (respond_all(m, q->offsets, q->words, q->which, q->count, a->responses, e) ||
		render_pack(a->responses, q->splats->n, (int)q->count, e))
		return -1;
	return wants_calibration
		       ? calibrate(q->splats, q->cameras, m->rows, a->responses, q->count, a->lifts, e)
		       : 0;
}

int asked_trained(struct asked *a, const struct respond_model *m, const struct asked_of *q,
	int wants_calibration, struct err *e)
{
	*a = (struct asked){0};
	if (!ask_trained(a, m, q, wants_calibration, e))
		return 0;
	asked_free(a);
	return -1;
}

/* channel[i] becomes the object that sentence i means, or, for none, the number of objects. */
static int choose_objects(
	struct asked *a, const struct lifted *l, const struct asked_of *q, double least, struct err *e)
{
	const struct choose_scene scene = {l, q->splats, q->cameras};
	struct choose_sentence *sentences = mem_alloc(q->count, sizeof *sentences, "sentences", e);
	float *probability = NULL;
	size_t bytes;
	int bad = -1;

	if (mem_size(l->objects, sizeof *probability, &bytes))
		err_set(e, ERR_SYSTEM, "probabilities of %zu objects do not fit in memory", l->objects);
	else if (sentences)
		probability = mem_alloc(q->count, bytes, "probabilities", e);
	for (size_t i = 0; i < q->count && probability; i++) {
		const size_t r = q->which[i];
		sentences[i] = (struct choose_sentence){q->pieces[r],
			q->words + (size_t)q->offsets[r] * (size_t)l->width,
			(size_t)(q->offsets[r + 1] - q->offsets[r])};
	}
	if (probability)
		bad = choose(&scene, sentences, q->count, CHOOSE_ALL, probability, e);
	for (size_t i = 0; i < q->count && !bad; i++) {
		const float *row = probability + i * l->objects;
		size_t best = 0;
		for (size_t o = 1; o < l->objects; o++)
			if (row[o] > row[best])
				best = o;
		const int is_found = sentences[i].words && l->objects && row[best] >= least;
		a->channel[i] = is_found ? best : l->objects;
		a->sure[i] = is_found ? (double)row[best] * l->confidence[best] : 0;
	}
	free(sentences);
	free(probability);
	return bad;
}

static int ask_lifted(
	struct asked *a, const struct lifted *l, const struct asked_of *q, double least, struct err *e)
{
	const size_t unused = SIZE_MAX, n = q->splats->n;
	size_t *of, channels = 0;
	int bad = -1;

	a->channel = mem_alloc(q->count, sizeof *a->channel, "sentences", e);
	a->sure = mem_alloc(q->count, sizeof *a->sure, "sentences", e);
	if (!a->channel || !a->sure || choose_objects(a, l, q, least, e))
		return -1;
	of = mem_alloc(l->objects + 1, sizeof *of, "objects", e);
	for (size_t o = 0; o <= l->objects && of; o++)
		of[o] = unused;
	for (size_t i = 0; i < q->count && of; i++) {
		size_t *own = &of[a->channel[i]];
		if (*own == unused)
			*own = channels++;
		a->channel[i] = *own;
	}
	if (of && !alloc_channels(a, channels, n, e)) {
		for (size_t o = 0; o < l->objects; o++)
			if (of[o] != unused)
				lifted_responses(l, o, a->responses + of[o] * n);
		if (of[l->objects] != unused)
			memset(a->responses + of[l->objects] * n, 0, n * sizeof *a->responses);
		bad = render_pack(a->responses, n, (int)channels, e);
	}
	free(of);
	return bad;
}

int asked_lifted(
	struct asked *a, const struct lifted *l, const struct asked_of *q, double least, struct err *e)
{
	*a = (struct asked){0};
	if (!ask_lifted(a, l, q, least, e))
		return 0;
	asked_free(a);
	return -1;
}

/* A Gaussian's response, where render_pack has put it. */
static float packed(const struct asked *a, size_t n, size_t channel, size_t i)
{
	const size_t first = channel - channel % RENDER_GROUP, left = a->channels - first;
	const size_t now = left < RENDER_GROUP ? left : RENDER_GROUP;

	return a->responses[first * n + i * now + channel - first];
}

size_t asked_gaussians(
	const struct asked *a, size_t gaussians, size_t channel, int32_t *ids, float *responses)
{
	size_t n = 0;

	for (size_t i = 0; i < gaussians; i++) {
		const float response = packed(a, gaussians, channel, i);
		if (!(response > 0))
			continue;
		ids[n] = (int32_t)i;
		responses[n++] = response;
	}
	return n;
}

static int take_whole(
	const struct asked *a, size_t channel, const struct splats *s, struct splats *whole, struct err *e)
{
	size_t n = 0, at = 0;

	for (size_t i = 0; i < s->n; i++)
		n += packed(a, s->n, channel, i) > 0;
	if (splats_alloc(whole, n, 1, e))
		return -1;
	memset(whole->sh, 0, n * 3 * sizeof *whole->sh);
	for (size_t i = 0; i < s->n; i++) {
		if (!(packed(a, s->n, channel, i) > 0))
			continue;
		memcpy(whole->means + 3 * at, s->means + 3 * i, 3 * sizeof *s->means);
		memcpy(whole->scales + 3 * at, s->scales + 3 * i, 3 * sizeof *s->scales);
		memcpy(whole->quats + 4 * at, s->quats + 4 * i, 4 * sizeof *s->quats);
		whole->opacities[at++] = s->opacities[i];
	}
	return 0;
}

int asked_wholes(const struct asked *a, const struct splats *s, struct splats *wholes, struct err *e)
{
	for (size_t c = 0; c < a->channels; c++) {
		if (!take_whole(a, c, s, &wholes[c], e))
			continue;
		while (c--)
			splats_free(&wholes[c]);
		return -1;
	}
	return 0;
}
