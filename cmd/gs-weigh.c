#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/scene.h"
#include "formats/weights.h"
#include "splat/prune.h"
#include "splat/render.h"

#include <stdlib.h>
#include <string.h>

enum { WEIGH_TRAIN, WEIGH_TEST, WEIGH_ALL };

struct options {
	int split, precision;
	double scale, tolerance;
	char text[128]; /* as the files record them */
};

static int in_split(const struct camera *c, int split)
{
	return split == WEIGH_ALL || c->split == (split == WEIGH_TEST ? SPLIT_TEST : SPLIT_TRAIN);
}

/* Memory that one view after the other uses: a view's weights take a hundred megabytes. */
struct room {
	struct render_view *view;
	struct render_weights rendered;
	float *dropped;
	size_t dropped_room;
};

static void room_free(struct room *room)
{
	render_free(room->view);
	render_weights_free(&room->rendered);
	free(room->dropped);
}

static int render(struct room *room, const struct splats *s, const struct camera *c, const struct options *o,
	struct err *e)
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

static int weigh_view(const struct cli *cli, const struct scene *s, const struct camera *full,
	const struct options *o, struct room *room, struct err *e)
{
	double start = cli_seconds();
	int width, height;

	camera_scaled_size(full, o->scale, &width, &height);
	struct camera camera = camera_resize(full, width, height);
	if (render(room, &s->splats, &camera, o, e))
		return -1;
	double ms = 1e3 * (cli_seconds() - start);
	struct weights w = {.width = width,
		.height = height,
		.gaussians = (int64_t)s->splats.n,
		.indptr = room->rendered.indptr,
		.index = room->rendered.index,
		.weight = room->rendered.weight,
		.dropped = room->dropped,
		.scene = s->fingerprint,
		.camera = fingerprint_camera(&camera),
		.precision = (enum precision)o->precision};
	if (weights_write(&w, cli->output, full->name, o->text, e))
		return -1;
	size_t pixels = (size_t)width * (size_t)height;
	double nnz = (double)w.indptr[pixels];
	cli_note(cli, 1, "%s: %dx%d, %.0f weights, %.1f a pixel, %.1f ms", full->name, width, height, nnz,
		nnz / (double)pixels, ms);
	return 0;
}

static int weigh_scene(const struct cli *cli, const struct scene *s, const struct options *o, struct err *e)
{
	static const char *const names[] = {"train", "test", "all"};
	size_t views = 0, done = 0;
	struct cli_progress progress;
	struct room room = {0};
	int bad = 0;

	for (size_t i = 0; i < s->cameras.n; i++)
		views += (size_t)in_split(&s->cameras.views[i], o->split);
	if (!views)
		return err_set(e, ERR_FORMAT, "%s: no view belongs to split '%s'", cli->operands[0],
			names[o->split]);
	if (file_make_dir(cli->output, e))
		return -1;
	cli_progress_start(&progress, cli, "views", (double)views);
	for (size_t i = 0; !bad && i < s->cameras.n; i++) {
		const struct camera *view = &s->cameras.views[i];
		if (!in_split(view, o->split))
			continue;
		bad = weigh_view(cli, s, view, o, &room, e);
		cli_progress_step(&progress, (double)++done, view->name);
	}
	cli_progress_end(&progress);
	room_free(&room);
	return bad;
}

int main(int argc, char **argv)
{
	struct options o = {.scale = 1};
	const struct cli_option table[] = {
		{"split", 0, CLI_CHOICE, &o.split, "train|test|all", "the views to weigh (default train)", 0,
			0},
		{"scale", 0, CLI_REAL, &o.scale, "S",
			"render at round(W S) x round(H S), 0.001 to 1 (default 1)", 0.001, 1},
		{"tolerance", 0, CLI_REAL, &o.tolerance, "T",
			"leave out the smallest weights of a pixel, up to this share of its weight (default 0)",
			0, 0.999},
		{"precision", 0, CLI_CHOICE, &o.precision, PRECISION_CHOICES,
			"how weights are stored (default f32)", 0, 0},
		{0},
	};
	const struct cli_tool tool = {.name = "gs-weigh",
		.operands = "SCENE",
		.summary =
			"Write the blend weights of a scene's views: which Gaussians make each pixel, and by how much.",
		.options = table,
		.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.min_operands = 1,
		.max_operands = 1,
		.output_arg = "WEIGHTS",
		.needs_output = 1};
	struct scene scene;
	struct err e = {0};
	struct cli cli;

	cli_parse(&cli, &tool, argc, argv);
	if (!strcmp(cli.output, "-"))
		cli_usage(&cli, "--output: weights go to a folder, not to stdout");
	cli_refuse_overwrite(&cli, "SCENE:" CLI_SCENE_PARTS, "output:" CLI_WEIGHTS_PARTS, NULL);
	snprintf(o.text, sizeof o.text, "--scale %.15g --tolerance %.15g --precision %s", o.scale,
		o.tolerance, precision_name((enum precision)o.precision));
	if (scene_read(&scene, cli.operands[0], &e))
		return cli_fail(&cli, &e);
	int bad = weigh_scene(&cli, &scene, &o, &e);
	scene_free(&scene);
	return bad ? cli_fail(&cli, &e) : cli_done(&cli);
}
