/* refer-locate: where in space the objects of sentences, or all objects, are, and the scene with them for
 * other programs. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/render/locating.h"
#include "cmd/text/questions.h"
#include "formats/splats/anysplats.h"

#include <math.h>

static struct {
	struct request_options request;
	const char *ply, *splat, *each, *encoder;
	int show, is_all, is_track, shows[LOCATE_REMOVED + 1];
	double time;
} options = {.request = REQUEST_DEFAULTS, .time = NAN};

static const struct cli_option table[] = {REQUEST_FILES(options.request), REQUEST_SENTENCES(options.request),
	CLI_SWITCH("all", &options.is_all,
		"lifted models: every object, without --text; --ply then has a label for each Gaussian"),
	CLI_TEXT("each", &options.each, "DIR", "with --all: a .ply of each object alone"),
	{"min-probability", 0, CLI_REAL, &options.request.least, "P",
		"lifted models: a sentence less likely to mean anything means nothing (default 0.5)", 0, 1},
	CLI_TEXT("viewpoint", &options.request.viewpoint, "VIEW|x,y,z",
		"lifted models: where sentences are said (default: the view that a sentence names, else between the training views)"),
	{"time", 0, CLI_REAL, &options.time, "T",
		"of a scene that moves: where things are at this time (default: its first)", 0, 0},
	CLI_SWITCH("track", &options.is_track,
		"of a scene that moves: the box at every stored time of what is meant at --time"),
	CLI_TEXT("ply", &options.ply, "FILE",
		"write the scene with the object of the one sentence as a 3DGS .ply"),
	CLI_TEXT("splat", &options.splat, "FILE", "the same as a .splat for web viewers"),
	CLI_ONE_OF("show", &options.show, "coloured|isolated|removed",
		"what --ply and --splat do with the object (default coloured)"),
	CLI_SWITCH("colour", &options.shows[LOCATE_COLOURED],
		"of RUN, -o is the scene with what QUESTION means painted"),
	CLI_SWITCH("alone", &options.shows[LOCATE_ISOLATED], "or that alone"),
	CLI_SWITCH("remove", &options.shows[LOCATE_REMOVED], "or everything else"),
	CLI_TEXT("encoder", &options.encoder, "DIR",
		"of RUN, the encoder's folder (default: where 'make encoder' puts it)"),
	{0}};

static const struct cli_tool tool = {.name = "refer-locate",
	.operands = "--scene SCENE --model MODEL (--text TEXT | --all) | RUN QUESTION",
	.summary = "Say where in space the objects of sentences are, or show the scene with or without them.",
	.options = table,
	.max_operands = 2,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT};

static int choose_sentences(struct request *q, const struct cli *c, struct err *e)
{
	if (request_choose(q, e))
		return -1;
	if ((options.ply || options.splat) && q->count != 1)
		cli_usage(c,
			"--ply and --splat show the object of one sentence, not of %zu: choose it with --refs",
			q->count);
	if (!q->count)
		cli_warn(c, "%s: no sentence in this split", file_name(options.request.text));
	return 0;
}

static int locate(struct locating *r, const struct cli *c, struct err *e)
{
	const int has_viewpoint = options.request.viewpoint != NULL;
	struct request *q = &r->request;
	struct viewpoint from;
	double up[3];

	if (request_read(q, &options.request, e) || choose_sentences(q, c, e) ||
		(has_viewpoint && request_viewpoint(q, &from, e)) ||
		request_answer(q, has_viewpoint ? &from : NULL, e))
		return -1;
	if (options.is_track)
		return 0;
	if (locating_find(r, up, e))
		return -1;
	cli_note(c, 1, "up is %.3f %.3f %.3f", up[0], up[1], up[2]);
	return 0;
}

/* Every object, without sentences. */
static int label(const struct cli *c, struct err *e)
{
	SCOPED_BY(labelling_free) struct labelling r = {0};

	return -(labelling_open(&r, options.request.scene, options.request.model, e) ||
		 (options.each && labelling_write_each(&r, options.each, e)) ||
		 (options.ply && labelling_write_scene(&r, options.ply, e)) ||
		 labelling_write(&r, c->output, e));
}

static void check_all(const struct cli *c)
{
	const struct request_options *o = &options.request;

	if (!options.is_all && options.each)
		cli_usage(c, "--each is for --all");
	if (options.is_all && (o->text || o->refs || o->viewpoint || o->time || options.is_track ||
				      o->sentences != REQUEST_ALL || options.splat || options.show))
		cli_usage(
			c, "--all goes with --scene, --model, --ply and --each only: it needs no sentences");
}

/* What is done with what the question means. */
static enum locate_show check_run(const struct cli *c)
{
	const int *k = options.shows, count = k[0] + k[1] + k[2];

	if (c->operand_count < 2 || count != 1)
		cli_usage(c, "RUN goes with a QUESTION and one of --colour, --alone and --remove");
	if (options.request.text || options.is_all || options.ply || options.splat || options.show ||
		options.request.refs || options.request.sentences != REQUEST_ALL || options.each ||
		options.is_track)
		cli_usage(c,
			"RUN QUESTION goes with --scene, --model, --encoder, --viewpoint, --time and -o only: it needs no sentences");
	if (anysplats_format_of(c->output) < 0)
		cli_usage(c, "-o %s: not .ply, .splat, .spz, .glb or .sog: it is for the scene", c->output);
	cli_refuse_overwrite(c, CLI_SCENE " model encoder:" ENCODER_PARTS " RUN:scene|lifted|*.safetensors",
		"output", NULL);
	return (enum locate_show)(k[LOCATE_ISOLATED] + 2 * k[LOCATE_REMOVED]);
}

static int show(const struct cli *c, const struct report *to, struct err *e)
{
	const struct request_options *o = &options.request;
	const enum locate_show how = check_run(c);
	const struct asking_options ask = {.run = c->operands[0],
		.given = {.scene = (char *)o->scene,
			.model = (char *)o->model,
			.encoder = (char *)options.encoder},
		.viewpoint = o->viewpoint,
		.least = o->least,
		.time = o->time};
	struct question q = {0};

	if (!question_take(&q, c->operands[1]))
		return err_set(e, ERR_FORMAT, "the question %s", q.fault);
	return showing_ask(&ask, q.text, how, c->output, stdout, to, e);
}

static void check(const struct cli *c)
{
	const struct request_options *o = &options.request;

	if (options.shows[0] || options.shows[1] || options.shows[2] || options.encoder)
		cli_usage(c, "--colour, --alone, --remove and --encoder are for RUN QUESTION");
	if (!o->scene || !o->model || (!o->text && !options.is_all))
		cli_usage(c, "--scene, --model and --text (or --all) are required");
	check_all(c);
	if ((options.ply && !strcmp(options.ply, "-")) || (options.splat && !strcmp(options.splat, "-")))
		cli_usage(c, "--ply and --splat must name a file");
	if (options.is_track && (options.ply || options.splat))
		cli_usage(c, "--track is for boxes: --ply and --splat are of one --time");
	if (options.show && !options.ply && !options.splat)
		cli_usage(c, "--show is for --ply and --splat");
	cli_refuse_overwrite(c, CLI_SCENE " text model", "output ply splat each:*.ply", NULL);
}

static int answer(const struct cli *c, struct err *e)
{
	SCOPED_BY(locating_free) struct locating r = {0};

	return -(locate(&r, c, e) ||
		 ((options.ply || options.splat) &&
			 showing_write(&r, (enum locate_show)options.show, options.ply, options.splat, e)) ||
		 (options.is_track ? locating_track(&r, c->output, e) : locating_write(&r, c->output, e)));
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	options.request.time = isnan(options.time) ? NULL : &options.time;
	if (c->operand_count)
		return show(c, to, e);
	check(c);
	return options.is_all ? label(c, e) : answer(c, e);
}

CLI_MAIN(tool, run)
