/* miou-score: how well predicted masks match the true ones. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/score/scoring.h"

#include <string.h>

static void check_paths(const struct cli *c, const struct scoring_files *p)
{
	const char *all[] = {p->truth, p->predictions, p->other, p->sentences, p->whole};
	int stdins = 0;

	if (!p->truth)
		cli_usage(c, "--truth TRUTH is required");
	for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
		stdins += all[i] && !strcmp(all[i], "-");
		if (stdins == 2 && i == 1)
			cli_usage(c, "truth and predictions cannot both be stdin");
	}
	if (stdins > 1)
		cli_usage(c, "only one file can be stdin");
}

static struct scoring_files paths;
static double fail_under, confidence = 0.95;
static long long resamples;
static int is_partial, is_csv, is_boxes, is_answers;

static const struct cli_option options[] = {
	{"truth", 0, CLI_STRING, &paths.truth, "TRUTH", "the true masks (required)", 0, 0},
	{"predicted-views", 0, CLI_FLAG, &is_partial, NULL,
		"score only views that have a prediction; else truth of others counts as missing", 0, 0},
	{"compare", 0, CLI_STRING, &paths.other, "OTHER",
		"other predictions of the same truth: which are better, pair by pair", 0, 0},
	{"sentences", 0, CLI_STRING, &paths.sentences, "FILE",
		"a row for each relation that the sentences speak of", 0, 0},
	{"whole", 0, CLI_STRING, &paths.whole, "FILE",
		"masks as if nothing hid the objects: a row for each range of what is seen", 0, 0},
	{"bootstrap", 0, CLI_INT, &resamples, "N",
		"intervals from so many resamples (1000 is usual; default 0: none)", 0, BOOTSTRAP_MAX},
	{"confidence", 0, CLI_REAL, &confidence, "X",
		"share of the resamples within an interval (default 0.95)", 0.01, 0.9999},
	{"boxes", 0, CLI_FLAG, &is_boxes, NULL,
		"score boxes in space, as refer-locate and gs-synth write them", 0, 0},
	{"answers", 0, CLI_FLAG, &is_answers, NULL,
		"score answers to --sentences that may mean one object, several or none", 0, 0},
	{"fail-under", 0, CLI_REAL, &fail_under, "X",
		"exit 1 where mIoU (of --answers: what is right) is below X, in 0 to 1", 0, 1},
	{"csv", 0, CLI_FLAG, &is_csv, NULL, "print comma-separated values instead of text", 0, 0},
	{0},
};

static const struct cli_tool tool = {
	.name = "miou-score",
	.operands = "[PREDICTIONS]",
	.summary = "Score predicted masks against true ones.",
	.options = options,
	.common = CLI_OUTPUT | CLI_JSON | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.max_operands = 1,
};

static void check(const struct cli *c)
{
	check_paths(c, &paths);
	if (c->json && is_csv)
		cli_usage(c, "--json and --csv exclude each other");
	if (is_boxes && (is_partial || paths.other || paths.sentences || paths.whole || resamples || is_csv))
		cli_usage(c, "--boxes goes with --truth, --json and --fail-under only");
	if (is_answers && !paths.sentences)
		cli_usage(c, "--answers needs --sentences");
	if (is_answers && (is_boxes || paths.other || paths.whole || resamples || is_csv))
		cli_usage(c,
			"--answers goes with --truth, --sentences, --predicted-views, --json and --fail-under only");
	cli_refuse_overwrite(c, "PREDICTIONS truth compare sentences whole", "output", NULL);
}

/* *reached gets the figure of --fail-under. */
static int score(const struct cli *c, double *reached, const struct report *to, struct err *e)
{
	SCOPED_BY(scoring_free) struct scoring in = {0};
	const struct bootstrap how = {(size_t)resamples, confidence, (uint64_t)c->seed};
	SCOPED_BY(scores_free)
	struct scores s = {.is_compared = paths.other != NULL,
		.has_relations = paths.sentences != NULL,
		.has_visibility = paths.whole != NULL,
		.how = resamples ? &how : NULL};
	const enum scores_form form = is_csv ? SCORES_CSV : c->json ? SCORES_JSON : SCORES_TEXT;

	if (is_boxes)
		return scoring_boxes(&paths, c->output, c->json, reached, to, e);
	if (scoring_read(&in, &paths, is_partial, e))
		return -1;
	if (is_answers)
		return scoring_answers(&in, c->output, c->json, reached, to, e);
	if (scoring_pairs(&in, &s, to, e) || scores_write(&s, c->output, form, e))
		return -1;
	*reached = s.all.score.miou;
	return 0;
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	double reached;

	paths.predictions = c->operand_count ? c->operands[0] : "-";
	check(c);
	if (score(c, &reached, to, e))
		return -1;
	if (reached < fail_under)
		return err_set(e, ERR_CHECK, "%s %.4f is below %g", is_answers ? "right" : "mIoU", reached,
			fail_under);
	return 0;
}

int main(int argc, char **argv)
{
	return cli_main(&tool, argc, argv, run);
}
