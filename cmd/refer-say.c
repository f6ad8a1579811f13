/* refer-say: sentences that a lifted scene writes of itself, for refer-train to learn from. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/ask/saying.h"

static struct asking_options asking;
static struct saying_options saying = {.each = 200, .least = 0.6};

static const struct cli_option table[] = {
	CLI_TEXT("scene", &asking.given.scene, "SCENE", "scene folder (default: RUN/scene)"),
	CLI_TEXT("model", &asking.given.model, "MODEL",
		"model of refer-lift (default: RUN/lifted/model.safetensors)"),
	CLI_TEXT("encoder", &asking.given.encoder, "DIR",
		"the encoder's folder (default: where 'make encoder' puts it)"),
	{"each", 0, CLI_INT, &saying.each, "N", "sentences of each thing (default 200)", 1, 100000},
	{"absent", 0, CLI_INT, &saying.absent, "N", "sentences of what is not there (default 0)", 0, 100000},
	{"min-probability", 0, CLI_REAL, &saying.least, "P",
		"how sure the lifted model has to be of what a sentence means (default 0.6)", 0, 1},
	{0}};

static const struct cli_tool tool = {.name = "refer-say",
	.operands = "RUN",
	.summary = "Write sentences about the things of a lifted scene, to train with.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_SEED | CLI_OUTPUT,
	.min_operands = 1,
	.max_operands = 1};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(asking_close) struct asking a = {0};
	size_t short_of;

	asking.run = c->operands[0];
	saying.output = c->output;
	saying.seed = (uint64_t)c->seed;
	cli_refuse_overwrite(c, CLI_SCENE " model encoder:" ENCODER_PARTS " RUN:scene|lifted|*.safetensors",
		"output", NULL);
	if (asking_open(&a, &asking, e) || say(&a, &saying, to, &short_of, e))
		return -1;
	if (short_of)
		cli_warn(c, "%zu sentences too few: some things can hardly be told from others", short_of);
	return 0;
}

CLI_MAIN(tool, run)
