/* feature-lift: what 2D models say of a scene's views, lifted onto its Gaussians. */
#include "base/mem.h"
#include "base/path.h"
#include "cli/cli.h"
#include "cmd/feature/feature_lifting.h"

#define DEFAULT_MEMORY 1024
#define MOST_MEMORY 16777216

static struct feature_lifting_options options = {.memory = DEFAULT_MEMORY};

static const struct cli_option table[] = {
	CLI_TEXT("scene", &options.scene, "SCENE", "scene folder of gs-import (required)"),
	CLI_TEXT("weights", &options.weights, "WEIGHTS", "folder of gs-weigh (required)"),
	CLI_TEXT("masks", &options.maps.masks, "MASKS", "masks in place of MAPS"),
	CLI_TEXT("text", &options.maps.text, "TEXT",
		"a mask's feature is the vector of its sentence or object in this file of text-encode (default: objects are labels)"),
	{"level", 0, CLI_INT, &options.maps.level, "L", "which level of VIEW_s.npy (default 0)", 0, 255},
	CLI_ONE_OF("uncovered", &options.maps.is_zero, "skip|zero",
		"a pixel without a feature does not count (default), or counts as a feature of zeros"),
	{"prune", 0, CLI_REAL, &options.prune, "R",
		"Gaussians of less reliability count as unseen (default 0)", 0, 1},
	CLI_ONE_OF("precision", &options.is_single, "f16|f32", "of the features written (default f16)"),
	{"memory", 0, CLI_INT, &options.memory, "MIB",
		"memory for sums of features; with less, all views are read several times (default 1024)", 1,
		MOST_MEMORY},
	{0}};

static const struct cli_tool tool = {.name = "feature-lift",
	.operands = "--scene SCENE --weights WEIGHTS [MAPS]",
	.summary = "Lift features or labels of a scene's views onto its Gaussians.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.max_operands = 1,
	.output_arg = "FEATURES"};

static void check(const struct cli *c)
{
	if (!options.scene || !options.weights)
		cli_usage(c, "--scene and --weights are required");
	options.maps.folder = c->operand_count ? c->operands[0] : NULL;
	if (!options.maps.folder == !options.maps.masks)
		cli_usage(c, "either MAPS or --masks is required");
	if (options.maps.text && !options.maps.masks)
		cli_usage(c, "--text needs --masks");
	const int is_file = options.maps.folder && path_ends(options.maps.folder, ".npz");
	const struct cli_file maps[] = {
		{"MAPS", options.maps.folder, CLI_READS, is_file ? NULL : "*.npy|*.npz|*.png"}, {0}};
	cli_refuse_overwrite(c, CLI_SCENE " " CLI_WEIGHTS " masks text", "output", maps);
	cli_refuse_terminal(c);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(feature_lifting_free) struct feature_lifting l = {0};

	check(c);
	if (feature_lifting_make(&l, &options, to, e))
		return -1;
	cli_note(c, 1, "%zu of %zu Gaussians are seen, and %zu more are not reliable", l.seen,
		l.scene.splats.n, l.pruned);
	return feature_lifting_write(&l, c->output, e);
}

CLI_MAIN(tool, run)
