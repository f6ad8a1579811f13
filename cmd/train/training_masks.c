#include "cmd/train/training.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/records/masks.h"

#include <stdlib.h>

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
	const size_t n = t->masks.masks.n;
	char few[NAMES_FEW];
	size_t place;
	int bad = masks_find_view(m, &r->names, &t->scene.cameras, &place, e);
	const int is_unknown = !bad && place == NAMES_NONE;
	const struct camera *c = t->scene.cameras.views + (bad || is_unknown ? 0 : place);

	if (is_unknown && !r->unknown++)
		jsonl_err(j, &r->why, "key 'view': the scene has no view '%s'%s", m->view,
			names_few(&r->names, few));
	if (!is_unknown)
		bad = bad ||
		      masks_check_shape(m, "the view", c->height, c->width, j->path, j->line_number, e);
	t->test_masks += !bad && !is_unknown && c->split == SPLIT_TEST;
	if (bad || is_unknown || c->split == SPLIT_TEST) {
		mask_free(m);
		return bad ? -1 : 0;
	}
	long *view = &r->view_of[place];
	if (*view < 0) {
		*view = (long)t->views.n;
		bad = training_views_add(&t->views, place, e);
	}
	bad = bad || mem_grow((void **)&r->lines, &r->capacity, n + 1, sizeof *r->lines, "masks", e);
	if (bad) {
		mask_free(m);
		return -1;
	}
	r->lines[n] = j->line_number;
	const struct camera *sized = &t->views.cameras[*view];
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
