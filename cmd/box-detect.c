/* box-detect: photographs to boxes of the things in them. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/masks/detecting.h"
#include "cmd/text/encode.h"
#include "formats/encoders/nanodet_model.h"

static struct detecting options = {.score = 0.05};

static const struct cli_option table[] = {
	CLI_TEXT("model", &options.model, "DIR",
		"folder of the detector's weights (default: where 'make detector' puts them)"),
	CLI_TEXT("scene", &options.scene, "SCENE", "look at the photographs of its views"),
	{"score", 0, CLI_REAL, &options.score, "S", "boxes of at least this score (default 0.05)", 0.01, 1},
	CLI_SWITCH("crops", &options.crops, "look at six parts of each photograph too: small things"), {0}};

static const struct cli_tool tool = {.name = "box-detect",
	.operands = "[PHOTO...]",
	.summary = "Find boxes of everyday things in photographs, with a small network.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.max_operands = -1};

static void check(const struct cli *c)
{
	struct err ignored;
	SCOPED struct cli_file *files =
		mem_zalloc((size_t)c->operand_count + 1, sizeof *files, "files", &ignored);

	if (!options.scene == !c->operand_count)
		cli_usage(c, "either --scene SCENE or photographs");
	for (int i = 0; files && i < c->operand_count; i++) {
		if (!strcmp(c->operands[i], "-"))
			cli_usage(c, "a photograph has a file's name, which is its view's: - has none");
		files[i] = (struct cli_file){"photograph", c->operands[i], CLI_READS, NULL};
	}
	cli_refuse_overwrite(c, "model:" NANODET_MODEL_PARTS " scene:cameras.json", "output", files);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED char *usual = options.model ? NULL : cached_model("detector", e);

	check(c);
	if (!options.model && !(options.model = usual))
		return -1;
	options.pictures = c->operands;
	options.count = (size_t)c->operand_count;
	options.output = c->output;
	return detect(&options, to, e);
}

CLI_MAIN(tool, run)
