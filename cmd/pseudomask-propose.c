/* pseudomask-propose: regions of a scene that may be things, from its photographs and a detector's boxes,
 * without masks of anything. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/lift/proposing.h"

static struct proposing_options o;

static const struct cli_option options[] = {
	CLI_TEXT("weights", &o.weights, "WEIGHTS",
		"the folder of its training views' blend weights (required)"),
	CLI_TEXT("boxes", &o.boxes, "FILE",
		"boxes that a detector found in the photographs, of whatever class (default: photographs alone)"),
	CLI_SWITCH("disjoint", &o.is_disjoint, "regions none of which is in another"),
	{"most", 0, CLI_INT, &o.most, "N", "at most so many regions (default 110, and 40 with --disjoint)", 1,
		10000},
	CLI_TEXT("regions", &o.regions, "FILE", "also write the tree of all regions, for mask-pick"),
	CLI_ONE_OF("split", &o.split, "train|test|all", "the views to write masks of"),
	{0},
};

static const struct cli_tool tool = {
	.name = "pseudomask-propose",
	.operands = "SCENE",
	.summary = "Propose regions of a scene that may be things, and their masks in each view.",
	.options = options,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(proposing_free) struct proposing p = {0};

	o.scene = c->operands[0];
	o.output = c->output;
	if (!o.weights)
		cli_usage(c, "--weights WEIGHTS is required");
	cli_refuse_overwrite(c, "SCENE " CLI_WEIGHTS " boxes", "output regions", NULL);
	return proposing_write(&p, &o, to, e);
}

CLI_MAIN(tool, run)
