#include "cmd/train/training.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/records/masks.h"
#include "splat/backproject.h"

#include <libdeflate.h>
#include <stdlib.h>

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

/* What the masks are read with. */
struct mask_reading {
	struct names names; /* of the scene's views */
	long *view_of;	    /* (the scene's views) the training view, or -1 */
	size_t capacity;
	long *lines;	/* of each mask that was kept */
	size_t unknown; /* masks of views that the scene lacks */
	struct err why; /* the first of them */
};

/* One mask, taken over: its view's weights are read when it is the first of the view. */
static int add_mask(
	struct training *t, const struct jsonl *j, struct mask *m, struct mask_reading *r, struct err *e)
{
	SCOPED_BY(mask_free) struct mask own = *m;
	const size_t n = t->masks.masks.n;
	char few[NAMES_FEW];
	size_t place;

	if (masks_find_view(&own, &r->names, &t->scene.cameras, &place, e))
		return -1;
	if (place == NAMES_NONE) {
		if (!r->unknown++)
			jsonl_err(j, &r->why, "key 'view': the scene has no view '%s'%s", own.view,
				names_few(&r->names, few));
		return 0;
	}
	const struct camera *c = &t->scene.cameras.views[place];
	if (masks_check_shape(&own, "the view", c->height, c->width, j->path, j->line_number, e))
		return -1;
	t->test_masks += c->split == SPLIT_TEST;
	if (c->split == SPLIT_TEST)
		return 0;
	long *view = &r->view_of[place];
	if (*view < 0) {
		*view = (long)t->views.n;
		if (training_views_add(&t->views, place, e))
			return -1;
	}
	if (mem_grow((void **)&r->lines, &r->capacity, n + 1, sizeof *r->lines, "masks", e))
		return -1;
	r->lines[n] = j->line_number;
	const struct camera *sized = &t->views.cameras[*view];
	*m = own;
	own = (struct mask){0};
	return supervision_add(&t->masks, (size_t)*view, sized->width, sized->height, m, e);
}

static int add_masks(struct training *t, const char *path, struct mask_reading *r, struct err *e)
{
	struct err reason;
	struct mask m;
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	size_t later = 0;
	int more;

	if (jsonl_open(&j, path, e))
		return -1;
	while ((more = masks_next(&j, &m, e)) == 1)
		if (add_mask(t, &j, &m, r, e)) {
			more = -1;
			break;
		}
	if (more || !supervision_index(&t->masks, &later, &reason))
		return more;
	if (reason.code != ERR_FORMAT)
		return err_set(e, reason.code, "%s", reason.message);
	return err_set(e, ERR_FORMAT, "%s:%ld: %s", file_name(path), r->lines[later], reason.message);
}

/* Masks of views that the scene lacks are left out, unless all are. */
static int check_unknown(
	const struct training *t, const struct mask_reading *r, const struct report *to, struct err *e)
{
	if (!r->unknown)
		return 0;
	if (!t->masks.masks.n && !t->test_masks)
		return err_set(e, ERR_FORMAT, "%s", r->why.message);
	report_warn(to, "%s: %zu masks, of views that it lacks, are left out", r->why.message, r->unknown);
	return 0;
}

int training_read_masks(
	struct training *t, const char *weights, const char *path, const struct report *to, struct err *e)
{
	const size_t count = t->scene.cameras.n;
	struct mask_reading r = {.view_of = mem_alloc(count, sizeof *r.view_of, "views", e)};

	int bad = !r.view_of || training_views_init(&t->views, &t->scene, weights, e) ||
		  names_make(&r.names, t->scene.cameras.views, sizeof *t->scene.cameras.views,
			  offsetof(struct camera, name), count, e);
	for (size_t v = 0; v < count && !bad; v++)
		r.view_of[v] = -1;
	bad = bad || add_masks(t, path, &r, e) || check_unknown(t, &r, to, e);
	names_free(&r.names);
	free(r.view_of);
	free(r.lines);
	return bad ? -1 : 0;
}
