#include "cmd/ask/reply.h"

#include "base/mem.h"
#include "cmd/masks/pictures.h"
#include "answer/answer.h"
#include "splat/render.h"

#include <math.h>

/* Views are compared at this size of their longer side, in pixels. */
enum { LOOK_SIDE = 200 };

/* The things, at least one, as one answer: where the response of any of them is above 0. */
static int take_responses(
	struct responses *to, const struct lifted *l, const size_t *things, size_t count, struct err *e)
{
	SCOPED float *own = mem_alloc(l->gaussians, sizeof *own, "responses", e);

	*to = (struct responses){.answers = 1};
	to->responses = mem_alloc(l->gaussians, sizeof *to->responses, "responses", e);
	to->lifts = mem_zalloc(1, sizeof *to->lifts, "responses", e);
	int bad = !own || !to->responses || !to->lifts;
	for (size_t k = 0; k < count && !bad; k++) {
		lifted_responses(l, things[k], k ? own : to->responses);
		for (size_t i = 0; i < l->gaussians && k; i++)
			to->responses[i] = fmaxf(to->responses[i], own[i]);
	}
	return bad || render_pack(to->responses, l->gaussians, 1, e) ? -1 : 0;
}

/* data: how much each view is worth. */
static int look(void *data, const struct answer *a, struct err *e)
{
	const int h = a->camera->height, w = a->camera->width;
	double *worth = data;
	size_t covered = 0;
	int is_cut = 0;

	(void)e;
	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++) {
			const int on = a->mask[(size_t)y * (size_t)w + (size_t)x];
			covered += (size_t)on;
			is_cut |= on && (!y || !x || y == h - 1 || x == w - 1);
		}
	worth[a->view] = (double)covered / ((double)h * w) * (is_cut ? 0.5 : 1);
	return 0;
}

static int best_view(
	const struct asking *a, const struct answer_question *q, const struct camera **view, struct err *e)
{
	const struct cameras *c = &a->scene.cameras;
	SCOPED double *worth = mem_zalloc(c->n, sizeof *worth, "views", e);
	SCOPED struct camera *small = mem_alloc(c->n, sizeof *small, "views", e);
	const struct answer_calls calls = {worth, look, NULL};
	size_t best = 0;

	for (size_t v = 0; v < c->n && small; v++)
		small[v] = camera_within(&c->views[v], LOOK_SIDE);
	if (!worth || !small || answer_all(q, small, c->n, &calls, e))
		return -1;
	for (size_t v = 1; v < c->n; v++)
		best = worth[v] > worth[best] ? v : best;
	*view = &c->views[best];
	return 0;
}

struct page {
	const char *const *words, *path;
	struct answer_drawn *drawn;
};

/* The rectangle around the mask. */
static void bound(const struct answer *a, struct answer_drawn *drawn)
{
	const int h = a->camera->height, w = a->camera->width;

	drawn->low[0] = w;
	drawn->low[1] = h;
	drawn->high[0] = drawn->high[1] = 0;
	for (int y = 0; y < h; y++)
		for (int x = 0; x < w; x++) {
			if (!a->mask[(size_t)y * (size_t)w + (size_t)x])
				continue;
			drawn->low[0] = x < drawn->low[0] ? x : drawn->low[0];
			drawn->low[1] = y < drawn->low[1] ? y : drawn->low[1];
			drawn->high[0] = x >= drawn->high[0] ? x + 1 : drawn->high[0];
			drawn->high[1] = y + 1;
		}
}

static int put_page(void *data, const struct answer *a, struct err *e)
{
	const struct page *page = data;
	const struct picture one = {.height = a->camera->height,
		.width = a->camera->width,
		.mask = a->mask,
		.rgb = a->rgb,
		.words = {page->words[0], page->words[1]}};

	bound(a, page->drawn);
	return picture_overlay(page->path, &one, e);
}

int answer_picture(const struct asking *a, const struct asking_answer *answer, const char *const words[2],
	const char *path, struct answer_drawn *drawn, struct err *e)
{
	SCOPED_BY(responses_free) struct responses responses = {0};
	struct answer_question q = {.splats = &a->scene.splats, .responses = &responses};
	struct page page = {words, path, drawn};
	const struct answer_calls calls = {&page, put_page, NULL};

	if (!drawn->view && !a->scene.cameras.n)
		return err_set(e, ERR_FORMAT, "%s: has no view to draw", a->files.scene);
	int bad = take_responses(&responses, &a->model.lifted, answer->things, answer->count, e) ||
		  (!drawn->view && best_view(a, &q, &drawn->view, e));
	if (!bad) {
		q.wants_rgb = 1;
		bad = answer_all(&q, drawn->view, 1, &calls, e);
	}
	return bad ? -1 : 0;
}

int answer_mask(const struct asking *a, const size_t *things, size_t count, const struct camera *view,
	const struct answer_calls *calls, struct err *e)
{
	SCOPED_BY(responses_free) struct responses responses = {0};
	struct splats shown;
	const struct answer_question q = {.splats = &shown, .responses = &responses};

	if (take_responses(&responses, &a->model.lifted, things, count, e) ||
		scene_splats_shown(&shown, &a->scene, view, e))
		return -1;
	const int bad = answer_all(&q, view, 1, calls, e);
	scene_splats_release(&shown, &a->scene);
	return bad;
}
