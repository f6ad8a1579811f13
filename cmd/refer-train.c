/* refer-train: learns the referring model of a scene from masks (one stage of the method). */
#include "base/file.h"
#include "cli/cli.h"
#include "formats/checkpoint.h"
#include "cmd/jobs/training.h"
#include "formats/trainlog.h"
#include "refer/divergence.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct {
	struct training_files from;
	const char *log;
	int interaction, similarity, contrast, precision, is_resumed;
	long long iterations, checkpoint, patience;
	struct trainer_options trainer;
} options = {.interaction = REFER_PCMI,
	.similarity = REFER_DOT,
	.contrast = REFER_CONTRAST_COSINE,
	.precision = PRECISION_U8,
	.iterations = 45000,
	.checkpoint = 1000,
	.trainer = TRAINER_DEFAULTS};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.from.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"weights", 0, CLI_STRING, &options.from.weights, "WEIGHTS", "folder of gs-weigh (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.from.text, "TEXT", "sentences of text-encode (required)", 0, 0},
	{"masks", 0, CLI_STRING, &options.from.masks, "MASKS", "mask records to learn from (required)", 0, 0},
	{"iterations", 0, CLI_INT, &options.iterations, "N", "training steps (default 45000)", 1, 100000000},
	{"init", 0, CLI_STRING, &options.from.lifted, "LIFTED",
		"start from the objects of this lifted model of refer-lift", 0, 0},
	{"init-iterations", 0, CLI_INT, &options.trainer.warm, "N",
		"how many of the steps fit these objects, at the start (default 500)", 1, 100000000},
	{"hold-out", 0, CLI_REAL, &options.trainer.hold_out, "F",
		"keep this share of the masks to judge by, and stop in time (default 0)", 0, 0.9},
	{"patience", 0, CLI_INT, &options.patience, "N",
		"stop after N evaluations that were no better, one every 250 steps (default 8)", 1, 1000000},
	{"interaction", 0, CLI_CHOICE, &options.interaction, REFER_INTERACTION_CHOICES,
		"how words act on Gaussians (default pcmi)", 0, 0},
	{"similarity", 0, CLI_CHOICE, &options.similarity, REFER_SIMILARITY_CHOICES,
		"how features answer words (default dot)", 0, 0},
	{"contrast", 0, CLI_CHOICE, &options.contrast, REFER_CONTRAST_CHOICES,
		"contrast between sentences (default cosine)", 0, 0},
	{"feature-width", 0, CLI_INT, &options.trainer.feature_width, "N",
		"numbers of a referring feature (default 16)", 1, REFER_MAX_X},
	{"temperature", 0, CLI_REAL, &options.trainer.temperature, "T", "of the contrast (default 0.1)", 1e-6,
		1e6},
	{"lambda", 0, CLI_REAL, &options.trainer.lambda, "X", "share of the contrast (default 0.02)", 0, 1e6},
	{"feature-rate", 0, CLI_REAL, &options.trainer.rates.features, "R",
		"learning rate of the features (default 0.0025)", 1e-12, 10},
	{"mlp-rate", 0, CLI_REAL, &options.trainer.rates.mlps, "R",
		"learning rate of the MLPs (default 0.0001)", 1e-12, 10},
	{"batch", 0, CLI_INT, &options.trainer.batch, "N", "sentences a step (default 1)", 1, 64},
	{"negatives", 0, CLI_INT, &options.trainer.negatives, "N",
		"sentences that a step is contrasted with; 0: all (default 12)", 0, 1000000},
	{"tolerance", 0, CLI_REAL, &options.trainer.tolerance, "T",
		"leave out Gaussians with this share of all weight (default 0)", 0, 0.99},
	{"share", 0, CLI_REAL, &options.trainer.share, "E",
		"pixels a feature must save; 0: one each (default 0.04)", 0, 1e6},
	{"precision", 0, CLI_CHOICE, &options.precision, PRECISION_CHOICES,
		"how features and weights are stored (default u8)", 0, 0},
	{"log", 0, CLI_STRING, &options.log, "FILE",
		"write the losses there, JSON Lines, a line every 100 steps; - is stdout", 0, 0},
	{"checkpoint", 0, CLI_INT, &options.checkpoint, "N",
		"write MODEL.checkpoint every N steps, 0 never (default 1000)", 0, 100000000},
	{"resume", 0, CLI_FLAG, &options.is_resumed, NULL, "go on from MODEL.checkpoint, if any", 0, 0}, {0}};

static const struct cli_tool tool = {.name = "refer-train",
	.operands = "-o MODEL",
	.summary = "Learn which Gaussians of a scene its sentences mean.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_SEED | CLI_OUTPUT,
	.output_arg = "MODEL",
	.needs_output = 1};

/* Everything a run holds. */
struct run {
	struct training data;
	struct trainer trainer;
	struct trainlog log;
	struct divergence divergence;
	char *checkpoint;
	struct checkpoint_of of;
	int is_own;    /* the checkpoint is of this training */
	char note[64]; /* the latest losses */
};

static int start(struct run *r, const struct cli *c, struct err *e)
{
	const struct training *d = &r->data;
	const struct trainer_source source = training_source(d);

	r->of = training_identity(d, &options.from, &options.trainer);
	if (trainer_init(&r->trainer, &source, &options.trainer, e))
		return e->code == ERR_FORMAT ? err_prefix(e, options.from.weights) : -1;
	cli_note(c, 1, "%zu of %zu Gaussians share %zu features, %.1f a pixel", r->trainer.learning,
		d->scene.splats.n, r->trainer.rows.n, trainer_weights(&r->trainer));
	cli_note(c, 1, "%zu views, %zu sentences, %zu pairs, %zu more held out", d->view_count, d->sentences,
		d->pairs, d->held);
	return 0;
}

/* Goes on from a checkpoint where that is wanted. */
static int resume(struct run *r, const struct cli *c, struct err *e)
{
	if (!r->checkpoint || !file_exists(r->checkpoint))
		return 0;
	if (!options.is_resumed && options.checkpoint)
		cli_warn(c,
			"%s: is of an earlier training and will be replaced; --resume would go on from it",
			r->checkpoint);
	if (!options.is_resumed)
		return 0;
	if (checkpoint_resume(&r->trainer.state, r->checkpoint, &r->of, options.iterations, e))
		return -1;
	r->is_own = 1;
	cli_note(c, 1, "going on after step %ld", r->trainer.state.iteration);
	return 0;
}

/* Whether training is over: all steps are done, or the held-out masks say so. */
static int is_over(const struct run *r)
{
	const struct train_state *t = &r->trainer.state;

	return t->iteration >= options.iterations || (t->best.values && t->best.since >= options.patience);
}

/* What is due after a step: lines of the log, a checkpoint. */
static int record(struct run *r, const struct cli *c, const struct step_losses *last, struct err *e)
{
	struct train_state *t = &r->trainer.state;
	const long done = t->iteration;

	if (divergence_check(&r->divergence, t, last, is_over(r), e))
		return err_prefix(e, file_name(c->output));
	if (done % TRAINLOG_EVERY == 0)
		snprintf(r->note, sizeof r->note, "loss %.4f", t->sum.total / TRAINLOG_EVERY);
	if (trainlog_step(&r->log, t, e))
		return -1;
	if (t->best.values && (done % TRAINER_EVALUATE == 0 || done == options.iterations)) {
		const struct held_score score = trainer_evaluate(&r->trainer);
		if (trainlog_put_held(&r->log, done, &score, e))
			return -1;
	}
	if (!options.checkpoint || done % options.checkpoint || is_over(r) ||
		!divergence_is_good(&r->divergence, t))
		return 0;
	const int bad = checkpoint_write(t, r->checkpoint, &r->of, e);
	r->is_own |= !bad;
	return bad;
}

static int train(struct run *r, const struct cli *c, struct err *e)
{
	struct train_state *t = &r->trainer.state;
	struct cli_progress progress;
	const long begin = t->iteration;
	int bad = 0;

	cli_progress_start(&progress, c, "steps", (double)(options.iterations - begin));
	while (!is_over(r) && !bad) {
		struct step_losses last = trainer_step(&r->trainer);
		bad = record(r, c, &last, e);
		cli_progress_step(&progress, (double)(t->iteration - begin), *r->note ? r->note : NULL);
	}
	cli_progress_end(&progress);
	if (!bad && t->best.values)
		cli_note(c, 1, "%ld steps, the held-out masks were answered best after %ld: IoU %.4f",
			t->iteration, t->best.iteration, t->best.score);
	return bad;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	const struct training *d = &r->data;

	if (strcmp(c->output, "-") && !(r->checkpoint = checkpoint_path(c->output, e)))
		return -1;
	cli_refuse_overwrite(c, CLI_SCENE " " CLI_WEIGHTS " text masks init", "output log",
		(const struct cli_file[]){{"checkpoint", r->checkpoint, CLI_WRITES, NULL}, {0}});
	if (training_read(&r->data, &options.from, options.trainer.hold_out, (uint64_t)c->seed, e))
		return -1;
	if (d->left_out)
		cli_warn(c, "%s: %zu training sentences without words are left out", options.from.text,
			d->left_out);
	if (d->test_masks)
		cli_note(c, 1, "%zu masks of test views are not used", d->test_masks);
	if (file_out_probe(c->output, e) || (r->checkpoint && file_out_probe(r->checkpoint, e)) ||
		start(r, c, e) || resume(r, c, e) ||
		trainlog_open(&r->log, options.log, r->trainer.state.iteration, e))
		return -1;
	if (train(r, c, e) ||
		training_write(d, &r->trainer, options.trainer.similarity, (enum precision)options.precision,
			c->output, r->of.identity, c->seed, e))
		return -1;
	if (r->is_own)
		unlink(r->checkpoint);
	return 0;
}

static void check_options(const struct cli *c)
{
	struct trainer_options *o = &options.trainer;
	const struct training_files *f = &options.from;
	const int is_stdout = !strcmp(c->output, "-");

	o->interaction = (enum refer_interaction)options.interaction;
	o->similarity = (enum refer_similarity)options.similarity;
	o->contrast = (enum refer_contrast)options.contrast;
	o->seed = c->seed;
	if (!f->scene || !f->weights || !f->text || !f->masks)
		cli_usage(c, "--scene, --weights, --text and --masks are required");
	if (!f->lifted && o->warm)
		cli_usage(c, "--init-iterations needs --init");
	if (o->hold_out <= 0 && options.patience)
		cli_usage(c, "--patience needs --hold-out");
	o->warm = f->lifted && !o->warm ? 500 : o->warm;
	options.patience = options.patience ? options.patience : 8;
	if (o->interaction == REFER_PCMI_PROJ && o->similarity == REFER_COSINE)
		cli_usage(c, "--similarity cosine does not go with --interaction pcmi-proj");
	if (is_stdout && options.is_resumed)
		cli_usage(c, "--resume needs a file to write to: there is no checkpoint of stdout");
	options.checkpoint = is_stdout ? 0 : options.checkpoint;
	cli_refuse_terminal(c);
}

int main(int argc, char **argv)
{
	struct run r = {0};
	struct err e = {0}, late;
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	check_options(&c);
	int bad = run(&r, &c, &e);
	if (trainlog_close(&r.log, &late) && !bad) {
		e = late;
		bad = -1;
	}
	trainer_free(&r.trainer);
	training_free(&r.data);
	free(r.checkpoint);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
