/* gs-synth: a synthetic table-top benchmark, laid out as a person's own data would be. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/synth/benchmark.h"
#include "synth/synth_scene.h"

static long long objects, views, gaussians, times;
static int number, size[2], is_wording_seen;

static const struct cli_option options[] = {
	CLI_ONE_OF("scene", &number, "table|diner|toys|tea|kitchen", "what is made (default table)"),
	{"objects", 0, CLI_INT, &objects, "K", "objects (default: the scene's; of the table 8)",
		SYNTH_MIN_OBJECTS, SYNTH_MAX_OBJECTS},
	{"views", 0, CLI_INT, &views, "V",
		"views for training and testing (default: the scene's; of the table 25)", SYNTH_MIN_VIEWS,
		SYNTH_MAX_VIEWS},
	{"size", 0, CLI_SIZE, size, "WxH",
		"size of the photographs in pixels (default 492x364; of the table 320x240)", 16, 4096},
	{"gaussians", 0, CLI_INT, &gaussians, "N", "Gaussians (default 60000; of the table 20000)", 1000,
		10000000},
	{"seen-wording", 0, CLI_FLAG, &is_wording_seen, NULL, "test sentences in wordings of training ones",
		0, 0},
	{"moving", 0, CLI_INT, &times, "N",
		"a scene that moves: frames of N times, and sentences of what moves how", 1, SYNTH_MAX_TIMES},
	{0},
};

static const struct cli_tool tool = {
	.name = "gs-synth",
	.operands = "-o DIR",
	.summary =
		"Make a synthetic table-top scene with photographs, sentences, candidate masks and their truth.",
	.options = options,
	.common = CLI_OUTPUT | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.output_arg = "DIR",
	.needs_output = 1,
};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(benchmark_free) struct benchmark b = {0};
	const struct synth_preset *p = synth_preset(number);

	if (!strcmp(c->output, "-"))
		cli_usage(c, "-o must name a folder");
	b.options = (struct synth_options){p, 0, objects ? (int)objects : p->objects,
		views ? (int)views : p->views, size[0] ? size[0] : p->width, size[0] ? size[1] : p->height,
		gaussians ? (size_t)gaussians : p->gaussians, is_wording_seen, (int)times};
	return benchmark_make(&b, number, (uint64_t)c->seed, e) || benchmark_write(&b, c->output, to, e) ? -1
													 : 0;
}

CLI_MAIN(tool, run)
