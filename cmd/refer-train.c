/* refer-train: learns the referring model of a scene from masks (one stage of the method). */
#include "cli/cli.h"
#include "cli/signals.h"
#include "cmd/train/training.h"
#include "formats/scene/checkpoint.h"

#include <stdlib.h>
#include <string.h>

static struct learning_options options = {
	.iterations = 45000, .checkpoint = 1000, .memory = 1024, .trainer = TRAINER_DEFAULTS};

/* In the order of their choices. */
static int interaction = REFER_PCMI, similarity = REFER_DOT, query = REFER_WORDS,
	   contrast = REFER_CONTRAST_COSINE, precision = PRECISION_U8;

static const struct cli_option table[] = {
	CLI_TEXT("scene", &options.from.scene, "SCENE", "scene folder of gs-import (required)"),
	CLI_TEXT("weights", &options.from.weights, "WEIGHTS", "folder of gs-weigh (required)"),
	CLI_TEXT("text", &options.from.text, "TEXT", "sentences of text-encode (required)"),
	CLI_TEXT("masks", &options.from.masks, "MASKS", "mask records to learn from (required)"),
	{"iterations", 0, CLI_INT, &options.iterations, "N", "training steps (default 45000)", 1, 100000000},
	CLI_TEXT("init", &options.from.lifted, "LIFTED",
		"start from the objects of this lifted model of refer-lift"),
	{"init-iterations", 0, CLI_INT, &options.trainer.warm, "N",
		"how many of the steps fit these objects, at the start (default 500)", 1, 100000000},
	CLI_ONE_OF("interaction", &interaction, REFER_INTERACTION_CHOICES,
		"how words act on Gaussians (default pcmi)"),
	CLI_ONE_OF("similarity", &similarity, REFER_SIMILARITY_CHOICES,
		"how features answer words (default dot)"),
	CLI_ONE_OF("query", &query, REFER_QUERY_CHOICES,
		"what stands for a sentence: its words, or its parse (default words)"),
	CLI_ONE_OF(
		"contrast", &contrast, REFER_CONTRAST_CHOICES, "contrast between sentences (default cosine)"),
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
	CLI_ONE_OF("precision", &precision, PRECISION_CHOICES,
		"how features and weights are stored (default u8)"),
	{"memory", 0, CLI_INT, &options.memory, "MIB",
		"memory for the views' weights; what has no room is read for each step (default 1024)", 0,
		16777216},
	CLI_TEXT("log", &options.log, "FILE",
		"write the losses there, JSON Lines, a line every 100 steps; - is stdout"),
	{"checkpoint", 0, CLI_INT, &options.checkpoint, "N",
		"write MODEL.checkpoint every N steps, 0 never (default 1000)", 0, 100000000},
	CLI_SWITCH("resume", &options.is_resumed, "go on from MODEL.checkpoint, if any"), {0}};

static const struct cli_tool tool = {.name = "refer-train",
	.operands = "-o MODEL",
	.summary = "Learn which Gaussians of a scene its sentences mean.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_SEED | CLI_OUTPUT,
	.output_arg = "MODEL",
	.needs_output = 1};

static void check_options(const struct cli *c)
{
	struct trainer_options *o = &options.trainer;
	const struct training_files *f = &options.from;
	const int is_stdout = !strcmp(c->output, "-");

	o->interaction = (enum refer_interaction)interaction;
	o->similarity = (enum refer_similarity)similarity;
	o->query = (enum refer_query)query;
	o->contrast = (enum refer_contrast)contrast;
	o->seed = c->seed;
	options.precision = (enum precision)precision;
	options.output = c->output;
	if (!f->scene || !f->weights || !f->text || !f->masks)
		cli_usage(c, "--scene, --weights, --text and --masks are required");
	if (!f->lifted && o->warm)
		cli_usage(c, "--init-iterations needs --init");
	o->warm = f->lifted && !o->warm ? 500 : o->warm;
	if (o->interaction == REFER_PCMI_PROJ && o->similarity == REFER_COSINE)
		cli_usage(c, "--similarity cosine does not go with --interaction pcmi-proj");
	if (is_stdout && options.is_resumed)
		cli_usage(c, "--resume needs a file to write to: there is no checkpoint of stdout");
	options.checkpoint = is_stdout ? 0 : options.checkpoint;
	cli_refuse_terminal(c);
}

int main(int argc, char **argv)
{
	struct learning l = {0};
	struct err e = {0};
	struct cli_report to;
	struct cli c;
	char *path = NULL;

	cli_parse(&c, &tool, argc, argv);
	check_options(&c);
	if (strcmp(c.output, "-") && !(path = checkpoint_path(c.output, &e)))
		return cli_fail(&c, &e);
	cli_refuse_overwrite(&c, CLI_SCENE " " CLI_WEIGHTS " text masks init", "output log",
		(const struct cli_file[]){{"checkpoint", path, CLI_WRITES, NULL}, {0}});
	options.checkpoint_path = path;
	options.stop = cli_stop_catch();
	int bad = learn(&l, &options, cli_report(&to, &c), &e);
	learning_free(&l);
	free(path);
	bad = bad ? cli_fail(&c, &e) : cli_done(&c);
	if (l.is_stopped)
		cli_stop_end();
	return bad;
}
