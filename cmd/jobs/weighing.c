#include "cmd/jobs/weighing.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/precision.h"
#include "formats/weights.h"
#include "splat/prune.h"
#include "splat/render.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int in_split(const struct camera *c, int split)
{
	return split == WEIGHING_ALL || c->split == (split == WEIGHING_TEST ? SPLIT_TEST : SPLIT_TRAIN);
}

/* Memory that one view after the other uses: a view's weights take a hundred megabytes. */
struct room {
	struct render_view *view;
	struct render_weights rendered;
	float *dropped;
	size_t dropped_room;
	double covered;	   /* the largest part of a view whose pixels are more scene than background */
	char options[128]; /* as the files record them */
};

static void room_free(struct room *room)
{
	render_free(room->view);
	render_weights_free(&room->rendered);
	free(room->dropped);
}

static int render(struct room *room, const struct splats *s, const struct camera *c,
	const struct weighing_options *o, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;

	if (mem_room((void **)&room->dropped, &room->dropped_room, pixels, sizeof *room->dropped, "weights",
		    e))
		return -1;
	memset(room->dropped, 0, pixels * sizeof *room->dropped);
	if (room->view ? render_again(room->view, s, c, e) : !(room->view = render_prepare(s, c, e)))
		return -1;
	if (render_weights_again(room->view, &room->rendered, e))
		return -1;
	if (o->tolerance > 0 && prune_weights(&room->rendered, pixels, o->tolerance, room->dropped, e))
		return -1;
	if (o->precision == PRECISION_U8)
		prune_below(&room->rendered, pixels, WEIGHTS_U8_LEAST, room->dropped);
	return 0;
}

/* The part of the pixels that are more scene than background. */
static double cover(const struct render_weights *w, size_t pixels)
{
	size_t covered = 0;

	for (size_t p = 0; p < pixels; p++)
		covered += w->transmittance[p] < 0.5F;
	return (double)covered / (double)pixels;
}

/* Views that show nothing are right where a camera looks away; all of them are a mistake, and their weights
 * go.
 */
static int check_covered(
	const struct scene *s, const struct weighing_options *o, size_t views, double covered, struct err *e)
{
	if (covered >= WEIGHING_COVERED || !s->splats.n)
		return 0;
	for (size_t i = 0; i < s->cameras.n; i++) {
		char *path = in_split(&s->cameras.views[i], o->split)
				     ? file_join(o->folder, s->cameras.views[i].name, ".safetensors", e)
				     : NULL;
		if (path)
			remove(path);
		free(path);
	}
	return err_set(e, ERR_FORMAT,
		"%s: its splats are seen in none of %zu views (in at most %.2g%% of the pixels of one): the cameras are in another frame than the splats, or of another scene; import it with the cameras that it was trained with",
		o->scene, views, 100 * covered);
}

static int weigh_view(const struct report *to, const struct scene *s, const struct camera *full,
	const struct weighing_options *o, struct room *room, struct err *e)
{
	double start = omp_get_wtime();
	int width, height;

	camera_scaled_size(full, o->scale, &width, &height);
	struct camera camera = camera_resize(full, width, height);
	if (render(room, &s->splats, &camera, o, e))
		return -1;
	double ms = 1e3 * (omp_get_wtime() - start);
	struct weights w = {.width = width,
		.height = height,
		.gaussians = (int64_t)s->splats.n,
		.indptr = room->rendered.indptr,
		.index = room->rendered.index,
		.weight = room->rendered.weight,
		.dropped = room->dropped,
		.scene = s->fingerprint,
		.camera = fingerprint_camera(&camera),
		.precision = o->precision,
		.is_packed = o->is_packed};
	if (weights_write(&w, o->folder, full->name, room->options, e))
		return -1;
	room->covered = fmax(room->covered, cover(&room->rendered, (size_t)width * (size_t)height));
	size_t pixels = (size_t)width * (size_t)height;
	double nnz = (double)w.indptr[pixels];
	report_note(to, 1, "%s: %dx%d, %.0f weights, %.1f a pixel, %.1f ms", full->name, width, height, nnz,
		nnz / (double)pixels, ms);
	return 0;
}

int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e)
{
	static const char *const names[] = {"train", "test", "all"};
	const int was_there = file_exists(o->folder);
	size_t views = 0, done = 0;
	struct room room = {0};
	int bad = 0;

	for (size_t i = 0; i < s->cameras.n; i++)
		views += (size_t)in_split(&s->cameras.views[i], o->split);
	if (!views)
		return err_set(e, ERR_FORMAT, "%s: no view belongs to split '%s'", o->scene, names[o->split]);
	if (file_make_dir(o->folder, e))
		return -1;
	snprintf(room.options, sizeof room.options, "--scale %.15g --tolerance %.15g --precision %s%s",
		o->scale, o->tolerance, precision_name(o->precision), o->is_packed ? " --packed" : "");
	report_start(to, "views", (double)views);
	for (size_t i = 0; !bad && i < s->cameras.n; i++) {
		const struct camera *view = &s->cameras.views[i];
		if (!in_split(view, o->split))
			continue;
		bad = weigh_view(to, s, view, o, &room, e);
		report_step(to, (double)++done, view->name);
	}
	report_end(to);
	bad = bad || check_covered(s, o, views, room.covered, e);
	room_free(&room);
	if (bad && !was_there)
		rmdir(o->folder); /* where it is empty */
	return bad ? -1 : 0;
}
