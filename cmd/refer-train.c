/* refer-train: learns the referring model of a scene from masks (one stage of the method). */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/checkpoint.h"
#include "formats/model.h"
#include "formats/training.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct options {
	const char *scene, *weights, *text, *masks, *log;
	int interaction, similarity, contrast, is_resumed;
	long long iterations, batch, checkpoint;
	double temperature, lambda, tolerance;
	struct train_rates rates;
};

static struct options options = {.interaction = REFER_PCMI,
	.similarity = REFER_DOT,
	.contrast = REFER_CONTRAST_COSINE,
	.iterations = 45000,
	.batch = 1,
	.checkpoint = 1000,
	.temperature = 0.1,
	.lambda = 0.02,
	.rates = {0.0025, 0.0001}};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"weights", 0, CLI_STRING, &options.weights, "WEIGHTS", "folder of gs-weigh (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"masks", 0, CLI_STRING, &options.masks, "MASKS", "mask records to learn from (required)", 0, 0},
	{"iterations", 0, CLI_INT, &options.iterations, "N", "training steps (default 45000)", 1, 100000000},
	{"interaction", 0, CLI_CHOICE, &options.interaction, REFER_INTERACTION_CHOICES,
		"how words act on Gaussians (default pcmi)", 0, 0},
	{"similarity", 0, CLI_CHOICE, &options.similarity, REFER_SIMILARITY_CHOICES,
		"how features answer words (default dot)", 0, 0},
	{"contrast", 0, CLI_CHOICE, &options.contrast, REFER_CONTRAST_CHOICES,
		"contrast between sentences (default cosine)", 0, 0},
	{"temperature", 0, CLI_REAL, &options.temperature, "T", "of the contrast (default 0.1)", 1e-6, 1e6},
	{"lambda", 0, CLI_REAL, &options.lambda, "X", "weight of the contrast in the loss (default 0.02)", 0, 1e6},
	{"feature-rate", 0, CLI_REAL, &options.rates.features, "R", "learning rate of the features (default 0.0025)", 1e-12, 10},
	{"mlp-rate", 0, CLI_REAL, &options.rates.mlps, "R", "learning rate of the MLPs (default 0.0001)", 1e-12, 10},
	{"batch", 0, CLI_INT, &options.batch, "N", "sentences of a view in one step (default 1)", 1, 64},
	{"tolerance", 0, CLI_REAL, &options.tolerance, "T",
		"leave out the Gaussians that carry this share of all weight (default 0)", 0, 0.99},
	{"log", 0, CLI_STRING, &options.log, "FILE", "write the losses there, JSON Lines, a line every 100 steps", 0, 0},
	{"checkpoint", 0, CLI_INT, &options.checkpoint, "N",
		"write MODEL.checkpoint every N steps, 0 never (default 1000)", 0, 100000000},
	{"resume", 0, CLI_FLAG, &options.is_resumed, NULL, "go on from MODEL.checkpoint where there is one", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-train",
	.operands = "-o MODEL",
	.summary = "Learn which Gaussians of a scene its sentences mean.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_SEED | CLI_OUTPUT,
	.output_arg = "MODEL",
	.needs_output = 1};

enum { LOG_EVERY = 100 };

/* Everything a run holds. */
struct run {
	struct training data;
	struct model model;
	float *position;
	struct step *step;
	struct train_order order;
	struct train_state state;
	char *checkpoint, identity[512];
	FILE *log;
	struct step_losses sum; /* since the last line of the log */
};

static int prepare(struct run *r, const struct cli *c, struct err *e)
{
	struct training *d = &r->data;
	struct model *m = &r->model;

	if (training_read(d, options.scene, options.weights, options.text, options.masks, e))
		return -1;
	if (d->left_out)
		cli_warn(c, "%s: %zu training sentences without words are left out", options.text, d->left_out);
	refer_layout_init(&m->layout, (enum refer_interaction)options.interaction, d->text.width);
	m->similarity = (enum refer_similarity)options.similarity;
	m->scene_gaussians = d->scene.splats.n;
	m->ids = mem_alloc(m->scene_gaussians, sizeof *m->ids, "ids", e);
	if (!m->ids ||
		train_active_set(d->views, d->view_count, m->scene_gaussians, options.tolerance, m->ids, &m->n, e) ||
		train_bounds(d->scene.splats.means, m->ids, m->n, m->low, m->high, e))
		return -1;
	r->position = mem_alloc(m->n, 3 * sizeof(float), "positions", e);
	if (!r->position)
		return -1;
	train_positions(d->scene.splats.means, m->ids, m->n, m->low, m->high, r->position);
	const struct step_setup setup = {.layout = &m->layout,
		.similarity = m->similarity,
		.contrast = (enum refer_contrast)options.contrast,
		.temperature = options.temperature,
		.lambda = options.lambda,
		.gaussians = m->n,
		.ids = m->ids,
		.scene_gaussians = m->scene_gaussians,
		.position = r->position,
		.sentences = d->sentences,
		.offsets = d->offsets,
		.words = d->words,
		.objects = d->objects,
		.pixels = d->pixels,
		.batch = (int)options.batch};
	r->step = step_new(&setup, e);
	if (!r->step || train_order_init(&r->order, d->views, d->view_count, (int)options.batch, (uint64_t)c->seed, e) ||
		train_state_init(&r->state, &m->layout, m->n, (uint64_t)c->seed, e))
		return -1;
	cli_note(c, 1, "%zu of %zu Gaussians, %zu views, %zu sentences, %zu pairs", m->n, m->scene_gaussians, d->view_count,
		d->sentences, d->pairs);
	if (d->test_masks)
		cli_note(c, 1, "%zu masks of test views are not used", d->test_masks);
	snprintf(r->identity, sizeof r->identity,
		"interaction %s similarity %s contrast %d temperature %.17g lambda %.17g rates %.17g %.17g batch %lld tolerance %.17g "
		"seed %lld inputs %08x",
		refer_interaction_name(m->layout.interaction), refer_similarity_name(m->similarity), options.contrast,
		options.temperature, options.lambda, options.rates.features, options.rates.mlps, options.batch,
		options.tolerance, c->seed, d->checksum);
	return 0;
}

/* Opens the log; after a resume it keeps the lines up to the checkpoint's iteration. */
static int open_log(struct run *r, struct err *e)
{
	char *line = NULL;
	size_t capacity = 0;
	long at = 0, keep = 0, iteration;

	if (!options.log)
		return 0;
	r->log = fopen(options.log, r->state.iteration ? "a+" : "w+");
	if (!r->log)
		return err_errno(e, "%s", options.log);
	rewind(r->log);
	while (getline(&line, &capacity, r->log) > 0) {
		at = ftell(r->log);
		if (sscanf(line, "{\"iteration\":%ld,", &iteration) == 1 && iteration <= r->state.iteration)
			keep = at;
	}
	free(line);
	if (fflush(r->log) || ftruncate(fileno(r->log), keep) || fseek(r->log, 0, SEEK_END))
		return err_errno(e, "%s", options.log);
	return 0;
}

static int put_log(struct run *r, struct err *e)
{
	const double n = LOG_EVERY;

	if (r->log && (fprintf(r->log, "{\"iteration\":%ld,\"bce\":%.9g,\"contrast\":%.9g,\"loss\":%.9g}\n", r->state.iteration,
			       r->sum.bce / n, r->sum.contrast / n, r->sum.total / n) < 0 ||
			      fflush(r->log)))
		return err_errno(e, "%s", options.log);
	r->sum = (struct step_losses){0};
	return 0;
}

static int train(struct run *r, const struct cli *c, struct err *e)
{
	struct cli_progress progress;
	char note[64];
	const long begin = r->state.iteration;

	cli_progress_start(&progress, c, "steps", (double)(options.iterations - begin));
	while (r->state.iteration < options.iterations) {
		struct step_losses l = train_step(&r->state, r->step, &r->order, &options.rates, r->model.n);
		const long done = r->state.iteration;
		if (!isfinite(l.total)) {
			cli_progress_end(&progress);
			return err_set(e, ERR_CHECK, "%s: the loss is not finite at step %ld", c->output, done);
		}
		r->sum.bce += l.bce;
		r->sum.contrast += l.contrast;
		r->sum.total += l.total;
		if (done % LOG_EVERY == 0) {
			snprintf(note, sizeof note, "loss %.4f", r->sum.total / LOG_EVERY);
			if (put_log(r, e))
				return -1;
		}
		if (options.checkpoint && done % options.checkpoint == 0 && done < options.iterations &&
			checkpoint_write(&r->state, r->checkpoint, r->identity, e))
			return -1;
		cli_progress_step(&progress, (double)(done - begin), done - begin >= LOG_EVERY ? note : NULL);
	}
	cli_progress_end(&progress);
	return 0;
}

static int write_result(struct run *r, const struct cli *c, struct err *e)
{
	struct model *m = &r->model;
	char text[640];

	m->features = mem_alloc(m->n, REFER_X * sizeof(float), "features", e);
	if (!m->features)
		return -1;
	step_unpack(train_state_x(&r->state), m->n, m->features);
	m->parameters = r->state.values;
	snprintf(text, sizeof text, "iterations %ld %s", r->state.iteration, r->identity);
	int bad = model_write(m, c->output, text, c->seed, e);
	m->parameters = NULL;
	if (!bad && r->checkpoint)
		unlink(r->checkpoint);
	return bad;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	const size_t bytes = strlen(c->output) + sizeof ".checkpoint";

	if (strcmp(c->output, "-")) {
		r->checkpoint = mem_alloc(bytes, 1, c->output, e);
		if (!r->checkpoint)
			return -1;
		snprintf(r->checkpoint, bytes, "%s.checkpoint", c->output);
	}
	if (prepare(r, c, e))
		return -1;
	if (options.is_resumed && r->checkpoint && file_exists(r->checkpoint)) {
		if (checkpoint_read(&r->state, r->checkpoint, r->identity, e))
			return -1;
		cli_note(c, 1, "going on after step %ld", r->state.iteration);
	}
	return open_log(r, e) || train(r, c, e) || write_result(r, c, e) ? -1 : 0;
}

int main(int argc, char **argv)
{
	struct run r = {0};
	struct cli c;
	struct err e = {0};

	cli_parse(&c, &tool, argc, argv);
	if (!options.scene || !options.weights || !options.text || !options.masks)
		cli_usage(&c, "--scene, --weights, --text and --masks are required");
	if (options.interaction == REFER_PCMI_PROJ && options.similarity == REFER_COSINE)
		cli_usage(&c, "--similarity cosine does not go with --interaction pcmi-proj, whose features are normalised");
	if (options.checkpoint && !strcmp(c.output, "-"))
		options.checkpoint = 0;
	cli_refuse_terminal(&c);
	int bad = run(&r, &c, &e);
	if (r.log && fclose(r.log) && !bad)
		bad = err_errno(&e, "%s", options.log);
	step_free(r.step);
	train_order_free(&r.order);
	train_state_free(&r.state);
	training_free(&r.data);
	model_free(&r.model);
	free(r.position);
	free(r.checkpoint);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
