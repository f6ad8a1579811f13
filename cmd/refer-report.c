/* refer-report: what a pipeline made of a scene, as one page of HTML. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/report/reporting.h"

static const char *output;
static struct report_options options = {.views = 12, .width = 480, .splats = 200000};

static const struct cli_option table[] = {
	CLI_TEXT("truth", &options.truth, "TRUTH",
		"true masks (default: those that the pipeline scored against, if any)"),
	{"views", 0, CLI_INT, &options.views, "N", "show so many views at most (default 12)", 1, 1000},
	{"width", 0, CLI_INT, &options.width, "N", "width of the pictures in pixels (default 480)", 16, 4096},
	CLI_TEXT("viewer", &options.viewer, "DIR",
		"folder of the viewer of splats (default: where 'make viewer' puts it)"),
	CLI_SWITCH("no-viewer", &options.is_plain, "leave the viewer out"),
	{"splats", 0, CLI_INT, &options.splats, "N",
		"Gaussians in the viewer at most, those that cover most (default 200000)", 1, 10000000},
	{"output", 'o', CLI_STRING, &output, "FILE", "where to write; - is stdout (default RUN/report.html)",
		0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-report",
	.operands = "RUN",
	.summary =
		"Make one page of HTML of a run folder: each sentence with its answers, scores and reasons.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS,
	.min_operands = 1,
	.max_operands = 1};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	options.run = c->operands[0];
	SCOPED char *path = output ? mem_strdup(output, e) : file_join(options.run, "report.html", "", e);
	const struct cli_file files[] = {{"the page", path, CLI_WRITES, NULL},
		{"RUN", options.run, CLI_READS, "scene|lifted|stage1|stage2|log|*.safetensors|*.jsonl"}, {0}};

	if (options.viewer && options.is_plain)
		cli_usage(c, "--viewer and --no-viewer exclude each other");
	cli_refuse_overwrite(c, "truth", "", files);
	if (!path || reporting_write(&options, path, to, e))
		return -1;
	if (!output)
		cli_note(c, 1, "made %s", path);
	return 0;
}

CLI_MAIN(tool, run)
