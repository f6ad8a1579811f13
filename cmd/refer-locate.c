/* refer-locate: where in space the objects of sentences, or all objects, are, and the scene with them for
 * other programs. */
#include "base/file.h"
#include "cli/cli.h"
#include "cmd/jobs/labelling.h"
#include "cmd/jobs/locating.h"
#include "formats/ply.h"
#include "formats/splat.h"

#include <string.h>

static struct {
	struct request_options request;
	const char *ply, *splat, *each;
	int show, is_all;
} options = {.request = REQUEST_DEFAULTS};

static const struct cli_option table[] = {REQUEST_FILES(options.request), REQUEST_SENTENCES(options.request),
	{"all", 0, CLI_FLAG, &options.is_all, NULL,
		"lifted models: every object, without --text; --ply then has a label for each Gaussian", 0,
		0},
	{"each", 0, CLI_STRING, &options.each, "DIR", "with --all: a .ply of each object alone", 0, 0},
	{"viewpoint", 0, CLI_STRING, &options.request.viewpoint, "VIEW|x,y,z",
		"lifted models: where sentences are said (default: the view that a sentence names, else between the training views)",
		0, 0},
	{"ply", 0, CLI_STRING, &options.ply, "FILE",
		"write the scene with the object of the one sentence as a 3DGS .ply", 0, 0},
	{"splat", 0, CLI_STRING, &options.splat, "FILE", "the same as a .splat for web viewers", 0, 0},
	{"show", 0, CLI_CHOICE, &options.show, "coloured|isolated|removed",
		"what --ply and --splat do with the object (default coloured)", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-locate",
	.operands = "--scene SCENE --model MODEL (--text TEXT | --all)",
	.summary = "Say where in space the objects of sentences are.",
	.options = table,
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
	if (locating_find(r, up, e))
		return -1;
	cli_note(c, 1, "up is %.3f %.3f %.3f", up[0], up[1], up[2]);
	return 0;
}

static int write_boxes(const struct locating *r, const struct cli *c, struct err *e)
{
	const struct request *q = &r->request;
	struct file_out out;
	int bad = 0;

	if (file_out_open(&out, c->output, e))
		return -1;
	for (size_t i = 0; i < q->count && !bad; i++)
		bad = locating_put(r, i, out.stream, e);
	return file_out_end(&out, bad, e);
}

static int write_scene(const struct locating *r, struct err *e)
{
	const struct request *q = &r->request;
	const struct extent *x = &r->answers[q->responses.answer[0]].extent;
	struct splats shown;

	if (locate_show(&shown, &q->scene.splats, x, (enum locate_show)options.show, e))
		return -1;
	int bad = (options.ply && ply_write(&shown, q->scene.offset, options.ply, e)) ||
		  (options.splat && splat_write(&shown, (double[3]){0}, options.splat, e));
	splats_free(&shown);
	return bad ? -1 : 0;
}

static int write_labels(const struct labelling *r, const struct cli *c, struct err *e)
{
	struct file_out out;

	return file_out_open(&out, c->output, e) || file_out_end(&out, labelling_put(r, out.stream, e), e);
}

/* Every object, without sentences. */
static int label(const struct cli *c, struct err *e)
{
	struct labelling r = {0};
	const int bad = labelling_open(&r, options.request.scene, options.request.model, e) ||
			(options.each && labelling_write_each(&r, options.each, e)) ||
			(options.ply && labelling_write_scene(&r, options.ply, e)) || write_labels(&r, c, e);

	labelling_free(&r);
	return bad ? -1 : 0;
}

static void check_all(const struct cli *c)
{
	const struct request_options *o = &options.request;

	if (!options.is_all && options.each)
		cli_usage(c, "--each is for --all");
	if (options.is_all && (o->text || o->refs || o->viewpoint || o->sentences != REQUEST_ALL ||
				      options.splat || options.show))
		cli_usage(
			c, "--all goes with --scene, --model, --ply and --each only: it needs no sentences");
}

static void check(const struct cli *c)
{
	const struct request_options *o = &options.request;

	if (!o->scene || !o->model || (!o->text && !options.is_all))
		cli_usage(c, "--scene, --model and --text (or --all) are required");
	check_all(c);
	if ((options.ply && !strcmp(options.ply, "-")) || (options.splat && !strcmp(options.splat, "-")))
		cli_usage(c, "--ply and --splat must name a file");
	if (options.show && !options.ply && !options.splat)
		cli_usage(c, "--show is for --ply and --splat");
}

static int answer(const struct cli *c, struct err *e)
{
	struct locating r = {0};
	const int bad = locate(&r, c, e) || ((options.ply || options.splat) && write_scene(&r, e)) ||
			write_boxes(&r, c, e);

	locating_free(&r);
	return bad ? -1 : 0;
}

int main(int argc, char **argv)
{
	struct cli c;
	struct err e = {0};

	cli_parse(&c, &tool, argc, argv);
	check(&c);
	cli_refuse_overwrite(&c, CLI_SCENE " text model", "output ply splat each:*.ply", NULL);
	return (options.is_all ? label(&c, &e) : answer(&c, &e)) ? cli_fail(&c, &e) : cli_done(&c);
}
