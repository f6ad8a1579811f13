/* refer-lift: objects lifted onto the Gaussians from their masks, in closed form. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/lift/left_out.h"
#include "cmd/lift/lifting.h"
#include "formats/cameras/dataparser.h"
#include "formats/scene/lifted.h"

static struct {
	struct lifting_files files;
	int is_as_masked;
} options;

static const struct cli_option table[] = {
	CLI_TEXT("scene", &options.files.scene, "SCENE", "scene folder of gs-import (required)"),
	CLI_TEXT("weights", &options.files.weights, "WEIGHTS",
		"folder of gs-weigh (required, but with --regions)"),
	CLI_TEXT("text", &options.files.text, "TEXT", "sentences encoded by text-encode (required)"),
	CLI_TEXT("masks", &options.files.masks, "MASKS",
		"masks of pseudomask-select (required, but with --regions)"),
	CLI_TEXT("regions", &options.files.regions, "FILE",
		"in place of masks: regions of pseudomask-propose, which the sentences name, all together"),
	CLI_TEXT("spare", &options.files.spare, "FILE",
		"masks of regions that an object may have instead, of pseudomask-select --spare; not looked at with --names masks"),
	CLI_ONE_OF("names", &options.is_as_masked, "sentences|masks",
		"which of several alike an object is: as sentences say, where its masks have scores (default), or as masks do"),
	{0}};

static const struct cli_tool tool = {.name = "refer-lift",
	.operands = "--scene SCENE --weights WEIGHTS --text TEXT --masks MASKS",
	.summary = "Lift the objects that sentences name onto the Gaussians of a scene, from their masks.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.output_arg = "MODEL"};

static int lift(struct lifting *l, const struct cli *c, const struct report *to, struct err *e)
{
	const struct lifted *model = &l->model;
	double confidence = 0;
	size_t moved;

	if (lifting_read(l, &options.files, to, e))
		return -1;
	const struct origin origin = {l->scene.fingerprint, l->text.encoder};
	if (options.files.regions)
		return lifting_name(l, to, e) || lifted_write(model, &origin, c->output, "--regions", e) ? -1
													 : 0;
	if (lifting_make(l, options.is_as_masked, &moved, to, e))
		return -1;
	for (size_t o = 0; o < model->objects; o++)
		confidence += (double)model->confidence[o] / (double)model->objects;
	cli_note(c, 1,
		"%zu objects, %lld Gaussians with a share in one; agreement of the masks %.3f; %zu changed places",
		model->objects, (long long)model->indptr[model->objects], confidence, moved);
	if (left_out_check(&l->lift, model->objects, options.files.masks, options.files.scene, to, e))
		return -1;
	if (model->objects && !memchr(l->is_fixed, 1, model->objects) && confidence < LIFT_AGREEMENT_LEAST)
		cli_warn(c,
			"%s: the masks agree by %.2f with what was lifted of them, at least %.2g is right: are the cameras of %s those that its splats were trained with, and in their frame? " DATAPARSER_WAY_OUT,
			file_name(options.files.masks), confidence, LIFT_AGREEMENT_LEAST,
			options.files.scene);
	return lifted_write(
		model, &origin, c->output, options.is_as_masked ? "--names masks" : "--names sentences", e);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	const struct lifting_files *f = &options.files;
	SCOPED_BY(lifting_free) struct lifting l = {0};

	if (!f->scene || !f->text || (!f->regions && (!f->weights || !f->masks)))
		cli_usage(c, "--scene, --weights, --text and --masks are required");
	if (f->regions && (f->weights || f->masks || f->spare || options.is_as_masked))
		cli_usage(c, "--regions are in place of --weights, --masks, --spare and --names masks");
	cli_refuse_overwrite(c, CLI_SCENE " " CLI_WEIGHTS " text masks spare regions", "output", NULL);
	cli_refuse_terminal(c);
	if (options.is_as_masked)
		options.files.spare = NULL;
	return lift(&l, c, to, e);
}

CLI_MAIN(tool, run)
