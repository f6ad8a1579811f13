/* miou-score: how well predicted masks match the true ones. */
#include "base/err.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cmd/jobs/answer_scores.h"
#include "cmd/jobs/box_scores.h"
#include "cmd/jobs/score_masks.h"
#include "cmd/jobs/score_tables.h"
#include "formats/scores.h"
#include "formats/sentences.h"
#include "mask/score_choice.h"
#include "mask/score_join.h"

#include <stdlib.h>
#include <string.h>

/* The files; NULL where one was not named. */
struct paths {
	const char *predictions, *truth, *other, *sentences, *whole;
};

struct inputs {
	struct score_masks predictions, truth, other, whole;
	struct sentences sentences;
};

static int inputs_read(struct inputs *in, const struct paths *p, struct err *e)
{
	return score_masks_read(&in->truth, p->truth, e) ||
	       score_masks_read(&in->predictions, p->predictions, e) ||
	       (p->other && score_masks_read(&in->other, p->other, e)) ||
	       (p->whole && score_masks_read(&in->whole, p->whole, e)) ||
	       (p->sentences && sentences_read(&in->sentences, p->sentences, e));
}

static void inputs_free(struct inputs *in)
{
	score_masks_free(&in->predictions);
	score_masks_free(&in->truth);
	score_masks_free(&in->other);
	score_masks_free(&in->whole);
	sentences_free(&in->sentences);
}

static void tell_left_out(
	const struct cli *c, const struct score_pairs *pairs, const struct score_masks *predictions)
{
	cli_note(c, 1, "%zu predictions of views without truth were left out", pairs->unlabelled);
	if (pairs->unmatched)
		cli_warn(c,
			"%s: %zu predictions of labelled views match no truth's ref or object and were left out",
			file_name(predictions->path), pairs->unmatched);
}

/* Matched, measured and sorted pairs of the predictions and, with --compare, of the others beside them. The
 * figures of all are summed before they are sorted, so that no object's name changes their last digit. */
static int pair_up(const struct cli *c, const struct inputs *in, int is_compared, struct score_pairs *pairs,
	struct score_pairs *others, struct score *sum, struct score *other_sum, struct err *e)
{
	const struct score_masks *t = &in->truth;

	if (score_match(pairs, t->masks, t->n, in->predictions.masks, in->predictions.n, e) ||
		(is_compared && (score_match(others, t->masks, t->n, in->other.masks, in->other.n, e) ||
					score_join(pairs, others, e))) ||
		score_measure_all(pairs, e) || score_measure_all(others, e) ||
		score_choices(pairs, in->truth.masks, in->truth.n, e) ||
		score_choices(others, in->truth.masks, in->truth.n, e))
		return -1;
	score_sum(sum, pairs->items, pairs->n);
	score_sum(other_sum, others->items, others->n);
	if (!sum->pairs)
		return err_set(e, ERR_FORMAT, "%s: no mask with anything in it: there is nothing to score",
			file_name(in->truth.path));
	score_sort(pairs->items, pairs->n);
	score_sort(others->items, others->n);
	tell_left_out(c, pairs, &in->predictions);
	if (is_compared)
		tell_left_out(c, others, &in->other);
	return 0;
}

/* The tables of --sentences and --whole. */
static int by_group(const struct cli *c, struct scores *s, const struct score_sample *sample,
	const struct inputs *in, const struct paths *paths, struct err *e)
{
	size_t no_sentence = 0, no_whole = 0;

	if ((s->has_relations && score_relations(s, sample, &in->sentences, &no_sentence, e)) ||
		(s->has_visibility && score_visibility(s, sample, &in->truth, &in->whole, &no_whole, e)))
		return -1;
	if (no_sentence)
		cli_warn(c, "%s: %zu pairs have no sentence there", file_name(paths->sentences), no_sentence);
	if (no_whole)
		cli_warn(c, "%s: %zu masks of the truth have no whole there", file_name(in->whole.path),
			no_whole);
	return 0;
}

static int score(const struct cli *c, const struct inputs *in, const struct paths *paths, struct scores *s,
	struct err *e)
{
	struct score_pairs pairs = {0}, others = {0};
	struct score sum, other_sum;
	int bad = pair_up(c, in, s->is_compared, &pairs, &others, &sum, &other_sum, e);
	const struct score_sample sample = {
		pairs.n, pairs.items, s->is_compared ? others.items : NULL, s->how};

	bad = bad || score_row_make(&s->all, "", &sample, e) ||
	      score_table_objects(&s->objects, &sample, e) || by_group(c, s, &sample, in, paths, e);
	if (!bad) {
		s->all.score = sum;
		s->all.other.score = other_sum;
	}
	score_pairs_free(&pairs);
	score_pairs_free(&others);
	return bad;
}

static int score_boxes(const struct cli *c, const struct paths *p, double *miou, struct err *e)
{
	struct box_scores s;

	if (box_scores_read(&s, p->truth, p->predictions, e))
		return -1;
	if (s.unmatched)
		cli_warn(c, "%s: %zu boxes match no truth's ref or object and were left out",
			file_name(p->predictions), s.unmatched);
	*miou = s.all.aligned.iou;
	int bad = box_scores_write(&s, c->output, c->json, e);
	box_scores_free(&s);
	return bad;
}

/* Of all answers the share that is right goes into *right. */
static int score_answers(
	const struct cli *c, const struct inputs *in, const struct paths *p, double *right, struct err *e)
{
	struct answer_scores s;
	struct answer_score all;

	if (answer_scores_make(&s, &in->sentences, &in->truth, &in->predictions, e))
		return -1;
	if (s.answers.unknown)
		cli_warn(c, "%s: %zu sentences mean an object that %s does not have", file_name(p->sentences),
			s.answers.unknown, file_name(p->truth));
	if (s.answers.unmatched)
		cli_warn(c, "%s: %zu predictions have no sentence's ref and were left out",
			file_name(p->predictions), s.answers.unmatched);
	answer_score_sum(&all, &s.answers, ANSWER_ANY, NULL);
	*right = all.right;
	int bad = answer_scores_write(&s, c->output, c->json, e);
	answer_scores_free(&s);
	return bad;
}

static void check_paths(const struct cli *c, const struct paths *p)
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

int main(int argc, char **argv)
{
	struct paths paths = {0};
	double fail_under = 0, confidence = 0.95;
	long long resamples = 0;
	int is_partial = 0, is_csv = 0, is_boxes = 0, is_answers = 0;
	const struct cli_option options[] = {
		{"truth", 0, CLI_STRING, &paths.truth, "TRUTH", "the true masks (required)", 0, 0},
		{"predicted-views", 0, CLI_FLAG, &is_partial, NULL,
			"score only views that have a prediction; else truth of others counts as missing", 0,
			0},
		{"compare", 0, CLI_STRING, &paths.other, "OTHER",
			"other predictions of the same truth: which are better, pair by pair", 0, 0},
		{"sentences", 0, CLI_STRING, &paths.sentences, "FILE",
			"a row for each relation that the sentences speak of", 0, 0},
		{"whole", 0, CLI_STRING, &paths.whole, "FILE",
			"masks as if nothing hid the objects: a row for each range of what is seen", 0, 0},
		{"bootstrap", 0, CLI_INT, &resamples, "N",
			"intervals from so many resamples (1000 is usual; default 0: none)", 0,
			BOOTSTRAP_MAX},
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
	const struct cli_tool tool = {
		.name = "miou-score",
		.operands = "[PREDICTIONS]",
		.summary = "Score predicted masks against true ones.",
		.options = options,
		.common = CLI_OUTPUT | CLI_JSON | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.max_operands = 1,
	};
	struct inputs in = {0};
	struct cli c;
	struct err e;

	cli_parse(&c, &tool, argc, argv);
	paths.predictions = c.operand_count ? c.operands[0] : "-";
	check_paths(&c, &paths);
	if (c.json && is_csv)
		cli_usage(&c, "--json and --csv exclude each other");
	if (is_boxes && (is_partial || paths.other || paths.sentences || paths.whole || resamples || is_csv))
		cli_usage(&c, "--boxes goes with --truth, --json and --fail-under only");
	if (is_answers && !paths.sentences)
		cli_usage(&c, "--answers needs --sentences");
	if (is_answers && (is_boxes || paths.other || paths.whole || resamples || is_csv))
		cli_usage(&c,
			"--answers goes with --truth, --sentences, --predicted-views, --json and --fail-under only");
	cli_refuse_overwrite(&c, "PREDICTIONS truth compare sentences whole", "output", NULL);
	const struct bootstrap how = {(size_t)resamples, confidence, (uint64_t)c.seed};
	struct scores s = {.is_compared = paths.other != NULL,
		.has_relations = paths.sentences != NULL,
		.has_visibility = paths.whole != NULL,
		.how = resamples ? &how : NULL};
	int bad = is_boxes ? score_boxes(&c, &paths, &s.all.score.miou, &e) : inputs_read(&in, &paths, &e);
	if (!bad && is_partial)
		bad = score_keep_views(in.truth.masks, &in.truth.n, in.predictions.masks, in.predictions.n,
			in.other.masks, in.other.n, &e);
	const enum scores_form form = is_csv ? SCORES_CSV : c.json ? SCORES_JSON : SCORES_TEXT;
	double right = 0;
	if (!bad && is_answers)
		bad = score_answers(&c, &in, &paths, &right, &e);
	if (!bad && !is_boxes && !is_answers)
		bad = score(&c, &in, &paths, &s, &e) || scores_write(&s, c.output, form, &e);
	const double reached = is_answers ? right : s.all.score.miou;
	if (!bad && reached < fail_under)
		bad = err_set(&e, ERR_CHECK, "%s %.4f is below %g", is_answers ? "right" : "mIoU", reached,
			fail_under);
	scores_free(&s);
	inputs_free(&in);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
