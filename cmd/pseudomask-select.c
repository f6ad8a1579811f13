/* pseudomask-select: an object's masks in the views, of a detector's candidates for its sentences. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/lift/pseudomasks.h"

/* Where --method is not given. */
enum { METHOD_DEFAULT = PSEUDOMASK_SCENE + 1 };

static struct pseudomask_options o = {.method = METHOD_DEFAULT, .min_score = 0.3};

static const struct cli_option options[] = {
	CLI_ONE_OF("method", &o.method, "ciou|iou|top1|first|scene",
		"confidence-weighted IoU votes, IoU votes, the most confident; the first view's, carried to all others; or the object's region in the scene (default: scene where --scene and --weights are given, else ciou)"),
	{"min-score", 0, CLI_REAL, &o.min_score, "G",
		"leave out candidates with no more confidence (default 0.3)", 0, 1},
	CLI_TEXT("scene", &o.scene, "SCENE", "for scene and first: the scene's folder"),
	CLI_TEXT("weights", &o.weights, "WEIGHTS",
		"for scene and first: the folder of its training views' blend weights"),
	CLI_TEXT("spare", &o.spare, "FILE",
		"for scene: also write masks of regions that are of no object, for refer-lift"),
	{0},
};

static const struct cli_tool tool = {
	.name = "pseudomask-select",
	.operands = "[CANDIDATES]",
	.summary = "Pick an object's mask in each view: the candidate its sentences agree on.",
	.options = options,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.max_operands = 1,
};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(pseudomasks_free) struct pseudomasks w = {0};

	o.candidates = c->operand_count ? c->operands[0] : "-";
	o.method = o.method != METHOD_DEFAULT ? o.method
		   : o.scene || o.weights     ? PSEUDOMASK_SCENE
					      : SELECT_CIOU;
	if (o.method >= PSEUDOMASK_FIRST && (!o.scene || !o.weights))
		cli_usage(c, "--method %s needs --scene SCENE and --weights WEIGHTS",
			o.method == PSEUDOMASK_FIRST ? "first" : "scene");
	if (o.method < PSEUDOMASK_FIRST && (o.scene || o.weights))
		cli_usage(c, "%s is for --method scene and first", o.scene ? "--scene" : "--weights");
	if (o.method != PSEUDOMASK_SCENE && o.spare)
		cli_usage(c, "--spare is for --method scene");
	cli_refuse_overwrite(c, "CANDIDATES " CLI_SCENE " " CLI_WEIGHTS, "output spare", NULL);
	return pseudomasks_write(&w, &o, c->output, to, e);
}

CLI_MAIN(tool, run)
