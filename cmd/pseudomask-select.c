/* pseudomask-select: of the candidate masks of an object in a view, the one that its sentences agree on; or
 * one mask of each object, carried to all views through the scene. */
#include "base/err.h"
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "formats/scene.h"
#include "formats/weights.h"
#include "mask/pool.h"
#include "refer/carry.h"

#include <math.h>
#include <stdlib.h>

enum { METHOD_FIRST = SELECT_TOP1 + 1 };

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
	struct carry carry; /* of --method first */
};

static void work_free(struct work *w)
{
	carry_free(&w->carry);
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

/* The scene, and where in it each object begins. */
static int read_scene(struct work *w, struct err *e)
{
	size_t *views = mem_alloc(w->set.n, sizeof *views, "views", e);
	int bad = !views || scene_read(&w->scene, w->options.scene, e) ||
		  masks_views(&w->set, w->lines, w->path, &w->scene.cameras, views, e) ||
		  carry_init(&w->carry, &w->pool, views, &w->scene.cameras, e);

	free(views);
	return bad ? -1 : 0;
}

static int open_view(const struct work *w, size_t view, struct weights *weights, struct err *e)
{
	return weights_open(
		weights, w->options.weights, w->scene.cameras.views[view].name, w->scene.splats.n, e);
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

/* Writes all masks of a view but empty ones; *count goes up by them. */
static int put_view(const struct work *w, size_t view, FILE *out, size_t *count, struct err *e)
{
	struct weights weights;
	struct rle *masks = mem_alloc(w->carry.count, sizeof *masks, "masks", e);

	if (!masks || open_view(w, view, &weights, e)) {
		free(masks);
		return -1;
	}
	const struct view_weights blend = weights_view(&weights);
	int bad = carry_render(&w->carry, view, &blend, weights.height, weights.width, masks, e);
	weights_close(&weights);
	for (size_t i = 0; i < w->carry.count && !bad; i++) {
		if (!rle_area(&masks[i]))
			continue;
		struct mask_record r = w->set.records[w->carry.masks[i].record];
		r.view = w->scene.cameras.views[view].name;
		r.mask = masks[i];
		bad = put_mask(out, r, isnan(r.score) ? 1 : r.score, e);
		++*count;
	}
	for (size_t i = 0; i < w->carry.count; i++)
		rle_free(&masks[i]);
	free(masks);
	return bad;
}

/* The weights of one view at a time. */
static int put_carried(struct work *w, const struct cli *c, FILE *out, struct err *e)
{
	size_t views = 0, left_out = 0, count = 0;

	if (read_scene(w, e))
		return -1;
	if (!w->carry.count && w->set.n)
		cli_warn(c, "%s: no candidate of a training view is above %g", file_name(w->path),
			w->options.min_score);
	for (size_t s = 0; s < w->carry.source_count; s++)
		if (lift_source(w, s, e))
			return -1;
	for (size_t v = 0; v < w->scene.cameras.n && w->carry.count; v++) {
		const struct camera *camera = &w->scene.cameras.views[v];
		if (camera->split != SPLIT_TRAIN)
			continue;
		int found = weights_exist(w->options.weights, camera->name, e);
		if (found < 0 || (found && put_view(w, v, out, &count, e)))
			return -1;
		views += (size_t)found;
		left_out += !found;
	}
	if (left_out)
		cli_warn(c, "%s: %zu training views have no weights, and get no masks", w->options.weights,
			left_out);
	cli_note(c, 1, "%zu objects, which begin in %zu views; %zu masks in %zu views", w->carry.count,
		w->carry.source_count, count, views);
	return 0;
}

static int run(struct work *w, const struct cli *c, struct err *e)
{
	const int is_first = w->options.method == METHOD_FIRST;
	size_t kept = 0;
	struct file_out out;

	if (masks_read_lines(&w->set, &w->lines, w->path, e) ||
		masks_pool(&w->pool, &w->set, w->lines, w->path, e))
		return -1;
	if (!w->set.n)
		cli_warn(c, "%s: no candidates", file_name(w->path));
	if (pool_select(&w->pool, is_first ? SELECT_TOP1 : (enum select_method)w->options.method,
		    w->options.min_score, e))
		return -1;
	for (size_t i = 0; i < w->set.n; i++)
		kept += w->pool.candidates[i].score > w->options.min_score;
	cli_note(c, 1, "%zu candidates, %zu of them not above %g", w->set.n, w->set.n - kept,
		w->options.min_score);
	if (file_out_open(&out, c->output, e))
		return -1;
	if (is_first ? put_carried(w, c, out.stream, e) : put_winners(w, c, out.stream, e)) {
		file_out_abort(&out);
		return -1;
	}
	return file_out_commit(&out, e);
}

int main(int argc, char **argv)
{
	struct work w = {.options = {SELECT_CIOU, 0.3, NULL, NULL}};
	struct options *o = &w.options;
	const struct cli_option options[] = {
		{"method", 0, CLI_CHOICE, &o->method, "ciou|iou|top1|first",
			"confidence-weighted IoU votes (default), IoU votes, the most confident; or the first view's, carried to all others",
			0, 0},
		{"min-score", 0, CLI_REAL, &o->min_score, "G",
			"leave out candidates with no more confidence (default 0.3)", 0, 1},
		{"scene", 0, CLI_STRING, &o->scene, "SCENE", "for first: the scene's folder", 0, 0},
		{"weights", 0, CLI_STRING, &o->weights, "WEIGHTS",
			"for first: the folder of its training views' blend weights", 0, 0},
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
	if (o->method == METHOD_FIRST && (!o->scene || !o->weights))
		cli_usage(&c, "--method first needs --scene SCENE and --weights WEIGHTS");
	if (o->method != METHOD_FIRST && (o->scene || o->weights))
		cli_usage(&c, "%s is for --method first", o->scene ? "--scene" : "--weights");
	int bad = run(&w, &c, &e);
	work_free(&w);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
