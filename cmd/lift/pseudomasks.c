#include "cmd/lift/pseudomasks.h"

#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "cmd/lift/left_out.h"
#include "formats/scene/weights.h"
#include "splat/weights_pack.h"

#include <math.h>

static int put_mask(FILE *out, struct mask m, double score, struct err *e)
{
	/* a mask without a sentence serves all of its object's */
	if (m.object)
		m.ref = NULL;
	if (!isnan(m.score)) /* a person's stays one */
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
	SCOPED_BY(weights_close) struct weights weights = {0};

	if (weights_open(&weights, w->options->weights, &w->scene, view, e))
		return -1;
	const struct view_weights blend = weights_view(&weights);
	return propagate_lift(&w->propagation, source, &blend, weights.height, weights.width, e);
}

static int lift_carried(struct pseudomasks *w, struct err *e)
{
	int bad = propagate_init(&w->propagation, &w->pool, w->views, &w->scene.cameras, e);

	for (size_t s = 0; s < w->propagation.source_count && !bad; s++)
		bad = lift_source(w, s, e);
	return bad;
}

/* What the workers share, and the masks of the views that wait for their turn to be written. */
struct by_views {
	struct pseudomasks *w;
	char *is_there;		    /* (views) whether there are weights */
	struct shown *shown;	    /* (views) */
	struct weights_room *rooms; /* (workers) */
};

/* All masks of a view: (count) of put_views. */
struct shown {
	struct rle *masks;
	double *scores;
	size_t rendered;
};

static int lift_view(void *context, int worker, size_t view, struct err *e)
{
	const struct by_views *b = context;
	const struct pseudomasks *w = b->w;
	SCOPED_BY(weights_close) struct weights weights = {0};

	if (!b->is_there[view])
		return 0;
	if (weights_open_in(
		    &weights, &b->rooms[worker], WEIGHTS_TILES, w->options->weights, &w->scene, view, e))
		return -1;
	const struct view_matrix blend = weights_matrix(&weights);
	return regions_lift(&b->w->regions, view, &blend, e);
}

/* Regions are the same in all views whatever the candidates are of. */
static int check_candidates(const struct pseudomasks *w, const struct report *to, struct err *e)
{
	SCOPED_BY(regions_surest_free) struct lift_objects surest = {0};

	return regions_surest(&w->regions, &surest, e) ||
	       left_out_check(
		       &surest, w->regions.object_count, w->options->candidates, w->options->scene, to, e);
}

static int lift_regions(struct by_views *b, const struct report *to, struct err *e)
{
	struct pseudomasks *w = b->w;
	const size_t views = w->scene.cameras.n;
	const struct each by = {b, each_workers(views), lift_view, NULL};
	struct regions *r = &w->regions;

	return regions_init(r, &w->pool, w->views, views, w->scene.splats.n, w->options->min_score, e) ||
	       each_run(&by, views, e) || regions_grow(r, e) || check_candidates(w, to, e) ||
	       regions_assign(r, e);
}

/* weights: NULL where regions do not need them. */
static int render(const struct pseudomasks *w, size_t view, const struct weights *weights, struct shown *to,
	struct err *e)
{
	const struct view_matrix blend = weights ? weights_matrix(weights) : (struct view_matrix){0};

	if (w->options->method == PSEUDOMASK_SCENE)
		return regions_render(
			&w->regions, view, weights ? &blend : NULL, to->masks, to->scores, &to->rendered, e);
	for (size_t i = 0; i < w->propagation.count; i++)
		to->scores[i] = w->propagation.starts[i].vote;
	return propagate_render(&w->propagation, view, &blend.rows, blend.height, blend.width, to->masks, e);
}

/* How many masks a view may have. */
static size_t shown_count(const struct pseudomasks *w)
{
	return w->options->method == PSEUDOMASK_SCENE ? w->regions.object_count : w->propagation.count;
}

static void shown_free(struct shown *s, size_t n)
{
	for (size_t i = 0; i < n && s->masks; i++)
		rle_free(&s->masks[i]);
	mem_free_all(s->masks, s->scores);
	*s = (struct shown){0};
}

static int open_weights(
	const struct by_views *b, struct weights *weights, int worker, size_t view, struct err *e)
{
	const struct pseudomasks *w = b->w;

	return weights_open_in(weights, &b->rooms[worker],
		w->options->method == PSEUDOMASK_SCENE ? WEIGHTS_TILES : WEIGHTS_ROWS, w->options->weights,
		&w->scene, view, e);
}

/* Weights are read only where something has to be rendered. */
static int show_view(void *context, int worker, size_t view, struct err *e)
{
	const struct by_views *b = context;
	const struct pseudomasks *w = b->w;
	const int needs = w->options->method != PSEUDOMASK_SCENE || regions_need_weights(&w->regions, view);
	struct shown *to = &b->shown[view];
	SCOPED_BY(weights_close) struct weights weights = {0};

	if (!b->is_there[view])
		return 0;
	to->masks = mem_zalloc(shown_count(w), sizeof *to->masks, "masks", e);
	to->scores = mem_alloc(shown_count(w), sizeof *to->scores, "masks", e);
	return -(!to->masks || !to->scores || (needs && open_weights(b, &weights, worker, view, e)) ||
		 render(w, view, needs ? &weights : NULL, to, e));
}

/* Writes what candidates show of the spare regions. */
static int put_spare(const struct pseudomasks *w, size_t view, struct err *e)
{
	struct mask m = {.view = w->scene.cameras.views[view].name, .visible = NAN};
	char name[32];
	double score;
	int bad = 0;

	m.object = name;
	for (size_t k = 0; k < w->regions.spare_count && !bad; k++) {
		const struct mask *from = regions_spare(&w->regions, k, view, &score);
		if (!from)
			continue;
		snprintf(name, sizeof name, "region-%zu", k + 1);
		m.rle = from->rle;
		bad = put_mask(w->spare, m, score, e);
	}
	return bad;
}

/* What a person drew of an object in a view, which no region replaces; NULL where there is not one mask. */
static const struct rle *drawn(const struct pseudomasks *w, const struct mask *first, const char *view)
{
	size_t begin, end;

	mask_index_object(&w->pool.index, view, mask_object(first), &begin, &end);
	const struct mask *m = end - begin == 1 ? &w->set.items[w->pool.index.keys[begin].at] : NULL;
	return m && isnan(m->score) ? &m->rle : NULL;
}

/* Writes all masks of a view but empty ones. */
static int put_view(void *context, size_t view, struct err *e)
{
	const struct by_views *b = context;
	struct pseudomasks *w = b->w;
	struct shown *s = &b->shown[view];
	int bad = 0;

	w->seen += s->masks != NULL;
	w->rendered += s->rendered;
	for (size_t i = 0; i < shown_count(w) && s->masks && !bad; i++) {
		const int is_region = w->options->method == PSEUDOMASK_SCENE;
		struct mask m =
			is_region ? w->set.items[w->regions.objects[i]] : *w->propagation.starts[i].mask;
		const struct rle *own = is_region ? drawn(w, &m, w->scene.cameras.views[view].name) : NULL;
		m.view = w->scene.cameras.views[view].name;
		m.visible = NAN; /* the candidate's is of its own view */
		m.score = own ? NAN : m.score;
		m.rle = own ? *own : s->masks[i];
		if (!rle_area(&m.rle))
			continue;
		w->masks++;
		bad = put_mask(w->out, m, s->scores[i], e);
	}
	shown_free(s, shown_count(w));
	return bad || (w->spare && put_spare(w, view, e)) ? -1 : 0;
}

static void warn_views(const struct pseudomasks *w, size_t found, const struct report *to)
{
	if (!found && w->set.n)
		report_warn(to, "%s: no candidate of a training view is above %g",
			file_name(w->options->candidates), w->options->min_score);
	if (w->left_out)
		report_warn(to, "%s: %zu training views have no weights, and get no masks",
			w->options->weights, w->left_out);
	if (w->spare)
		report_note(to, 1, "%zu spare regions", w->regions.spare_count);
	if (w->options->method == PSEUDOMASK_SCENE)
		report_note(to, 1, "%zu objects, %zu regions; %zu masks in %zu views, %zu of them rendered",
			w->regions.object_count, found, w->masks, w->seen, w->rendered);
	else
		report_note(to, 1, "%zu objects, which begin in %zu views; %zu masks in %zu views", found,
			w->propagation.source_count, w->masks, w->seen);
}

/* The masks of all views that have weights. */
static int put_all(struct by_views *b, const struct report *to, struct err *e)
{
	struct pseudomasks *w = b->w;
	const size_t views = w->scene.cameras.n;
	const struct each by = {b, each_workers(views), show_view, put_view};
	const int is_scene = w->options->method == PSEUDOMASK_SCENE;

	if (is_scene ? lift_regions(b, to, e) : lift_carried(w, e))
		return -1;
	const size_t found = is_scene ? w->regions.region_count : w->propagation.count;
	if (found && each_run(&by, views, e))
		return -1;
	warn_views(w, found, to);
	return 0;
}

static int find_views(struct pseudomasks *w, const struct report *to, struct err *e)
{
	w->views = mem_alloc(w->set.n, sizeof *w->views, "views", e);
	return !w->views || scene_read(&w->scene, w->options->scene, e) ||
	       masks_views(&w->set, w->lines, w->options->candidates, &w->scene.cameras, w->views, to, e);
}

static int put_views(struct pseudomasks *w, const struct report *to, struct err *e)
{
	struct by_views b = {.w = w};

	splats_keep_means(&w->scene.splats);
	const size_t views = w->scene.cameras.n;
	b.is_there = mem_alloc(views, 1, "views", e);
	b.shown = mem_zalloc(views, sizeof *b.shown, "views", e);
	b.rooms = mem_zalloc(EACH_WORKERS, sizeof *b.rooms, "views", e);
	const int bad = !b.is_there || !b.shown || !b.rooms ||
			weights_mark(w->options->weights, &w->scene.cameras, b.is_there, &w->left_out, e) ||
			put_all(&b, to, e);
	for (size_t v = 0; v < views && b.shown; v++)
		shown_free(&b.shown[v], shown_count(w));
	for (int i = 0; i < EACH_WORKERS && b.rooms; i++)
		weights_room_free(&b.rooms[i]);
	mem_free_all(b.rooms, b.is_there, b.shown);
	return bad ? -1 : 0;
}

int pseudomasks_write(struct pseudomasks *w, const struct pseudomask_options *options, const char *path,
	const struct report *to, struct err *e)
{
	const int method = options->method;
	size_t weak = 0;
	struct file_out out, spare;

	w->options = options;
	if (masks_read_lines(&w->set, &w->lines, options->candidates, e) ||
		(method >= PSEUDOMASK_FIRST && find_views(w, to, e)) ||
		masks_pool(&w->pool, &w->set, w->lines, options->candidates, e))
		return -1;
	if (method != PSEUDOMASK_SCENE &&
		pool_select(&w->pool, method == PSEUDOMASK_FIRST ? SELECT_TOP1 : (enum select_method)method,
			w->options->min_score, e))
		return -1;
	for (size_t i = 0; i < w->set.n; i++)
		weak += !(mask_confidence(&w->set.items[i]) > w->options->min_score);
	report_note(to, 1, "%zu candidates, %zu of them not above %g", w->set.n, weak, w->options->min_score);
	if (weak == w->set.n && (!weak || method < PSEUDOMASK_FIRST))
		report_warn(to, weak ? "%s: none of its candidates is above %g" : "%s: no candidates",
			file_name(w->options->candidates), w->options->min_score);
	if (file_out_open(&out, path, e))
		return -1;
	w->out = out.stream;
	if (options->spare && file_out_open(&spare, options->spare, e))
		return file_out_end(&out, -1, e);
	w->spare = options->spare ? spare.stream : NULL;
	int bad = method >= PSEUDOMASK_FIRST ? put_views(w, to, e) : put_winners(w, to, e);
	if (options->spare)
		bad = file_out_end(&spare, bad, e);
	return file_out_end(&out, bad, e);
}

void pseudomasks_free(struct pseudomasks *w)
{
	propagate_free(&w->propagation);
	regions_free(&w->regions);
	scene_free(&w->scene);
	pool_free(&w->pool);
	masks_free(&w->set);
	mem_free_all(w->views, w->lines);
}
