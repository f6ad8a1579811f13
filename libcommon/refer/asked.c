#include "refer/asked.h"

#include "base/mem.h"
#include "refer/calibrate.h"
#include "ask/choose.h"
#include "refer/sight.h"
#include "splat/render.h"

#include <stdlib.h>
#include <string.h>

#define UNUSED SIZE_MAX

void asked_free(struct asked *a)
{
	free(a->responses);
	free(a->lifts);
	free(a->answer);
	free(a->sure);
	*a = (struct asked){0};
}

static int alloc_answers(struct asked *a, size_t answers, size_t gaussians, struct err *e)
{
	size_t bytes;

	if (mem_size(gaussians, sizeof *a->responses, &bytes))
		return err_set(e, ERR_SYSTEM, "responses: %zu Gaussians do not fit in memory", gaussians);
	a->answers = answers;
	a->responses = mem_alloc(answers, bytes, "responses", e);
	a->lifts = mem_zalloc(answers, sizeof *a->lifts, "responses", e);
	return a->responses && a->lifts ? 0 : -1;
}

static int ask_trained(struct asked *a, const struct respond_model *m, const struct asked_of *q,
	int wants_calibration, struct err *e)
{
	a->answer = mem_alloc(q->count, sizeof *a->answer, "sentences", e);
	if (!a->answer || alloc_answers(a, q->count, q->splats->n, e))
		return -1;
	for (size_t i = 0; i < q->count; i++)
		a->answer[i] = i;
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

/* answer[i] becomes the object that sentence i means, or, for none, the number of objects. */
static int choose_objects(struct asked *a, const struct lifted *l, const struct asked_of *q, unsigned parts,
	double least, struct err *e)
{
	const struct choose_scene scene = {l, q->splats, q->cameras, 1};
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
		bad = choose(&scene, sentences, q->count, parts, probability, e);
	for (size_t i = 0; i < q->count && !bad; i++) {
		const float *row = probability + i * l->objects;
		size_t best = 0;
		double any = 0;
		for (size_t o = 0; o < l->objects; o++) {
			best = row[o] > row[best] ? o : best;
			any += (double)row[o];
		}
		const int is_found = sentences[i].words && l->objects && any >= least;
		a->answer[i] = is_found ? best : l->objects;
		a->sure[i] = is_found ? (double)row[best] * l->confidence[best] : 0;
	}
	free(sentences);
	free(probability);
	return bad;
}

static int take_responses(struct asked *a, const struct lifted *l, const size_t *of, struct err *e)
{
	const size_t n = l->gaussians;

	for (size_t o = 0; o < l->objects; o++)
		if (of[o] != UNUSED)
			lifted_responses(l, o, a->responses + n * of[o]);
	if (of[l->objects] != UNUSED)
		memset(a->responses + n * of[l->objects], 0, n * sizeof *a->responses);
	return render_pack(a->responses, n, (int)a->answers, e);
}

static int ask_lifted(struct asked *a, const struct lifted *l, const struct asked_of *q, unsigned parts,
	double least, struct err *e)
{
	size_t *of, answers = 0;

	a->answer = mem_alloc(q->count, sizeof *a->answer, "sentences", e);
	a->sure = mem_alloc(q->count, sizeof *a->sure, "sentences", e);
	if (!a->answer || !a->sure || choose_objects(a, l, q, parts, least, e))
		return -1;
	of = mem_alloc(l->objects + 1, sizeof *of, "objects", e);
	for (size_t o = 0; o <= l->objects && of; o++)
		of[o] = UNUSED;
	for (size_t i = 0; i < q->count && of; i++) {
		size_t *own = &of[a->answer[i]];
		if (*own == UNUSED)
			*own = answers++;
		a->answer[i] = *own;
	}
	int bad = !of || alloc_answers(a, answers, l->gaussians, e) || take_responses(a, l, of, e);
	free(of);
	return bad ? -1 : 0;
}

int asked_lifted(struct asked *a, const struct lifted *l, const struct asked_of *q, unsigned parts,
	double least, struct err *e)
{
	*a = (struct asked){0};
	if (!ask_lifted(a, l, q, parts, least, e))
		return 0;
	asked_free(a);
	return -1;
}

/* A Gaussian's response, where render_pack has put it. */
static float packed(const struct asked *a, size_t n, size_t answer, size_t i)
{
	const size_t first = answer - answer % RENDER_GROUP, left = a->answers - first;
	const size_t now = left < RENDER_GROUP ? left : RENDER_GROUP;

	return a->responses[first * n + i * now + answer - first];
}

static int is_of(const struct asked *a, size_t n, size_t answer, size_t i)
{
	return packed(a, n, answer, i) > 0;
}

size_t asked_gaussians(const struct asked *a, size_t gaussians, size_t answer, int32_t *ids, float *responses)
{
	size_t n = 0;

	for (size_t i = 0; i < gaussians; i++) {
		const float response = packed(a, gaussians, answer, i);
		if (!(response > 0))
			continue;
		ids[n] = (int32_t)i;
		responses[n++] = response;
	}
	return n;
}

static int take_whole(const struct asked *a, size_t answer, const struct splats *s, const char *in_sight,
	struct splats *whole, struct err *e)
{
	size_t n = 0, at = 0;

	for (size_t i = 0; i < s->n; i++)
		n += in_sight[i] && is_of(a, s->n, answer, i);
	if (splats_alloc(whole, n, 1, e))
		return -1;
	memset(whole->sh, 0, n * 3 * sizeof *whole->sh);
	for (size_t i = 0; i < s->n; i++) {
		if (!in_sight[i] || !is_of(a, s->n, answer, i))
			continue;
		memcpy(whole->means + 3 * at, s->means + 3 * i, 3 * sizeof *s->means);
		memcpy(whole->scales + 3 * at, s->scales + 3 * i, 3 * sizeof *s->scales);
		memcpy(whole->quats + 4 * at, s->quats + 4 * i, 4 * sizeof *s->quats);
		whole->opacities[at++] = s->opacities[i];
	}
	return 0;
}

int asked_wholes(const struct asked *a, const struct splats *s, const struct cameras *cameras,
	struct splats *wholes, struct err *e)
{
	char *in_sight = mem_alloc(s->n, 1, "Gaussians", e);
	size_t done = 0;

	if (in_sight && !sight_find(s, cameras, in_sight, e))
		while (done < a->answers && !take_whole(a, done, s, in_sight, &wholes[done], e))
			done++;
	else
		done = SIZE_MAX;
	free(in_sight);
	if (done == a->answers)
		return 0;
	for (size_t k = 0; done != SIZE_MAX && k < done; k++)
		splats_free(&wholes[k]);
	return -1;
}
