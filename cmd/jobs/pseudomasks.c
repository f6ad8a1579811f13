#include "cmd/jobs/pseudomasks.h"

#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/weights.h"
#include "mask/select.h"

#include <math.h>
#include <stdlib.h>

/* Views at a time: each takes memory for its weights, and for images of its masks. */
enum { WORKERS_MOST = 8 };

static int put_mask(FILE *out, struct mask m, double score, struct err *e)
{
	/* a mask without a sentence serves all of its object's */
	if (m.object)
		m.ref = NULL;
	m.score = score;
	return masks_put(out, &m, e);
}

static int put_winners(const struct pseudomasks *w, const struct report *to, struct err *e)
{
	size_t without = 0;

	for (size_t i = 0; i < w->pool.group_count; i++) {
		const struct pool_group *g = &w->pool.groups[i];
		if (g->winner < 0)
			without++;
		else if (put_mask(w->out, w->set.items[g->winner], g->vote, e))
			return -1;
	}
	report_note(to, 1, "%zu masks; %zu views of an object without one", w->pool.group_count - without,
		without);
	return 0;
}

static int lift_source(struct pseudomasks *w, size_t source, struct err *e)
{
	const size_t view = w->propagation.sources[source].view;
	struct weights weights;

	if (weights_open(&weights, w->options->weights, &w->scene, view, e))
		return -1;
	const struct view_weights blend = weights_view(&weights);
	int bad = propagate_lift(&w->propagation, source, &blend, weights.height, weights.width, e);
	weights_close(&weights);
	return bad;
}

static int lift_carried(struct pseudomasks *w, struct err *e)
{
	int bad = propagate_init(&w->propagation, &w->pool, w->views, &w->scene.cameras, e);

	for (size_t s = 0; s < w->propagation.source_count && !bad; s++)
		bad = lift_source(w, s, e);
	return bad;
}

struct lifting_views {
	struct pseudomasks *w;
	const char *is_there; /* (views) whether there are weights */
};

static int lift_view(void *context, int worker, size_t view, struct err *e)
{
	const struct lifting_views *l = context;
	const struct pseudomasks *w = l->w;
	struct weights weights;
	(void)worker;

	if (!l->is_there[view])
		return 0;
	if (weights_open(&weights, w->options->weights, &w->scene, view, e))
		return -1;
	const struct view_weights blend = weights_view(&weights);
	const int bad = regions_lift(&l->w->regions, view, &blend, weights.height, weights.width, e);
	weights_close(&weights);
	return bad;
}

static int lift_regions(struct pseudomasks *w, struct err *e)
{
	const struct cameras *cameras = &w->scene.cameras;
	char *is_there = mem_alloc(cameras->n, 1, "views", e);
	struct lifting_views l = {w, is_there};
	const struct each by = {&l, each_workers(cameras->n, WORKERS_MOST), lift_view, NULL};
	struct regions *r = &w->regions;
	const int bad = !is_there || weights_mark(w->options->weights, cameras, is_there, &w->left_out, e) ||
			regions_init(r, &w->pool, w->views, cameras->n, w->scene.splats.n,
				w->options->min_score, e) ||
			each_run(&by, cameras->n, e) || regions_grow(r, e) || regions_assign(r, e);

	free(is_there);
	return bad ? -1 : 0;
}

static int render(struct pseudomasks *w, size_t view, const struct weights *weights, struct rle *masks,
	double *scores, struct err *e)
{
	struct regions *r = &w->regions;

	if (!weights)
		return regions_render(r, view, NULL, 0, 0, masks, scores, &w->rendered, e);
	const struct view_weights blend = weights_view(weights);
	if (w->options->method == PSEUDOMASK_SCENE)
		return regions_render(
			r, view, &blend, weights->height, weights->width, masks, scores, &w->rendered, e);
	for (size_t i = 0; i < w->propagation.count; i++)
		scores[i] = w->propagation.starts[i].vote;
	return propagate_render(&w->propagation, view, &blend, weights->height, weights->width, masks, e);
}

/* Writes all masks of a view but empty ones; weights may be NULL where regions do not need them. */
static int put_view(void *data, size_t view, const struct weights *weights, struct err *e)
{
	struct pseudomasks *w = data;
	const int is_scene = w->options->method == PSEUDOMASK_SCENE;
	const size_t n = is_scene ? w->regions.object_count : w->propagation.count;
	struct rle *masks = mem_zalloc(n, sizeof *masks, "masks", e);
	double *scores = mem_alloc(n, sizeof *scores, "masks", e);
	int bad = !masks || !scores || render(w, view, weights, masks, scores, e);

	w->seen++;
	for (size_t i = 0; i < n && masks; i++) {
		struct mask m =
			is_scene ? w->set.items[w->regions.objects[i]] : *w->propagation.starts[i].mask;
		if (!bad && rle_area(&masks[i])) {
			m.view = w->scene.cameras.views[view].name;
			m.visible = NAN; /* the candidate's is of its own view */
			m.rle = masks[i];
			w->masks++;
			bad = put_mask(w->out, m, scores[i], e);
		}
		rle_free(&masks[i]);
	}
	free(masks);
	free(scores);
	return bad ? -1 : 0;
}

/* Weights are read only where a region has to be rendered. */
static int needs_weights(const void *data, size_t view)
{
	const struct pseudomasks *w = data;

	return w->options->method != PSEUDOMASK_SCENE || regions_need_weights(&w->regions, view);
}

/* The masks of all views that have weights, those of one view in memory at a time. */
static int put_views(struct pseudomasks *w, const struct report *to, struct err *e)
{
	const int is_scene = w->options->method == PSEUDOMASK_SCENE;
	const char *dir = w->options->weights;

	w->views = mem_alloc(w->set.n, sizeof *w->views, "views", e);
	if (!w->views || scene_read(&w->scene, w->options->scene, e) ||
		masks_views(&w->set, w->lines, w->options->candidates, &w->scene.cameras, w->views, e) ||
		(is_scene ? lift_regions(w, e) : lift_carried(w, e)))
		return -1;
	const size_t found = is_scene ? w->regions.region_count : w->propagation.count;
	if (!found && w->set.n)
		report_warn(to, "%s: no candidate of a training view is above %g",
			file_name(w->options->candidates), w->options->min_score);
	if (found && weights_each(dir, &w->scene, needs_weights, put_view, w, &w->left_out, e))
		return -1;
	if (w->left_out)
		report_warn(to, "%s: %zu training views have no weights, and get no masks", dir, w->left_out);
	if (is_scene)
		report_note(to, 1, "%zu objects, %zu regions; %zu masks in %zu views, %zu of them rendered",
			w->regions.object_count, found, w->masks, w->seen, w->rendered);
	else
		report_note(to, 1, "%zu objects, which begin in %zu views; %zu masks in %zu views", found,
			w->propagation.source_count, w->masks, w->seen);
	return 0;
}

int pseudomasks_write(struct pseudomasks *w, const struct pseudomask_options *options, const char *path,
	const struct report *to, struct err *e)
{
	const int method = options->method;
	size_t weak = 0;
	struct file_out out;

	w->options = options;
	if (masks_read_lines(&w->set, &w->lines, w->options->candidates, e) ||
		masks_pool(&w->pool, &w->set, w->lines, w->options->candidates, e))
		return -1;
	if (!w->set.n)
		report_warn(to, "%s: no candidates", file_name(w->options->candidates));
	if (method != PSEUDOMASK_SCENE &&
		pool_select(&w->pool, method == PSEUDOMASK_FIRST ? SELECT_TOP1 : (enum select_method)method,
			w->options->min_score, e))
		return -1;
	for (size_t i = 0; i < w->set.n; i++)
		weak += !(mask_confidence(&w->set.items[i]) > w->options->min_score);
	report_note(to, 1, "%zu candidates, %zu of them not above %g", w->set.n, weak, w->options->min_score);
	if (file_out_open(&out, path, e))
		return -1;
	w->out = out.stream;
	return file_out_end(
		&out, method >= PSEUDOMASK_FIRST ? put_views(w, to, e) : put_winners(w, to, e), e);
}

void pseudomasks_free(struct pseudomasks *w)
{
	propagate_free(&w->propagation);
	regions_free(&w->regions);
	free(w->views);
	scene_free(&w->scene);
	pool_free(&w->pool);
	masks_free(&w->set);
	free(w->lines);
}
