#include "cmd/report/reporting.h"

#include "answer/answer.h"
#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_VIEWS = 6 };

struct collecting {
	const struct report *to;
	const struct responses *responses;
	struct rle *shown; /* (views, answers) */
};

static int keep_mask(void *data, const struct answer *a, struct err *e)
{
	const struct collecting *c = data;
	struct rle *to = &c->shown[a->view * c->responses->answers + a->answer];

	return rle_encode(to, a->mask, a->camera->height, a->camera->width, e);
}

static int step(void *data, size_t view, struct err *e)
{
	const struct collecting *c = data;

	(void)e;
	report_step(c->to, (double)view + 1, NULL);
	return 0;
}

static int put_mask(struct report_set *s, size_t sentence, const char *view, const struct rle *mask,
	double score, struct err *e)
{
	const char *object = text_object(&s->text, sentence);
	struct mask own = {.score = rle_area(mask) ? score : 0, .visible = NAN};

	own.view = mem_strdup(view, e);
	own.ref = mem_strdup(s->text.refs[sentence], e);
	own.object = object ? mem_strdup(object, e) : NULL;
	if (!own.view || !own.ref || (object && !own.object) ||
		rle_from_runs(&own.rle, mask->runs, mask->n, mask->height, mask->width, e)) {
		mask_free(&own);
		return -1;
	}
	return masks_add(&s->masks.set, &own, e);
}

static int put_masks(struct report_set *s, const struct collecting *c, const struct camera *views,
	size_t view_count, struct err *e)
{
	const struct responses *a = c->responses;

	for (size_t v = 0; v < view_count; v++)
		for (size_t i = 0; i < s->text.n; i++)
			if (put_mask(s, i, views[v].name, &c->shown[v * a->answers + a->answer[i]],
				    a->sure[i], e))
				return -1;
	s->masks.n = s->masks.set.n;
	return 0;
}

static int ask(const struct report_run *r, const struct text *t, struct responses *a, struct err *e)
{
	SCOPED size_t *which = mem_alloc(t->n, sizeof *which, "sentences", e);
	const struct anymodel_ask q = {.scene = &r->scene,
		.text = t,
		.model_path = r->lifted_path,
		.scene_path = r->scene.path,
		.text_path = "text.safetensors",
		.which = which,
		.count = t->n,
		.parts = CHOOSE_ALL,
		.least = RESPONSES_LEAST};

	if (!which)
		return -1;
	for (size_t i = 0; i < t->n; i++)
		which[i] = i;
	return anymodel_answer(&r->lifted, &q, a, e);
}

int report_answer(const struct report_run *r, struct report_set *s, const struct report *to, struct err *e)
{
	struct camera views[MOST_VIEWS];
	const size_t most = r->options->views < MOST_VIEWS ? (size_t)r->options->views : MOST_VIEWS;
	const size_t n = cameras_spread(&r->scene.cameras, most, (int)r->options->width, views);
	SCOPED_BY(responses_free) struct responses a = {0};
	struct collecting c = {to, &a, NULL};
	const struct answer_question q = {.splats = &r->scene.splats, .responses = &a};
	const struct answer_calls calls = {&c, keep_mask, step};

	if (ask(r, &s->text, &a, e))
		return -1;
	report_start(to, "views", (double)n);
	int bad = !(c.shown = mem_zalloc(n * a.answers, sizeof *c.shown, "masks", e)) ||
		  answer_all(&q, views, n, &calls, e) || put_masks(s, &c, views, n, e);
	report_end(to);
	for (size_t k = 0; c.shown && k < n * a.answers; k++)
		rle_free(&c.shown[k]);
	free(c.shown);
	return bad ? -1 : 0;
}
