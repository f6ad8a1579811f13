#include "cmd/jobs/weighing.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/threads.h"
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

/* Views at a time: a view's weights may take a hundred megabytes. */
enum { WORKERS_MOST = 8 };

/* Memory that one view after the other uses. */
struct room {
	struct render_view *view;
	struct render_weights rendered;
	float *dropped;
	size_t dropped_room;
	double covered; /* the largest part of a view whose pixels are more scene than background */
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

struct weighing {
	const struct scene *scene;
	const struct weighing_options *options;
	char text[128]; /* the options as the files record them */
};

/* What is reported of a view. */
struct weighed {
	int width, height;
	double weights, ms;
};

static int weigh_view(const struct weighing *of, const struct camera *full, struct room *room,
	struct weighed *done, struct err *e)
{
	const struct scene *s = of->scene;
	const struct weighing_options *o = of->options;
	const double start = omp_get_wtime();

	camera_scaled_size(full, o->scale, &done->width, &done->height);
	const size_t pixels = (size_t)done->width * (size_t)done->height;
	const struct camera camera = camera_resize(full, done->width, done->height);
	if (render(room, &s->splats, &camera, o, e))
		return -1;
	done->ms = 1e3 * (omp_get_wtime() - start);
	done->weights = (double)room->rendered.indptr[pixels];
	const struct weights w = {.width = done->width,
		.height = done->height,
		.gaussians = (int64_t)s->splats.n,
		.indptr = room->rendered.indptr,
		.index = room->rendered.index,
		.weight = room->rendered.weight,
		.dropped = room->dropped,
		.scene = s->fingerprint,
		.camera = fingerprint_camera(&camera),
		.precision = o->precision,
		.is_packed = o->is_packed};
	room->covered = fmax(room->covered, cover(&room->rendered, pixels));
	return weights_write(&w, o->folder, full->name, of->text, e);
}

static void report_view(const struct report *to, const char *name, const struct weighed *w, size_t done)
{
	report_note(to, 1, "%s: %dx%d, %.0f weights, %.1f a pixel, %.1f ms", name, w->width, w->height,
		w->weights, w->weights / ((double)w->width * (double)w->height), w->ms);
	report_step(to, (double)done, name);
}

/* The views side by side, each with room of its own and one part of the threads; they are reported in their
 * order. The error is that of the first view that has one. covered: as check_covered takes it. */
static int weigh_views(const struct weighing *of, const size_t *views, size_t n, const struct report *to,
	double *covered, struct err *e)
{
	const int threads = threads_available();
	const int workers = threads < WORKERS_MOST ? threads : WORKERS_MOST;
	const int levels = omp_get_max_active_levels();
	size_t failed = n;
	double most = 0;

	omp_set_max_active_levels(threads > workers ? 2 : levels);
#pragma omp parallel num_threads(workers) reduction(max : most)
	{
		struct room room = {0};
		omp_set_num_threads(threads / workers);
#pragma omp for schedule(dynamic) ordered
		for (size_t i = 0; i < n; i++) {
			const struct camera *view = &of->scene->cameras.views[views[i]];
			struct weighed done = {0};
			struct err own;
			size_t end;
#pragma omp atomic read
			end = failed;
			const int bad = i < end && weigh_view(of, view, &room, &done, &own);
#pragma omp ordered
			{
				if (bad && failed == n) {
					*e = own;
#pragma omp atomic write
					failed = i;
				}
				if (failed == n)
					report_view(to, view->name, &done, i + 1);
			}
		}
		most = fmax(most, room.covered);
		room_free(&room);
	}
	omp_set_max_active_levels(levels);
	*covered = most;
	return failed < n ? -1 : 0;
}

int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e)
{
	static const char *const names[] = {"train", "test", "all"};
	const int was_there = file_exists(o->folder);
	struct weighing of = {s, o, ""};
	double covered;
	size_t n = 0;

	for (size_t i = 0; i < s->cameras.n; i++)
		n += (size_t)in_split(&s->cameras.views[i], o->split);
	if (!n)
		return err_set(e, ERR_FORMAT, "%s: no view belongs to split '%s'", o->scene, names[o->split]);
	size_t *views = mem_alloc(n, sizeof *views, "views", e);
	if (!views || file_make_dir(o->folder, e)) {
		free(views);
		return -1;
	}
	n = 0;
	for (size_t i = 0; i < s->cameras.n; i++)
		if (in_split(&s->cameras.views[i], o->split))
			views[n++] = i;
	snprintf(of.text, sizeof of.text, "--scale %.15g --tolerance %.15g --precision %s%s", o->scale,
		o->tolerance, precision_name(o->precision), o->is_packed ? " --packed" : "");
	report_start(to, "views", (double)n);
	const int bad = weigh_views(&of, views, n, to, &covered, e);
	report_end(to);
	free(views);
	if (!bad && !check_covered(s, o, n, covered, e))
		return 0;
	if (!was_there)
		rmdir(o->folder); /* where it is empty */
	return -1;
}
