/* gs-weigh: the blend weights of a scene's views. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/lift/weighing.h"
#include "formats/scene/scene.h"

static struct weighing_options o = {.scale = 1};
static int precision;

static const struct cli_option table[] = {
	CLI_ONE_OF("split", &o.split, "train|test|all", "the views to weigh (default train)"),
	{"scale", 0, CLI_REAL, &o.scale, "S", "render at round(W S) x round(H S), 0.001 to 1 (default 1)",
		0.001, 1},
	{"tolerance", 0, CLI_REAL, &o.tolerance, "T",
		"leave out the smallest weights of a pixel, up to this share of its weight (default 0)", 0,
		0.999},
	CLI_ONE_OF("precision", &precision, PRECISION_CHOICES, "how weights are stored (default f32)"),
	CLI_SWITCH("packed", &o.is_packed, "store weights as u8, and packed: a fifth of its bytes"),
	{0},
};

static const struct cli_tool tool = {.name = "gs-weigh",
	.operands = "SCENE",
	.summary =
		"Write the blend weights of a scene's views: which Gaussians make each pixel, and by how much.",
	.options = table,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
	.output_arg = "WEIGHTS",
	.needs_output = 1};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(scene_free) struct scene scene = {0};

	if (!strcmp(c->output, "-"))
		cli_usage(c, "--output: weights go to a folder, not to stdout");
	cli_refuse_overwrite(c, "SCENE:" CLI_SCENE_PARTS, "output:" CLI_WEIGHTS_PARTS, NULL);
	o.precision = o.is_packed ? PRECISION_U8 : (enum precision)precision;
	o.scene = c->operands[0];
	o.folder = c->output;
	return scene_read(&scene, o.scene, e) || weigh(&scene, &o, to, e) ? -1 : 0;
}

CLI_MAIN(tool, run)
