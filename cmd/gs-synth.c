/* gs-synth: a synthetic table-top benchmark, laid out as a person's own data would be. */
#include "cli/cli.h"
#include "cmd/synth/benchmark.h"
#include "synth/statistics.h"

#include <string.h>

static void note_quantiles(const struct cli *c, const char *name, const double *q)
{
	cli_note(c, 1, "%-10s %8.3g %8.3g %8.3g %8.3g %8.3g", name, q[0], q[1], q[2], q[3], q[4]);
}

static void note_visibility(
	const struct cli *c, const struct synth_statistics *s, const char *name, enum camera_split split)
{
	const struct synth_visibility *v = &s->visibility[split];
	double of = v->pairs ? 100.0 / (double)v->pairs : 0;
	const long *b = v->bands;

	cli_note(c, 1, "%-10s %8.1f %8.1f %8.1f %8.1f %8.1f %8ld", name, of * (double)b[0], of * (double)b[1],
		of * (double)b[2], of * (double)b[3], of * (double)b[4], v->outside);
}

/* What statistics.json says, without the relations. */
static void note_statistics(const struct cli *c, const struct synth_statistics *s)
{
	cli_note(c, 1, "%d objects: %d in %d groups of look-alikes, %d on others; %zu Gaussians", s->objects,
		s->alike, s->alike_groups, s->stacked, s->gaussians);
	cli_note(c, 1, "training: %d views, %d sentences of %.1f words", s->views[SPLIT_TRAIN],
		s->sentences[SPLIT_TRAIN], s->words[SPLIT_TRAIN]);
	cli_note(c, 1, "test: %d views, %d sentences of %.1f words", s->views[SPLIT_TEST],
		s->sentences[SPLIT_TEST], s->words[SPLIT_TEST]);
	cli_note(c, 1, "%-10s %8s %8s %8s %8s %8s", "quantile", "5%", "25%", "50%", "75%", "95%");
	note_quantiles(c, "opacity", s->opacity);
	note_quantiles(c, "aspect", s->aspect);
	note_quantiles(c, "size", s->size);
	cli_note(c, 1, "%-10s %8s %8s %8s %8s %8s %8s", "% visible", synth_statistics_band(0),
		synth_statistics_band(1), synth_statistics_band(2), synth_statistics_band(3),
		synth_statistics_band(4), "outside");
	note_visibility(c, s, "training", SPLIT_TRAIN);
	note_visibility(c, s, "test", SPLIT_TEST);
}

int main(int argc, char **argv)
{
	long long objects = 0, views = 0, gaussians = 0;
	int number = 0, size[2] = {0};
	struct benchmark b = {0};
	struct cli_report to;
	struct cli c;
	struct err e = {0};
	const struct cli_option options[] = {
		{"scene", 0, CLI_CHOICE, &number, "table|diner|toys|tea|kitchen",
			"what is made (default table)", 0, 0},
		{"objects", 0, CLI_INT, &objects, "K", "objects (default: the scene's; of the table 8)",
			SYNTH_MIN_OBJECTS, SYNTH_MAX_OBJECTS},
		{"views", 0, CLI_INT, &views, "V",
			"views for training and testing (default: the scene's; of the table 25)",
			SYNTH_MIN_VIEWS, SYNTH_MAX_VIEWS},
		{"size", 0, CLI_SIZE, size, "WxH",
			"size of the photographs in pixels (default 492x364; of the table 320x240)", 16,
			4096},
		{"gaussians", 0, CLI_INT, &gaussians, "N", "Gaussians (default 60000; of the table 20000)",
			1000, 10000000},
		{0},
	};
	const struct cli_tool tool = {
		.name = "gs-synth",
		.operands = "-o DIR",
		.summary =
			"Make a synthetic table-top scene with photographs, sentences, candidate masks and their truth.",
		.options = options,
		.common = CLI_OUTPUT | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.output_arg = "DIR",
		.needs_output = 1,
	};

	cli_parse(&c, &tool, argc, argv);
	if (!strcmp(c.output, "-"))
		cli_usage(&c, "-o must name a folder");
	const struct synth_preset *p = synth_preset(number);
	b.options = (struct synth_options){p, 0, objects ? (int)objects : p->objects,
		views ? (int)views : p->views, size[0] ? size[0] : p->width, size[0] ? size[1] : p->height,
		gaussians ? (size_t)gaussians : p->gaussians};
	int bad = benchmark_make(&b, number, (uint64_t)c.seed, &e) ||
		  benchmark_write(&b, c.output, cli_report(&to, &c), &e);
	if (!bad)
		note_statistics(&c, &b.statistics);
	benchmark_free(&b);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
