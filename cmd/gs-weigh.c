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

static int weigh_view(const struct cli *cli, const struct scene *s, const struct camera *full,
	const struct options *o, struct err *e)
{
	double start = cli_seconds();
	struct render_weights rendered = {0};
	int width, height;

	camera_scaled_size(full, o->scale, &width, &height);
	struct camera camera = camera_resize(full, width, height);
	size_t pixels = (size_t)width * (size_t)height;
	float *dropped = mem_zalloc(pixels, sizeof *dropped, "weights", e);
	struct render_view *view = dropped ? render_prepare(&s->splats, &camera, e) : NULL;
	int bad = !view || render_weights(view, &rendered, e);
	render_free(view);
	if (!bad && o->tolerance > 0)
		bad = prune_weights(&rendered, pixels, o->tolerance, dropped, e);
	if (!bad && o->precision == PRECISION_U8)
		prune_below(&rendered, pixels, WEIGHTS_U8_LEAST, dropped);
	if (!bad) {
		double ms = 1e3 * (cli_seconds() - start);
		struct weights w = {.width = width,
			.height = height,
			.gaussians = (int64_t)s->splats.n,
			.indptr = rendered.indptr,
			.index = rendered.index,
			.weight = rendered.weight,
			.dropped = dropped,
			.precision = (enum precision)o->precision};
		bad = weights_write(&w, cli->output, full->name, o->text, e);
		double nnz = (double)rendered.indptr[pixels];
		cli_note(cli, 1, "%s: %dx%d, %.0f weights, %.1f a pixel, %.1f ms", full->name, width, height,
			nnz, nnz / (double)pixels, ms);
	}
	render_weights_free(&rendered);
	free(dropped);
	return bad ? -1 : 0;
}

static int weigh_scene(const struct cli *cli, const struct scene *s, const struct options *o, struct err *e)
{
	static const char *const names[] = {"train", "test", "all"};
	size_t views = 0, done = 0;
	struct cli_progress progress;
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
		bad = weigh_view(cli, s, view, o, e);
		cli_progress_step(&progress, (double)++done, view->name);
	}
	cli_progress_end(&progress);
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
	snprintf(o.text, sizeof o.text, "--scale %.15g --tolerance %.15g --precision %s", o.scale,
		o.tolerance, precision_name((enum precision)o.precision));
	if (scene_read(&scene, cli.operands[0], &e))
		return cli_fail(&cli, &e);
	int bad = weigh_scene(&cli, &scene, &o, &e);
	scene_free(&scene);
	return bad ? cli_fail(&cli, &e) : cli_done(&cli);
}
