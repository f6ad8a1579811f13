/* gs-train: trains a 3DGS scene from photographs and their cameras. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/train/fitting.h"
#include "formats/cameras/colmap.h"
#include "formats/scene/checkpoint.h"

static struct fitting_options options = {
	.iterations = -1, .degree = 3, .scale = 1, .exposure = "auto", .checkpoint = 1000};

static const struct cli_option table[] = {
	{"cameras", 0, CLI_STRING, &options.cameras, "PATH",
		"COLMAP model, 3DGS cameras.json, transforms.json, or their folder (required)", 0, 0},
	{"images", 0, CLI_STRING, &options.images, "DIR", "folder of the photographs (required)", 0, 0},
	{"points", 0, CLI_STRING, &options.points, "DIR",
		"COLMAP model whose points the first Gaussians are (default: the cameras')", 0, 0},
	{"init", 0, CLI_STRING, &options.init, "SPLATS", "go on from this scene in place of the points", 0,
		0},
	{"test-views", 0, CLI_STRING, &options.test_views, "NAMES",
		"views kept for testing: NAME,... or every:N (default: the camera file's, else none)", 0, 0},
	{"iterations", 0, CLI_INT, &options.iterations, "N", "training steps (default 7000)", 0, 100000000},
	{"minutes", 0, CLI_REAL, &options.minutes, "M",
		"in place of --iterations: as many as this time gives", 0.01, 100000},
	{"gaussians", 0, CLI_INT, &options.gaussians, "N",
		"at most so many (default 10 times the points, 20000 to 500000)", 1, 50000000},
	{"degree", 0, CLI_INT, &options.degree, "N", "of the spherical harmonics, 0 to 3 (default 3)", 0, 3},
	{"scale", 0, CLI_REAL, &options.scale, "S",
		"learn from photographs of round(W S) x round(H S) (default 1)", 0.001, 1},
	{"ignore", 0, CLI_STRING, &options.ignore, "DIR",
		"masks of pixels that do not count: DIR/VIEW.png, not black where they are", 0, 0},
	{"exposure", 0, CLI_STRING, &options.exposure, "WHEN",
		"learn each photograph's exposure: always, never, or auto, where they differ (default)", 0,
		0},
	{"preview", 0, CLI_STRING, &options.preview, "DIR", "draw a view there at each evaluation", 0, 0},
	{"checkpoint", 0, CLI_INT, &options.checkpoint, "N",
		"write SPLATS.checkpoint every N steps, 0 never (default 1000)", 0, 100000000},
	{"resume", 0, CLI_FLAG, &options.is_resumed, NULL, "go on from SPLATS.checkpoint, if any", 0, 0},
	{"log", 0, CLI_STRING, &options.log, "FILE",
		"write the losses there, JSON Lines, a line every 100 steps; - is stdout", 0, 0},
	{0},
};

static const struct cli_tool tool = {
	.name = "gs-train",
	.operands = "-o SPLATS",
	.summary = "Train a 3D Gaussian Splatting scene from photographs and their cameras.",
	.options = table,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_SEED | CLI_VERBOSE | CLI_QUIET,
	.output_arg = "SPLATS",
	.needs_output = 1,
};

static int run(const struct cli *cli, const struct report *to, struct err *e)
{
	if (!options.cameras || !options.images)
		cli_usage(cli, "--cameras and --images are required");
	if (options.minutes > 0 && options.iterations >= 0)
		cli_usage(cli, "--iterations and --minutes do not go together");
	if (options.init && options.points)
		cli_usage(cli, "--init and --points do not go together");
	if (strcmp(options.exposure, "auto") && strcmp(options.exposure, "always") &&
		strcmp(options.exposure, "never"))
		cli_usage(cli, "--exposure is '%s', and auto, always or never are what it can be",
			options.exposure);
	const int is_stdout = !strcmp(cli->output, "-");
	if (is_stdout && options.is_resumed)
		cli_usage(cli, "--resume needs a file to write to: there is no checkpoint of stdout");
	options.checkpoint = is_stdout ? 0 : options.checkpoint;
	SCOPED char *path = is_stdout ? NULL : checkpoint_path(cli->output, e);
	if (!is_stdout && !path)
		return -1;
	options.checkpoint_path = path;
	options.iterations = options.iterations < 0 ? 7000 : options.iterations;
	options.output = cli->output;
	options.seed = cli->seed;
	cli_refuse_terminal(cli);
	const struct cli_file found[] = {
		{"--cameras", options.cameras, CLI_READS, file_is_dir(options.cameras) ? COLMAP_PARTS : NULL},
		{"--images", options.images, CLI_READS, "*"}, {"checkpoint", path, CLI_WRITES, NULL}, {0}};
	cli_refuse_overwrite(cli, "init", "output log", found);
	return fit_scene(&options, to, e);
}

CLI_MAIN(tool, run)
