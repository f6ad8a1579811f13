#include "cmd/train/training.h"

#include "base/mem.h"
#include "formats/records/masks.h"
#include "splat/backproject.h"

#include <libdeflate.h>

static int training_views_init(
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
	mem_free_all(t->views, t->read, t->cameras, t->weight);
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

/* Reads a view of the scene's, the next one. Returns as training_views_init. */
static int training_views_add(struct training_views *t, size_t camera, struct err *e)
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

/* One mask, taken over: its view's weights are read when it is the first of the view. view_of (the scene's
 * views): 1 + the training view, or 0. */
static int add_mask(struct training *t, struct mask *m, size_t place, size_t *view_of, struct err *e)
{
	struct mask own = *m;

	if (!view_of[place]) {
		if (training_views_add(&t->views, place, e))
			return -1;
		view_of[place] = t->views.n;
	}
	const size_t view = view_of[place] - 1;
	const struct camera *sized = &t->views.cameras[view];
	*m = (struct mask){0};
	return supervision_add(&t->masks, view, sized->width, sized->height, &own, e);
}

int training_read_masks(
	struct training *t, const char *weights, const char *path, const struct report *to, struct err *e)
{
	const struct cameras *c = &t->scene.cameras;
	SCOPED_BY(masks_free) struct masks set = {0};
	SCOPED long *lines = NULL;
	struct err reason;
	size_t later = 0;

	if (masks_read_lines(&set, &lines, path, e))
		return -1;
	SCOPED size_t *views = mem_alloc(set.n, sizeof *views, "masks", e);
	SCOPED size_t *view_of = mem_zalloc(c->n, sizeof *view_of, "views", e);
	if (!views || !view_of || masks_views(&set, lines, path, c, views, to, e) ||
		training_views_init(&t->views, &t->scene, weights, e))
		return -1;
	for (size_t i = 0; i < set.n; i++) {
		if (c->views[views[i]].split == SPLIT_TEST) {
			t->test_masks++;
			continue;
		}
		lines[t->masks.masks.n] = lines[i];
		if (add_mask(t, &set.items[i], views[i], view_of, e))
			return -1;
	}
	if (!supervision_index(&t->masks, &later, &reason))
		return 0;
	if (reason.code != ERR_FORMAT)
		return err_set(e, reason.code, "%s", reason.message);
	return err_set(e, ERR_FORMAT, "%s:%ld: %s", file_name(path), lines[later], reason.message);
}
