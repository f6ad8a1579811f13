#include "answer/responses.h"

#include "answer/calibrate.h"
#include "base/mem.h"
#include "splat/render.h"
#include "splat/visibility.h"

#include <math.h>

void responses_free(struct responses *a)
{
	mem_free_all(a->responses, a->lifts, a->answer, a->sure, a->when, a->begin, a->objects, a->alone);
	*a = (struct responses){0};
}

static int alloc_answers(struct responses *a, size_t answers, size_t gaussians, struct err *e)
{
	size_t bytes;

	if (mem_size(gaussians, sizeof *a->responses, &bytes))
		return err_set(e, ERR_SYSTEM, "responses: %zu Gaussians do not fit in memory", gaussians);
	a->answers = answers;
	a->responses = mem_alloc(answers, bytes, "responses", e);
	a->lifts = mem_zalloc(answers, sizeof *a->lifts, "responses", e);
	return a->responses && a->lifts ? 0 : -1;
}

/* Weights that are finite may still be so large that what is made of them is not. */
static int check_finite(const float *responses, const struct responses_question *q, struct err *e)
{
	const size_t n = q->splats->n;

	for (size_t i = 0; i < q->count; i++)
		for (size_t k = 0; k < n; k++)
			if (!isfinite(responses[i * n + k]))
				return err_file(e, q->model_path,
					"the responses to ref '%s' are not finite: its weights are too large",
					q->refs[q->which[i]]);
	return 0;
}

/* Shares in place of the logits of some answers, packed; sure: the mean of their own probability over the
 * Gaussians above 0. */
static void make_shares(float *responses, size_t n, size_t now, const double *lifts, double *sure)
{
	double sum[RENDER_GROUP] = {0};
	size_t above[RENDER_GROUP] = {0};

	for (size_t i = 0; i < n; i++)
		for (size_t r = 0; r < now; r++) {
			float *own = &responses[i * now + r];
			const double logit = (double)*own;
			if (logit > 0) {
				sum[r] += 1 / (1 + exp(lifts[r] - logit));
				above[r]++;
			}
			*own = (float)tanh(logit / 2);
		}
	for (size_t r = 0; r < now; r++)
		sure[r] = above[r] ? sum[r] / (double)above[r] : 0;
}

static int blend_shares(struct responses *a, size_t n, struct err *e)
{
	a->sure = mem_alloc(a->answers, sizeof *a->sure, "sentences", e);
	if (!a->sure)
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (size_t first = 0; first < a->answers; first += RENDER_GROUP) {
		const size_t left = a->answers - first, now = left < RENDER_GROUP ? left : RENDER_GROUP;
		make_shares(a->responses + first * n, n, now, a->lifts + first, a->sure + first);
	}
	return 0;
}

int responses_trained(struct responses *a, const struct respond_model *m, const struct responses_question *q,
	int wants_calibration, struct err *e)
{
	*a = (struct responses){.answer = mem_alloc(q->count, sizeof *a->answer, "sentences", e)};
	if (!a->answer || alloc_answers(a, q->count, q->splats->n, e))
		return -1;
	for (size_t i = 0; i < q->count; i++)
		a->answer[i] = i;
	if (respond_all(m, q->offsets, q->words, q->which, q->count, a->responses, e) ||
		check_finite(a->responses, q, e) || render_pack(a->responses, q->splats->n, (int)q->count, e))
		return -1;
	int bad = wants_calibration &&
		  calibrate(q->splats, q->cameras, m->rows, a->responses, q->count, a->lifts, e);
	return -(bad || (m->blend == REFER_SHARES && blend_shares(a, q->splats->n, e)));
}

int responses_selected(struct responses *a, const struct responses_selection *s, const size_t *row,
	size_t count, struct err *e)
{
	*a = (struct responses){.answer = mem_alloc(count, sizeof *a->answer, "sentences", e)};
	if (!a->answer || alloc_answers(a, count, s->gaussians, e))
		return -1;
	for (size_t i = 0; i < count; i++) {
		float *to = a->responses + i * s->gaussians;
		a->answer[i] = i;
		for (size_t k = 0; k < s->gaussians; k++)
			to[k] = -RESPONSES_SELECTED;
		for (int64_t k = s->indptr[row[i]]; k < s->indptr[row[i] + 1]; k++)
			to[s->index[k]] = 1 - RESPONSES_SELECTED;
	}
	return render_pack(a->responses, s->gaussians, (int)count, e);
}

/* What sentences mean: sets of objects. */
struct meant {
	struct choose_sentence *sentences; /* (count) */
	struct choice *choices;
	float *probability; /* (count,O) */
	char *chosen;
};

static void meant_free(struct meant *m)
{
	mem_free_all(m->sentences, m->choices, m->probability, m->chosen);
}

static int meant_alloc(struct meant *m, size_t count, size_t objects, struct err *e)
{
	size_t bytes;

	if (mem_size(objects, sizeof *m->probability, &bytes))
		return err_set(e, ERR_SYSTEM, "probabilities of %zu objects do not fit in memory", objects);
	m->sentences = mem_alloc(count, sizeof *m->sentences, "sentences", e);
	m->choices = mem_alloc(count, sizeof *m->choices, "sentences", e);
	m->probability = mem_alloc(count, bytes, "probabilities", e);
	m->chosen = mem_alloc(count, objects, "objects", e);
	return m->sentences && m->choices && m->probability && m->chosen ? 0 : -1;
}

/* What each sentence means; a sentence that means nothing has no objects. */
static int find_meant(struct meant *m, struct responses *a, const struct lifted *l,
	const struct responses_question *q, unsigned parts, double least, struct err *e)
{
	const struct choose_scene scene = {l, q->splats, q->cameras, q->parser, 1, q->tracks};

	for (size_t i = 0; i < q->count; i++) {
		const size_t r = q->which[i], at = (size_t)q->offsets[r] * (size_t)l->width;
		m->sentences[i] = (struct choose_sentence){q->texts[r], q->pieces[r], q->words + at,
			q->middle ? q->middle + at : NULL, (size_t)(q->offsets[r + 1] - q->offsets[r]),
			q->from ? q->from[i] : (struct viewpoint){.kind = VIEWPOINT_USUAL}, NULL, 0};
	}
	if (choose(&scene, m->sentences, q->count, parts, m->choices, m->probability, m->chosen, NULL, e))
		return -1;
	for (size_t i = 0; i < q->count; i++) {
		char *chosen = m->chosen + i * l->objects;
		for (int k = 0; k < 2; k++)
			a->when[i][k] = m->choices[i].is_motion && m->choices[i].there >= least
						? m->choices[i].when[k]
						: NAN;
		double sum = 0, n = 0;
		if (m->choices[i].there < least)
			memset(chosen, 0, l->objects);
		for (size_t o = 0; o < l->objects; o++)
			if (chosen[o]) {
				sum += (double)m->probability[i * l->objects + o] * l->confidence[o];
				n++;
			}
		a->sure[i] = n > 0 ? m->choices[i].there * sum / n : 0;
	}
	return 0;
}

/* Different sets of objects. */
struct sets {
	size_t n, objects;
	char *chosen; /* (n,objects) */
};

/* The place of a set, which is added where it is new. */
static size_t find_set(struct sets *s, const char *chosen)
{
	size_t k = 0;

	while (k < s->n && memcmp(s->chosen + k * s->objects, chosen, s->objects) != 0)
		k++;
	if (k == s->n)
		memcpy(s->chosen + s->n++ * s->objects, chosen, s->objects);
	return k;
}

/* a->begin and a->objects of the sets; where parts are wanted the sets of one object, and a->alone. */
static int list_objects(struct responses *a, struct sets *s, int wants_parts, struct err *e)
{
	const size_t most = s->n + (wants_parts ? s->objects : 0), meant = s->n;
	SCOPED char *one = mem_zalloc(s->objects, 1, "answers", e);

	a->begin = mem_zalloc(most + 1, sizeof *a->begin, "answers", e);
	a->objects = mem_alloc(most, s->objects * sizeof *a->objects, "answers", e);
	a->alone = wants_parts ? mem_alloc(most, s->objects * sizeof *a->alone, "answers", e) : NULL;
	int bad = !one || !a->begin || !a->objects || (wants_parts && !a->alone);
	for (size_t k = 0; k < s->n && !bad; k++) {
		size_t at = a->begin[k];
		for (size_t o = 0; o < s->objects; o++) {
			if (!s->chosen[k * s->objects + o])
				continue;
			one[o] = 1;
			if (wants_parts)
				a->alone[at] = k < meant ? find_set(s, one) : k;
			one[o] = 0;
			a->objects[at++] = o;
		}
		a->begin[k + 1] = at;
	}
	return bad ? -1 : 0;
}

/* to (N): the responses of the union of some objects. own (N) is scratch. */
static void union_of(const struct lifted *l, const char *chosen, float *own, float *to)
{
	size_t count = 0;

	memset(to, 0, l->gaussians * sizeof *to);
	for (size_t o = 0; o < l->objects; o++) {
		if (!chosen[o])
			continue;
		float *at = count ? own : to;
		lifted_responses(l, o, at);
		for (size_t i = 0; i < l->gaussians && count; i++)
			to[i] = own[i] > to[i] ? own[i] : to[i];
		count++;
	}
}

static int take_answers(struct responses *a, const struct lifted *l, const struct sets *s, struct err *e)
{
	SCOPED float *own = mem_alloc(l->gaussians, sizeof *own, "responses", e);
	int bad = !own || alloc_answers(a, s->n, l->gaussians, e);

	for (size_t k = 0; k < s->n && !bad; k++)
		union_of(l, s->chosen + k * s->objects, own, a->responses + k * l->gaussians);
	return bad ? -1 : render_pack(a->responses, l->gaussians, (int)s->n, e);
}

int responses_lifted(struct responses *a, const struct lifted *l, const struct responses_question *q,
	unsigned parts, double least, struct err *e)
{
	SCOPED_BY(meant_free) struct meant m = {0};
	struct sets sets = {
		.objects = l->objects, .chosen = mem_alloc(q->count + l->objects, l->objects, "answers", e)};

	*a = (struct responses){.answer = mem_alloc(q->count, sizeof *a->answer, "sentences", e),
		.sure = mem_alloc(q->count, sizeof *a->sure, "sentences", e),
		.when = mem_alloc(q->count, sizeof *a->when, "sentences", e)};
	int bad = !sets.chosen || !a->answer || !a->sure || !a->when ||
		  meant_alloc(&m, q->count, l->objects, e) || find_meant(&m, a, l, q, parts, least, e);
	for (size_t i = 0; i < q->count && !bad; i++)
		a->answer[i] = find_set(&sets, m.chosen + i * l->objects);
	bad = bad || list_objects(a, &sets, q->wants_parts, e) || take_answers(a, l, &sets, e);
	free(sets.chosen);
	return bad ? -1 : 0;
}

/* A Gaussian's response, where render_pack has put it. */
static float packed(const struct responses *a, size_t n, size_t answer, size_t i)
{
	const size_t first = answer - answer % RENDER_GROUP, left = a->answers - first;
	const size_t now = left < RENDER_GROUP ? left : RENDER_GROUP;

	return a->responses[first * n + i * now + answer - first];
}

static int is_of(const struct responses *a, size_t n, size_t answer, size_t i)
{
	return packed(a, n, answer, i) > 0;
}

size_t responses_gaussians(
	const struct responses *a, size_t gaussians, size_t answer, int32_t *ids, float *responses)
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

static int take_whole(const struct responses *a, size_t answer, const struct splats *s, const char *in_sight,
	struct splats *whole, struct err *e)
{
	size_t n = 0, at = 0;

	for (size_t i = 0; i < s->n; i++)
		n += in_sight[i] && is_of(a, s->n, answer, i);
	if (splats_alloc(whole, n, 1, e))
		return -1;
	whole->near = s->near;
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

int responses_wholes(const struct responses *a, const struct splats *s, const struct cameras *cameras,
	struct splats *wholes, struct err *e)
{
	SCOPED char *in_sight = mem_alloc(s->n, 1, "Gaussians", e);
	size_t done = 0;

	if (in_sight && !visibility_find(s, cameras, in_sight, e))
		while (done < a->answers && !take_whole(a, done, s, in_sight, &wholes[done], e))
			done++;
	else
		done = SIZE_MAX;
	if (done == a->answers)
		return 0;
	for (size_t k = 0; done != SIZE_MAX && k < done; k++)
		splats_free(&wholes[k]);
	return -1;
}
