/* mask-import: photographs that a person painted over or labelled, as mask records. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/masks/painting.h"
#include "formats/records/foreign.h"

static const char *names_path, *undistort;

static const struct cli_option table[] = {
	CLI_TEXT("names", &names_path, "NAMES",
		"text, a line for each thing: its colour #rrggbb, or its grey or number, 0 to 65535, and its name (needed for pictures)"),
	CLI_TEXT("undistort", &undistort, "SCENE",
		"make masks of photographs whose lens distorts masks of the views of SCENE, of gs-import --undistort"),
	{0}};

static const struct cli_tool tool = {.name = "mask-import",
	.operands = "PICTURE|LABELS|MASKS|FOLDER...",
	.summary =
		"Turn photographs that a person painted over, or labelled with LabelMe or for COCO, into masks.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT,
	.min_operands = 1,
	.max_operands = -1};

/* No picture and no file of names is written over. */
static void check(const struct cli *c)
{
	struct err ignored;
	SCOPED struct cli_file *files =
		mem_zalloc((size_t)c->operand_count + 1, sizeof *files, "files", &ignored);

	for (int i = 0; i < c->operand_count && !names_path; i++)
		if (painting_needs_names(c->operands[i]))
			cli_usage(c, "--names NAMES is required for pictures, which %s is", c->operands[i]);
	for (int i = 0; files && i < c->operand_count; i++)
		files[i] = (struct cli_file){"picture", c->operands[i], CLI_READS, NULL};
	cli_refuse_overwrite(c, "names undistort:cameras.json", "output", files);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(painting_names_free) struct painting_names names = {0};
	SCOPED_BY(warping_free) struct warping warping = {0};

	for (int i = 0; i < c->operand_count; i++)
		if (painting_needs_names(c->operands[i]) &&
			foreign_file(c->operands[i], FOREIGN_MASKS, "", 0, e))
			return -1;
	check(c);
	return -((names_path && painting_names_read(&names, names_path, e)) ||
		 warping_open(&warping, undistort ? WARP_TO_VIEW : WARP_NONE, undistort, e) ||
		 painting_write(&names, c->operands, (size_t)c->operand_count, &warping, c->output, to, e));
}

CLI_MAIN(tool, run)
