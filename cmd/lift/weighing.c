#include "cmd/lift/weighing.h"

#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/scene/weights.h"
#include "splat/weigh_packed.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <unistd.h>

static int in_split(const struct camera *c, int split)
{
	return split == WEIGHING_ALL || c->split == (split == WEIGHING_TEST ? SPLIT_TEST : SPLIT_TRAIN);
}

/* Memory that one view after the other uses. */
struct room {
	struct render_view *view;
	struct render_weights rendered;
	struct weighed_packed packed;
	float *dropped;
	size_t dropped_room;
	struct splats moved; /* at the view's time */
	double covered;	     /* the largest part of a view whose pixels are more scene than background */
};

static void room_free(struct room *room)
{
	render_free(room->view);
	render_weights_free(&room->rendered);
	weighed_packed_free(&room->packed);
	free(room->dropped);
}

static int prepare(struct room *room, const struct splats *s, const struct camera *c, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;

	if (mem_room((void **)&room->dropped, &room->dropped_room, pixels, sizeof *room->dropped, "weights",
		    e))
		return -1;
	memset(room->dropped, 0, pixels * sizeof *room->dropped);
	if (room->view)
		return render_again(room->view, s, c, e);
	room->view = render_prepare(s, c, e);
	return room->view ? 0 : -1;
}

static int render(struct room *room, const struct weighing_options *o, struct err *e)
{
	const struct render_limits limits = {
		o->tolerance, o->precision == PRECISION_U8 ? WEIGHTS_U8_LEAST : 0};

	return o->is_packed ? weigh_packed(&room->packed, room->view, &limits, room->dropped, e)
			    : render_weights_within(room->view, &limits, &room->rendered, room->dropped, e);
}

/* Views that show nothing are right where a camera looks away; all of them are a mistake: no weights stay. */
static int check_covered(
	const struct scene *s, const struct weighing_options *o, size_t views, double covered, struct err *e)
{
	if (covered >= WEIGHING_COVERED || !s->splats.n)
		return 0;
	for (size_t i = 0; i < s->cameras.n; i++) {
		SCOPED char *path =
			in_split(&s->cameras.views[i], o->split)
				? file_join(o->folder, s->cameras.views[i].name, ".safetensors", e)
				: NULL;
		if (path)
			remove(path);
	}
	return err_set(e, ERR_FORMAT,
		"%s: its splats are seen in none of %zu views (in at most %.2g%% of the pixels of one): the cameras are in another frame than the splats, or of another scene; import it with the cameras that it was trained with",
		o->scene, views, 100 * covered);
}

/* What is reported of a view. */
struct weighed {
	int width, height;
	double weights, ms;
};

struct weighing {
	const struct scene *scene;
	const struct weighing_options *options;
	const struct report *to;
	char text[128]; /* the options as the files record them */
	size_t n;
	const struct camera **views; /* (n) */
	struct weighed *done;	     /* (n) */
	struct room *rooms;	     /* of the workers */
};

static int weigh_view(void *context, int worker, size_t at, struct err *e)
{
	const struct weighing *of = context;
	const struct weighing_options *o = of->options;
	const struct camera *full = of->views[at];
	struct weighed *done = &of->done[at];
	struct room *room = &of->rooms[worker];
	const double start = omp_get_wtime();

	camera_scaled_size(full, o->scale, &done->width, &done->height);
	const size_t pixels = (size_t)done->width * (size_t)done->height;
	const struct camera camera = camera_resize(full, done->width, done->height);
	struct weighed_packed *packed = &room->packed;
	const struct render_weights *rendered = &room->rendered;
	int bad = scene_splats_at(&room->moved, of->scene, full, e) ||
		  prepare(room, &room->moved, &camera, e) || render(room, o, e);
	scene_splats_release(&room->moved, of->scene);
	done->ms = 1e3 * (omp_get_wtime() - start);
	const struct weights w = {.width = done->width,
		.height = done->height,
		.gaussians = (int64_t)of->scene->splats.n,
		.indptr = rendered->indptr,
		.index = rendered->index,
		.weight = rendered->weight,
		.dropped = room->dropped,
		.scene = of->scene->fingerprint,
		.camera = fingerprint_camera(&camera),
		.precision = o->precision,
		.pack = o->is_packed ? &packed->pack : NULL};
	if (!bad) {
		done->weights = o->is_packed ? (double)packed->weights : (double)rendered->indptr[pixels];
		const size_t covered =
			o->is_packed ? packed->covered : weigh_covered(rendered->transmittance, pixels);
		room->covered = fmax(room->covered, (double)covered / (double)pixels);
		bad = weights_write(&w, o->folder, full->name, of->text, e);
	}
	return bad;
}

static int report_view(void *context, size_t at, struct err *e)
{
	const struct weighing *of = context;
	const struct weighed *w = &of->done[at];
	(void)e;

	report_note(of->to, 1, "%s: %dx%d, %.0f weights, %.1f a pixel, %.1f ms", of->views[at]->name,
		w->width, w->height, w->weights, w->weights / ((double)w->width * (double)w->height), w->ms);
	report_step(of->to, (double)(at + 1), of->views[at]->name);
	return 0;
}

/* The views side by side, each with room of its own. */
static int weigh_views(struct weighing *of, struct err *e)
{
	const struct each by = {of, each_workers(of->n), weigh_view, report_view};
	SCOPED struct weighed *done = mem_alloc(of->n, sizeof *done, "views", e);
	SCOPED struct room *rooms = mem_zalloc((size_t)by.workers, sizeof *rooms, "views", e);
	double covered = 0;

	of->done = done;
	of->rooms = rooms;
	report_start(of->to, "views", (double)of->n);
	const int bad = !done || !rooms || each_run(&by, of->n, e);
	report_end(of->to);
	for (int k = 0; k < by.workers && rooms; k++) {
		covered = fmax(covered, rooms[k].covered);
		room_free(&rooms[k]);
	}
	return bad || check_covered(of->scene, of->options, of->n, covered, e) ? -1 : 0;
}

static int find_views(struct weighing *of, struct err *e)
{
	static const char *const names[] = {"train", "test", "all"};
	const struct cameras *all = &of->scene->cameras;
	const int split = of->options->split;

	of->views = mem_alloc(all->n, sizeof *of->views, "views", e);
	for (size_t i = 0; i < all->n && of->views; i++)
		if (in_split(&all->views[i], split))
			of->views[of->n++] = &all->views[i];
	if (!of->views || of->n)
		return of->views ? 0 : -1;
	return err_set(e, ERR_FORMAT, "%s: no view belongs to split '%s'", of->options->scene, names[split]);
}

int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e)
{
	const int was_there = file_exists(o->folder);
	struct weighing of = {.scene = s, .options = o, .to = to};

	snprintf(of.text, sizeof of.text, "--scale %.15g --tolerance %.15g --precision %s%s", o->scale,
		o->tolerance, precision_name(o->precision), o->is_packed ? " --packed" : "");
	const int cannot = find_views(&of, e) || file_make_dir(o->folder, e);
	const int bad = cannot || weigh_views(&of, e);
	free(of.views);
	if (bad && !cannot && !was_there)
		rmdir(o->folder); /* where it is empty */
	return bad ? -1 : 0;
}
