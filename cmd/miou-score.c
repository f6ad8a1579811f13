/* miou-score: how well predicted masks match the true ones. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/score/scoring.h"

static void check_paths(const struct cli *c, const struct scoring_files *p)
{
	const char *all[] = {p->truth, p->predictions, p->other, p->sentences, p->parses, p->whole};
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
static int is_partial, is_csv, is_boxes, is_answers, is_best;

static const struct cli_option options[] = {
	CLI_TEXT("truth", &paths.truth, "TRUTH", "the true masks (required)"),
	CLI_SWITCH("predicted-views", &is_partial,
		"score only views that have a prediction; else truth of others counts as missing"),
	CLI_SWITCH("best", &is_best,
		"whatever predictions are called: of each thing of the truth its best object"),
	CLI_TEXT("compare", &paths.other, "OTHER",
		"other predictions of the same truth: which are better, pair by pair"),
	CLI_TEXT("sentences", &paths.sentences, "FILE", "of --answers: which objects each sentence means"),
	CLI_TEXT("parses", &paths.parses, "FILE",
		"a row for each relation that sentences speak of, as text-parse takes them apart"),
	CLI_TEXT("whole", &paths.whole, "FILE",
		"masks as if nothing hid the objects: a row for each range of what is seen"),
	{"bootstrap", 0, CLI_INT, &resamples, "N",
		"intervals from so many resamples (1000 is usual; default 0: none)", 0, BOOTSTRAP_MAX},
	{"confidence", 0, CLI_REAL, &confidence, "X",
		"share of the resamples within an interval (default 0.95)", 0.01, 0.9999},
	CLI_SWITCH("boxes", &is_boxes, "score boxes in space, as refer-locate and gs-synth write them"),
	CLI_SWITCH("answers", &is_answers,
		"score answers to --sentences that may mean one object, several or none"),
	{"fail-under", 0, CLI_REAL, &fail_under, "X",
		"exit 1 where mIoU (of --answers: what is right) is below X, in 0 to 1", 0, 1},
	CLI_SWITCH("csv", &is_csv, "print comma-separated values instead of text"),
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
	if (is_boxes && (is_partial || paths.other || paths.sentences || paths.parses || paths.whole ||
				resamples || is_csv))
		cli_usage(c, "--boxes goes with --truth, --json and --fail-under only");
	if (is_best && (is_boxes || is_answers || paths.other))
		cli_usage(c, "--best does not go with --boxes, --answers and --compare");
	if (is_answers != (paths.sentences != NULL))
		cli_usage(c,
			is_answers ? "--answers needs --sentences" : "--sentences goes with --answers only");
	if (is_answers && (is_boxes || paths.other || paths.parses || paths.whole || resamples || is_csv))
		cli_usage(c,
			"--answers goes with --truth, --sentences, --predicted-views, --json and --fail-under only");
	cli_refuse_overwrite(c, "PREDICTIONS truth compare sentences parses whole", "output", NULL);
}

/* *reached gets the figure of --fail-under. */
static int score(const struct cli *c, double *reached, const struct report *to, struct err *e)
{
	SCOPED_BY(scoring_free) struct scoring in = {0};
	const struct bootstrap how = {(size_t)resamples, confidence, (uint64_t)c->seed};
	SCOPED_BY(scores_free)
	struct scores s = {.is_compared = paths.other != NULL,
		.has_relations = paths.parses != NULL,
		.has_visibility = paths.whole != NULL,
		.how = resamples ? &how : NULL};
	const enum scores_form form = is_csv ? SCORES_CSV : c->json ? SCORES_JSON : SCORES_TEXT;

	if (is_boxes)
		return scoring_boxes(&paths, c->output, c->json, reached, to, e);
	if (scoring_read(&in, &paths, is_partial, e))
		return -1;
	if (is_best && scoring_take_best(&in, e))
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

CLI_MAIN(tool, run)
