/* refer-locate: where in space the object of a sentence is, and the scene with it for a viewer. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/jobs/anymodel.h"
#include "formats/boxes.h"
#include "formats/ply.h"
#include "formats/scene.h"
#include "formats/splat.h"
#include "formats/text.h"
#include "ask/choose.h"
#include "geom/up.h"
#include "refer/locate.h"

#include <stdlib.h>
#include <string.h>

enum { SPLIT_ALL = 2 };

static struct {
	const char *scene, *text, *model, *refs, *ply, *splat, *viewpoint;
	int sentences, show;
} options = {.sentences = SPLIT_ALL};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"model", 0, CLI_STRING, &options.model, "MODEL", "model of refer-train or refer-lift (required)", 0,
		0},
	{"sentences", 0, CLI_CHOICE, &options.sentences, "train|test|all", "which sentences (default all)", 0,
		0},
	{"refs", 0, CLI_STRING, &options.refs, "REF,...", "these sentences instead of a split", 0, 0},
	{"viewpoint", 0, CLI_STRING, &options.viewpoint, "VIEW|x,y,z",
		"lifted models: where sentences are said (default: the view that a sentence names, else between the training views)",
		0, 0},
	{"ply", 0, CLI_STRING, &options.ply, "FILE",
		"write the scene with the object of the one sentence as a 3DGS .ply", 0, 0},
	{"splat", 0, CLI_STRING, &options.splat, "FILE", "the same as a .splat for web viewers", 0, 0},
	{"show", 0, CLI_CHOICE, &options.show, "coloured|isolated|removed",
		"what --ply and --splat do with the object (default coloured)", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-locate",
	.operands = "--scene SCENE --text TEXT --model MODEL",
	.summary = "Say where in space the objects of sentences are.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT};

struct run {
	struct scene scene;
	struct text text;
	struct anymodel model;
	struct asked asked;
	char *chosen; /* of the sentences: which --refs names */
	size_t count, *refs;
	struct located *located; /* (answers) */
};

static int choose_refs(struct run *r, const struct cli *c, struct err *e)
{
	r->chosen = mem_zalloc(r->text.n, 1, "sentences", e);
	r->refs = mem_alloc(r->text.n, sizeof *r->refs, "sentences", e);
	if (!r->chosen || !r->refs)
		return -1;
	if (options.refs && text_mark(&r->text, options.refs, "--refs", r->chosen, e))
		return -1;
	for (size_t i = 0; i < r->text.n; i++)
		if (options.refs ? r->chosen[i]
				 : options.sentences == SPLIT_ALL ||
					   (int)r->text.splits[i] == options.sentences)
			r->refs[r->count++] = i;
	if ((options.ply || options.splat) && r->count != 1)
		cli_usage(c,
			"--ply and --splat show the object of one sentence, not of %zu: choose it with --refs",
			r->count);
	if (!r->count)
		cli_warn(c, "%s: no sentence in this split", file_name(options.text));
	return 0;
}

static int load(struct run *r, const struct cli *c, struct err *e)
{
	struct viewpoint from;
	double up[3];

	if (scene_read(&r->scene, options.scene, e) || text_read(&r->text, options.text, e) ||
		anymodel_read(&r->model, options.model, e) || choose_refs(r, c, e))
		return -1;
	if (options.viewpoint && viewpoint_read(&from, options.viewpoint, &r->scene.cameras, r->scene.offset))
		cli_usage(c, "--viewpoint: '%s' is no view and no x,y,z", options.viewpoint);
	const struct anymodel_ask ask = {&r->scene, &r->text, options.model, options.scene, options.text,
		r->refs, r->count, 1, CHOOSE_ALL, ASKED_LEAST, options.viewpoint ? &from : NULL};
	if (anymodel_answer(&r->model, &ask, &r->asked, e))
		return -1;
	r->located = mem_zalloc(r->asked.answers, sizeof *r->located, "objects", e);
	if (!r->located)
		return -1;
	cameras_up(&r->scene.cameras, up);
	cli_note(c, 1, "up is %.3f %.3f %.3f", up[0], up[1], up[2]);
	return locate_all(r->located, &r->asked, &r->scene.splats, up, e);
}

static void move(struct box *b, const double by[3])
{
	for (int k = 0; k < 3; k++)
		b->centre[k] += by[k];
}

static int put_sentence(const struct run *r, size_t i, FILE *out, struct err *e)
{
	const struct located *l = &r->located[r->asked.answer[i]];
	const struct extent *x = &l->extent;
	const struct box_gaussians of = {x->n, x->ids};
	double sure = r->asked.sure ? r->asked.sure[i] : l->sure;
	struct box_record record = {r->text.refs[r->refs[i]], (char *)text_object(&r->text, r->refs[i]),
		x->n ? sure : 0, !x->n, x->aligned, x->turned};

	move(&record.aligned, r->scene.offset);
	move(&record.turned, r->scene.offset);
	return boxes_put(out, &record, &of, e);
}

static int write_boxes(const struct run *r, const struct cli *c, struct err *e)
{
	struct file_out out;
	int bad = 0;

	if (file_out_open(&out, c->output, e))
		return -1;
	for (size_t i = 0; i < r->count && !bad; i++)
		bad = put_sentence(r, i, out.stream, e);
	if (!bad)
		return file_out_commit(&out, e);
	file_out_abort(&out);
	return -1;
}

static int write_scene(const struct run *r, struct err *e)
{
	const struct extent *x = &r->located[r->asked.answer[0]].extent;
	struct splats shown;

	if (locate_show(&shown, &r->scene.splats, x, (enum locate_show)options.show, e))
		return -1;
	int bad = (options.ply && ply_write(&shown, r->scene.offset, options.ply, e)) ||
		  (options.splat && splat_write(&shown, options.splat, e));
	splats_free(&shown);
	return bad ? -1 : 0;
}

static void check(const struct cli *c)
{
	if (!options.scene || !options.text || !options.model)
		cli_usage(c, "--scene, --text and --model are required");
	if ((options.ply && !strcmp(options.ply, "-")) || (options.splat && !strcmp(options.splat, "-")))
		cli_usage(c, "--ply and --splat must name a file");
	if (options.show && !options.ply && !options.splat)
		cli_usage(c, "--show is for --ply and --splat");
}

int main(int argc, char **argv)
{
	struct run r = {0};
	struct cli c;
	struct err e = {0};

	cli_parse(&c, &tool, argc, argv);
	check(&c);
	cli_refuse_overwrite(&c, CLI_SCENE " text model", "output ply splat", NULL);
	int bad = load(&r, &c, &e) || ((options.ply || options.splat) && write_scene(&r, &e)) ||
		  write_boxes(&r, &c, &e);
	for (size_t k = 0; r.located && k < r.asked.answers; k++)
		extent_free(&r.located[k].extent);
	free(r.located);
	asked_free(&r.asked);
	anymodel_free(&r.model);
	text_free(&r.text);
	scene_free(&r.scene);
	free(r.chosen);
	free(r.refs);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
