/* mask-pick: the masks of a thing that a person points at, for refer-lift. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/masks/pointing.h"

static struct pointing_options o;

static const struct cli_option options[] = {
	CLI_TEXT("regions", &o.tree, "FILE",
		"the scene's regions, of pseudomask-propose --regions (required)"),
	CLI_TEXT("point", &o.points, "PLACES", "what is meant is at VIEW:x,y; several have blanks between"),
	CLI_TEXT("outside", &o.outside, "PLACES", "what is meant is not at these, given likewise"),
	CLI_TEXT("box", &o.box, "VIEW:x0,y0,x1,y1", "instead of points: what is in this box"),
	{"larger", 0, CLI_INT, &o.larger, "N", "of each point, N regions up: what its region is in", 0, 1000},
	{"smaller", 0, CLI_INT, &o.smaller, "N", "of each point, N regions down", 0, 1000},
	CLI_TEXT("name", &o.name, "NAME", "what the thing is called (required)"),
	CLI_TEXT("weights", &o.weights, "WEIGHTS", "blend weights of views, which need not be rendered then"),
	{0},
};

static const struct cli_tool tool = {
	.name = "mask-pick",
	.operands = "SCENE",
	.summary = "Write the masks, in all views, of a thing that is pointed at in one.",
	.options = options,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(pointing_free) struct pointing p = {0};

	o.scene = c->operands[0];
	o.output = c->output;
	if (!o.tree || !o.name || !*o.name)
		cli_usage(c, "--regions FILE and --name NAME are required");
	if (!o.points == !o.box)
		cli_usage(c, "one of --point and --box says what is meant");
	if (o.box && (o.outside || o.larger || o.smaller))
		cli_usage(c, "--outside, --larger and --smaller go with --point");
	cli_refuse_overwrite(c, "SCENE " CLI_WEIGHTS " regions", "output", NULL);
	return pointing_write(&p, &o, to, e);
}

CLI_MAIN(tool, run)
