/* feature-query: which Gaussians sentences select, by lifted features or labels. */
#include "base/mem.h"
#include "answer/peak.h"
#include "cli/cli.h"
#include "cmd/feature/feature_query.h"

#include <math.h>

static struct feature_query_options options = {.sentences = QUERY_ALL, .threshold = NAN, .smooth = 1};
static const char *files[QUERY_MAX_LEVELS];

static const struct cli_option table[] = {
	CLI_TEXT("text", &options.text, "TEXT", "sentences encoded by text-encode (required)"),
	CLI_ONE_OF("rule", &options.rule, "cosine|relevancy|hyperplane|identity",
		"what a sentence selects (default cosine)"),
	CLI_ONE_OF("sentences", &options.sentences, "train|test|all", "which sentences (default all)"),
	CLI_TEXT("vectors", &options.vectors, "FILE",
		"cosine, relevancy: the vector of each sentence (default: that of TEXT)"),
	CLI_TEXT("against", &options.against, "FILE",
		"cosine: vectors of more texts that a sentence is held against"),
	CLI_TEXT("canonical", &options.canonical, "FILE",
		"relevancy: vectors of the canonical phrases (required)"),
	CLI_TEXT("positives", &options.positives, "LIFTED",
		"hyperplane, identity: the objects that sentences are about, of refer-lift (required)"),
	{"threshold", 0, CLI_REAL, &options.threshold, "T",
		"relevancy (default 0.5; with --relative 0.4), identity (default 0.7)", -1, 1},
	CLI_SWITCH("relative", &options.is_relative,
		"relevancy: the threshold is on the range of a sentence's relevancies, brought to -1 to 1"),
	CLI_TEXT("pixels", &options.pixels, "SCENE",
		"cosine, relevancy: for the pixels of the features rendered in the test views of SCENE: masks instead of a selection"),
	{"least", 0, CLI_REAL, &options.least, "L",
		"with --pixels: a pixel whose feature is shorter has none (default 0)", 0, 1},
	{"smooth", 0, CLI_INT, &options.smooth, "N",
		"with --pixels: means over N x N pixels (LERF, the default: 1; LangSplat: 30)", 1,
		PEAK_MAX_WINDOW},
	{0}};

static const struct cli_tool tool = {.name = "feature-query",
	.operands = "--text TEXT FEATURES...",
	.summary = "Select the Gaussians that sentences mean, by lifted features or labels.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.min_operands = 1,
	.max_operands = QUERY_MAX_LEVELS,
	.output_arg = "SELECTION"};

static void check(const struct cli *c)
{
	const int by_examples = options.rule == RULE_HYPERPLANE || options.rule == RULE_IDENTITY;

	if (!options.text)
		cli_usage(c, "--text is required");
	if (options.rule == RULE_RELEVANCY && !options.canonical)
		cli_usage(c, "--rule relevancy needs --canonical");
	if (by_examples && !options.positives)
		cli_usage(c, "--rule hyperplane and --rule identity need --positives");
	if (options.pixels && by_examples)
		cli_usage(c, "--pixels is for --rule cosine and relevancy");
	if ((options.smooth > 1 || options.least > 0) && !options.pixels)
		cli_usage(c, "%s needs --pixels", options.smooth > 1 ? "--smooth" : "--least");
	if (c->operand_count > 1 && options.rule != RULE_RELEVANCY)
		cli_usage(c, "several FEATURES need --rule relevancy");
	struct cli_file features[QUERY_MAX_LEVELS + 1] = {{0}};
	for (int k = 0; k < c->operand_count; k++) {
		files[k] = c->operands[k];
		features[k] = (struct cli_file){"FEATURES", files[k], CLI_READS, NULL};
	}
	options.features = files;
	options.levels = (size_t)c->operand_count;
	cli_refuse_overwrite(
		c, "text vectors against canonical positives pixels:" CLI_SCENE_PARTS, "output", features);
	cli_refuse_terminal(c);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(feature_query_free) struct feature_query q = {0};

	check(c);
	if (feature_query_make(&q, &options, to, e))
		return -1;
	cli_note(c, 1, "%zu sentences", q.count);
	return feature_query_write(&q, c->output, e);
}

CLI_MAIN(tool, run)
