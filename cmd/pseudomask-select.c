/* pseudomask-select: of the candidate masks of an object in a view, the one that its sentences agree on; or
 * those of the object's region in the scene; or one mask of each object, carried to all views. */
#include "base/err.h"
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "formats/scene.h"
#include "formats/weights.h"
#include "mask/pool.h"
#include "refer/carry.h"
#include "refer/regions.h"

#include <math.h>
#include <stdlib.h>

enum { METHOD_FIRST = SELECT_TOP1 + 1, METHOD_SCENE, METHOD_DEFAULT };

struct options {
	int method;
	double min_score;
	const char *scene, *weights;
};

struct work {
	struct options options;
	const char *path;
	struct mask_set set;
	long *lines; /* (set.n) of the file */
	struct pool pool;
	struct scene scene;
	size_t *views;		/* (set.n) of the scene */
	struct carry carry;	/* of --method first */
	struct regions regions; /* of --method scene */
};

static void work_free(struct work *w)
{
	carry_free(&w->carry);
	regions_free(&w->regions);
	free(w->views);
	scene_free(&w->scene);
	pool_free(&w->pool);
	masks_free(&w->set);
	free(w->lines);
}

static int put_mask(FILE *out, struct mask_record r, double score, struct err *e)
{
	/* a mask without a sentence serves all of its object's */
	if (r.object)
		r.ref = NULL;
	r.score = score;
	return masks_put(out, &r, e);
}

static int put_winners(const struct work *w, const struct cli *c, FILE *out, struct err *e)
{
	size_t without = 0;

	for (size_t i = 0; i < w->pool.group_count; i++) {
		const struct pool_group *g = &w->pool.groups[i];
		if (g->winner < 0)
			without++;
		else if (put_mask(out, w->set.records[g->winner], g->vote, e))
			return -1;
	}
	cli_note(c, 1, "%zu masks; %zu views of an object without one", w->pool.group_count - without,
		without);
	return 0;
}

/* The scene, and the view of each record. */
static int read_scene(struct work *w, struct err *e)
{
	w->views = mem_alloc(w->set.n, sizeof *w->views, "views", e);
	return !w->views || scene_read(&w->scene, w->options.scene, e) ||
			       masks_views(&w->set, w->lines, w->path, &w->scene.cameras, w->views, e)
		       ? -1
		       : 0;
}

static int open_view(const struct work *w, size_t view, struct weights *weights, struct err *e)
{
	return weights_open(
		weights, w->options.weights, w->scene.cameras.views[view].name, w->scene.splats.n, e);
}

struct tally {
	FILE *out;
	size_t views, left_out, masks, rendered;
};

/* Visits the training views that have weights, which are in memory for one view at a time. */
static int each_view(struct work *w,
	int (*visit)(struct work *w, size_t view, const struct weights *weights,
		const struct view_weights *blend, struct tally *t, struct err *e),
	struct tally *t, struct err *e)
{
	t->views = t->left_out = 0;
	for (size_t v = 0; v < w->scene.cameras.n; v++) {
		const struct camera *camera = &w->scene.cameras.views[v];
		struct weights weights;
		if (camera->split != SPLIT_TRAIN)
			continue;
		int found = weights_exist(w->options.weights, camera->name, e);
		if (found < 0 || (found && open_view(w, v, &weights, e)))
			return -1;
		t->views += (size_t)found;
		t->left_out += !found;
		if (!found)
			continue;
		const struct view_weights blend = weights_view(&weights);
		int bad = visit(w, v, &weights, &blend, t, e);
		weights_close(&weights);
		if (bad)
			return -1;
	}
	return 0;
}

/* The mask of a record's object in a view, unless it is empty. */
static int put_seen(const struct work *w, size_t record, size_t view, const struct rle *mask, double score,
	struct tally *t, struct err *e)
{
	struct mask_record r = w->set.records[record];

	if (!rle_area(mask))
		return 0;
	r.view = w->scene.cameras.views[view].name;
	r.mask = *mask;
	t->masks++;
	return put_mask(t->out, r, score, e);
}

static int put_carried_view(struct work *w, size_t view, const struct weights *weights,
	const struct view_weights *blend, struct tally *t, struct err *e)
{
	struct rle *masks = mem_alloc(w->carry.count, sizeof *masks, "masks", e);
	int bad = !masks || carry_render(&w->carry, view, blend, weights->height, weights->width, masks, e);

	for (size_t i = 0; i < w->carry.count && masks; i++) {
		const size_t record = w->carry.masks[i].record;
		const double score = w->set.records[record].score;
		bad = bad || put_seen(w, record, view, &masks[i], isnan(score) ? 1 : score, t, e);
		rle_free(&masks[i]);
	}
	free(masks);
	return bad ? -1 : 0;
}

static int lift_source(struct work *w, size_t source, struct err *e)
{
	struct weights weights;

	if (open_view(w, w->carry.sources[source].view, &weights, e))
		return -1;
	const struct view_weights blend = weights_view(&weights);
	int bad = carry_lift(&w->carry, source, &blend, weights.height, weights.width, e);
	weights_close(&weights);
	return bad;
}

/* Nothing is an answer too, but hardly the expected one. */
static int warn_of_none(const struct work *w, const struct cli *c)
{
	if (w->set.n)
		cli_warn(c, "%s: no candidate of a training view is above %g", file_name(w->path),
			w->options.min_score);
	return 0;
}

static int put_carried(struct work *w, const struct cli *c, struct tally *t, struct err *e)
{
	if (carry_init(&w->carry, &w->pool, w->views, &w->scene.cameras, e))
		return -1;
	if (!w->carry.count)
		return warn_of_none(w, c);
	for (size_t s = 0; s < w->carry.source_count; s++)
		if (lift_source(w, s, e))
			return -1;
	if (each_view(w, put_carried_view, t, e))
		return -1;
	cli_note(c, 1, "%zu objects, which begin in %zu views; %zu masks in %zu views", w->carry.count,
		w->carry.source_count, t->masks, t->views);
	return 0;
}

static int lift_view(struct work *w, size_t view, const struct weights *weights,
	const struct view_weights *blend, struct tally *t, struct err *e)
{
	(void)t;
	return regions_lift(&w->regions, view, blend, weights->height, weights->width, e);
}

static int put_regions_view(struct work *w, size_t view, const struct weights *weights,
	const struct view_weights *blend, struct tally *t, struct err *e)
{
	struct regions *r = &w->regions;
	struct regions_mask *masks = mem_alloc(r->object_count, sizeof *masks, "masks", e);
	int bad = !masks || regions_render(r, view, blend, weights->height, weights->width, masks, e);

	for (size_t i = 0; i < r->object_count && masks; i++) {
		const size_t before = t->masks;
		bad = bad || put_seen(w, r->objects[i], view, &masks[i].mask, masks[i].score, t, e);
		t->rendered += masks[i].is_rendered && t->masks > before;
		rle_free(&masks[i].mask);
	}
	free(masks);
	return bad ? -1 : 0;
}

static int put_regions(struct work *w, const struct cli *c, struct tally *t, struct err *e)
{
	struct regions *r = &w->regions;

	if (regions_init(
		    r, &w->pool, w->views, w->scene.cameras.n, w->scene.splats.n, w->options.min_score, e) ||
		each_view(w, lift_view, t, e))
		return -1;
	if (!r->entries)
		return warn_of_none(w, c);
	if (regions_grow(r, e) || regions_assign(r, e) || each_view(w, put_regions_view, t, e))
		return -1;
	cli_note(c, 1, "%zu objects, %zu regions; %zu masks in %zu views, %zu of them rendered",
		r->object_count, r->region_count, t->masks, t->views, t->rendered);
	return 0;
}

/* What needs the scene. */
static int put_views(struct work *w, const struct cli *c, FILE *out, struct err *e)
{
	struct tally t = {.out = out};

	if (read_scene(w, e) ||
		(w->options.method == METHOD_FIRST ? put_carried(w, c, &t, e) : put_regions(w, c, &t, e)))
		return -1;
	if (t.left_out)
		cli_warn(c, "%s: %zu training views have no weights, and get no masks", w->options.weights,
			t.left_out);
	return 0;
}

static int run(struct work *w, const struct cli *c, struct err *e)
{
	const int method = w->options.method;
	size_t kept = 0;
	struct file_out out;

	if (masks_read_lines(&w->set, &w->lines, w->path, e) ||
		masks_pool(&w->pool, &w->set, w->lines, w->path, e))
		return -1;
	if (!w->set.n)
		cli_warn(c, "%s: no candidates", file_name(w->path));
	if (method != METHOD_SCENE &&
		pool_select(&w->pool, method == METHOD_FIRST ? SELECT_TOP1 : (enum select_method)method,
			w->options.min_score, e))
		return -1;
	for (size_t i = 0; i < w->set.n; i++)
		kept += w->pool.candidates[i].score > w->options.min_score;
	cli_note(c, 1, "%zu candidates, %zu of them not above %g", w->set.n, w->set.n - kept,
		w->options.min_score);
	if (file_out_open(&out, c->output, e))
		return -1;
	if (method >= METHOD_FIRST ? put_views(w, c, out.stream, e) : put_winners(w, c, out.stream, e)) {
		file_out_abort(&out);
		return -1;
	}
	return file_out_commit(&out, e);
}

int main(int argc, char **argv)
{
	struct work w = {.options = {METHOD_DEFAULT, 0.3, NULL, NULL}};
	struct options *o = &w.options;
	const struct cli_option options[] = {
		{"method", 0, CLI_CHOICE, &o->method, "ciou|iou|top1|first|scene",
			"confidence-weighted IoU votes, IoU votes, the most confident; the first view's, carried to all others; or the object's region in the scene (default: scene where --scene and --weights are given, else ciou)",
			0, 0},
		{"min-score", 0, CLI_REAL, &o->min_score, "G",
			"leave out candidates with no more confidence (default 0.3)", 0, 1},
		{"scene", 0, CLI_STRING, &o->scene, "SCENE", "for scene and first: the scene's folder", 0, 0},
		{"weights", 0, CLI_STRING, &o->weights, "WEIGHTS",
			"for scene and first: the folder of its training views' blend weights", 0, 0},
		{0},
	};
	const struct cli_tool tool = {
		.name = "pseudomask-select",
		.operands = "[CANDIDATES]",
		.summary =
			"Pick, of an object's candidate masks in each view, the one its sentences agree on.",
		.options = options,
		.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.max_operands = 1,
	};
	struct cli c;
	struct err e;

	cli_parse(&c, &tool, argc, argv);
	w.path = c.operand_count ? c.operands[0] : "-";
	if (o->method == METHOD_DEFAULT)
		o->method = o->scene || o->weights ? METHOD_SCENE : SELECT_CIOU;
	if (o->method >= METHOD_FIRST && (!o->scene || !o->weights))
		cli_usage(&c, "--method %s needs --scene SCENE and --weights WEIGHTS",
			o->method == METHOD_FIRST ? "first" : "scene");
	if (o->method < METHOD_FIRST && (o->scene || o->weights))
		cli_usage(&c, "%s is for --method scene and first", o->scene ? "--scene" : "--weights");
	int bad = run(&w, &c, &e);
	work_free(&w);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
