#include "cmd/train/training.h"

#include "base/mem.h"
#include "splat/backproject.h"

#include <libdeflate.h>
#include <stdlib.h>

int training_views_init(
	struct training_views *t, const struct scene *scene, const char *folder, struct err *e)
{
	const size_t n = scene->cameras.n;

	*t = (struct training_views){.scene = scene, .folder = folder};
	t->views = mem_zalloc(n, sizeof *t->views, "views", e);
	t->read = mem_zalloc(n, sizeof *t->read, "views", e);
	t->cameras = mem_zalloc(n, sizeof *t->cameras, "views", e);
	t->weight = mem_zalloc(scene->splats.n, sizeof *t->weight, "weight", e);
	return t->views && t->read && t->cameras && t->weight ? 0 : -1;
}

void training_views_free(struct training_views *t)
{
	for (size_t v = 0; v < t->n; v++)
		weights_close(&t->read[v].file);
	free(t->views);
	free(t->read);
	free(t->cameras);
	free(t->weight);
	*t = (struct training_views){0};
}

static void add_sum(struct training_view *v, const void *data, size_t bytes)
{
	v->sum = libdeflate_crc32(v->sum, data, bytes);
	v->bytes += bytes;
}

static void sum_up(struct training_view *v, const struct view_weights *w)
{
	const size_t count = (size_t)w->indptr[w->pixels];

	add_sum(v, w->indptr, sizeof *w->indptr * (w->pixels + 1));
	add_sum(v, w->index, sizeof *w->index * count);
	add_sum(v, w->weight, sizeof *w->weight * count);
}

int training_views_add(struct training_views *t, size_t camera, struct err *e)
{
	struct training_view *v = &t->read[t->n];
	struct train_view *view = &t->views[t->n];

	if (weights_open(&v->file, t->folder, t->scene, camera, e))
		return -1;
	v->at = camera;
	t->cameras[t->n++] = camera_resize(&t->scene->cameras.views[camera], v->file.width, v->file.height);
	view->weights = weights_view(&v->file);
	sum_up(v, &view->weights);
	backproject_weight(&view->weights, t->weight);
	view->weights =
		(struct view_weights){view->weights.pixels, view->weights.gaussians, NULL, NULL, NULL};
	t->pixels = view->weights.pixels > t->pixels ? view->weights.pixels : t->pixels;
	weights_close(&v->file);
	return 0;
}

static int open_view(void *context, size_t view, struct view_weights *w, struct err *e)
{
	struct training_views *t = context;
	struct training_view *v = &t->read[view], again = {0};

	if (weights_open(&v->file, t->folder, t->scene, v->at, e))
		return -1;
	*w = weights_view(&v->file);
	sum_up(&again, w);
	if (w->pixels == t->views[view].weights.pixels && again.bytes == v->bytes && again.sum == v->sum)
		return 0;
	err_set(e, ERR_SYSTEM, "%s: changed while it was learned from", v->file.file.path);
	weights_close(&v->file);
	return -1;
}

static void close_view(void *context, size_t view)
{
	struct training_views *t = context;

	weights_close(&t->read[view].file);
}

struct view_source training_views_source(struct training_views *t)
{
	struct view_source s = {t->views, t->n, open_view, close_view, t, 0};

	for (size_t v = 0; v < t->n; v++)
		s.largest = t->read[v].bytes > s.largest ? t->read[v].bytes : s.largest;
	return s;
}
