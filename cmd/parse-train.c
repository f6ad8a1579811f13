/* Learns the weights of text-parse: from the project's own example sentences, and readings of others if
 * given. */
#include "cli/cli.h"
#include "cmd/train/parser_lessons.h"
#include "cmd/train/parser_training.h"

int main(int argc, char **argv)
{
	struct parser_training_options o = {
		.epochs = 5, .rounds = 2, .members = 2, .source = "the example sentences of refersplat"};
	long long write = 0;
	int is_test = 0, is_parses = 0, is_sentences = 0;
	const struct cli_option options[] = {
		{"write", 0, CLI_INT, &write, "N",
			"write N example sentences (JSON Lines) instead of learning", 0, 1e6},
		{"test", 0, CLI_FLAG, &is_test, NULL,
			"with --write: sentences in the wordings kept for testing", 0, 0},
		{"marked", 0, CLI_STRING, &o.marked, "MARKED", "learn from sentences with marks too", 0, 0},
		{"marked-text", 0, CLI_STRING, &o.marked_text, "TEXT", "these sentences, encoded", 0, 0},
		{"sentences", 0, CLI_FLAG, &is_sentences, NULL,
			"write the sentences of MARKED (JSON Lines) instead of learning", 0, 0},
		{"parses", 0, CLI_FLAG, &is_parses, NULL,
			"write the parses that the marks of MARKED stand for instead of learning", 0, 0},
		{"readings", 0, CLI_STRING, &o.readings, "READINGS",
			"learn from these readings too (JSON Lines)", 0, 0},
		{"readings-text", 0, CLI_STRING, &o.readings_text, "TEXT", "their encoded sentences", 0, 0},
		{"epochs", 0, CLI_INT, &o.epochs, "N", "passes over the examples (default 5)", 1, 1000},
		{"rounds", 0, CLI_INT, &o.rounds, "N", "rounds with the readings (default 2)", 0, 100},
		{"members", 0, CLI_INT, &o.members, "N",
			"networks that learn from other starts; their scores are averaged (default 2)", 1, 8},
		{"folds", 0, CLI_INT, &o.folds, "N",
			"cross-validate: write parses of the readings' sentences, each by weights that saw no sentence of its room",
			0, 100},
		{"no-grammar", 0, CLI_FLAG, &o.is_blind, NULL,
			"with --folds: the network is not told what the grammar says, for comparison", 0, 0},
		{"source", 0, CLI_STRING, &o.source, "TEXT",
			"what the weights say that they were learnt from", 0, 0},
		{0},
	};
	const struct cli_tool tool = {
		.name = "parse-train",
		.operands = "[TEXT]",
		.summary = "Learn the weights of text-parse from encoded example sentences.",
		.options = options,
		.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT | CLI_SEED | CLI_THREADS,
		.max_operands = 1,
	};
	struct err e = {0};
	struct cli_report to;
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	if (!o.readings != !o.readings_text)
		cli_usage(&c, "--readings and --readings-text go together");
	if (o.folds && !o.readings)
		cli_usage(&c, "--folds needs --readings");
	if (o.is_blind && !o.folds)
		cli_usage(&c, "--no-grammar needs --folds");
	if (is_parses || is_sentences) {
		if (!o.marked || write || c.operand_count || is_parses + is_sentences > 1)
			cli_usage(&c, "--sentences and --parses go with --marked alone");
	} else if (!o.marked != !o.marked_text)
		cli_usage(&c, "--marked and --marked-text go together");
	if (!write && !o.folds && !is_parses && !is_sentences)
		cli_refuse_terminal(&c);
	cli_refuse_overwrite(
		&c, write ? "" : "TEXT marked marked-text readings readings-text", "output", NULL);
	o.examples = c.operand_count ? c.operands[0] : "-";
	o.output = c.output;
	o.seed = c.seed;
	int bad = write ? parser_examples_write(c.output, write, is_test, c.seed, &e)
		  : is_parses || is_sentences
			  ? parser_marked_write(o.marked, o.marked_text, is_parses, c.output, &e)
			  : parser_train(&o, cli_report(&to, &c), &e);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
