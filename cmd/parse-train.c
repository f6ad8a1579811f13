/* Learns the weights of text-parse from sentences with marks. */
#include "cli/cli.h"
#include "cmd/train/parser_training.h"

static struct parser_training_options o = {
	.epochs = 10, .members = 2, .source = "the marked sentences of refersplat"};
static int is_parses, is_sentences;

static const struct cli_option options[] = {
	CLI_TEXT("text", &o.text, "TEXT", "the sentences of MARKED, encoded"),
	CLI_SWITCH(
		"sentences", &is_sentences, "write the sentences of MARKED (JSON Lines) instead of learning"),
	CLI_SWITCH("parses", &is_parses,
		"write the parses that the marks of MARKED stand for instead of learning"),
	{"epochs", 0, CLI_INT, &o.epochs, "N", "passes over the sentences (default 10)", 1, 1000},
	{"members", 0, CLI_INT, &o.members, "N",
		"networks that learn from other starts; their scores are averaged (default 2)", 1, 8},
	CLI_TEXT("source", &o.source, "TEXT", "what the weights say that they were learnt from"),
	{0},
};

static const struct cli_tool tool = {
	.name = "parse-train",
	.operands = "[MARKED]",
	.summary = "Learn the weights of text-parse from sentences with marks.",
	.options = options,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT | CLI_SEED | CLI_THREADS,
	.max_operands = 1,
};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	if (is_parses && is_sentences)
		cli_usage(c, "--sentences and --parses exclude each other");
	if (is_sentences && o.text)
		cli_usage(c, "--sentences needs no --text");
	if (!is_parses && !is_sentences) {
		if (!o.text)
			cli_usage(c, "--text is needed to learn");
		cli_refuse_terminal(c);
	}
	cli_refuse_overwrite(c, "MARKED text", "output", NULL);
	o.marked = c->operand_count ? c->operands[0] : "-";
	o.output = c->output;
	o.seed = c->seed;
	return is_parses || is_sentences ? parser_marked_write(o.marked, o.text, is_parses, c->output, e)
					 : parser_train(&o, to, e);
}

CLI_MAIN(tool, run)
