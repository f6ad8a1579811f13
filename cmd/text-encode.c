/* Sentences to word vectors, by a BERT encoder. */
#include "base/path.h"
#include "cli/cli.h"
#include "cmd/jobs/encode.h"
#include "formats/bert_model.h"

#include <stdio.h>

static int run(const struct cli *c, const char *dir, int is_static, struct err *e)
{
	struct encoding x = {0};
	const struct text *t = &x.text;
	struct cli_report to;
	char options[512];
	int length;
	const char *name = path_last(dir, &length); /* so that bytes do not depend on where a model is */

	snprintf(options, sizeof options, "--model %.*s%s", length, name, is_static ? " --words static" : "");
	int bad = encode(&x, dir, c->operand_count ? c->operands[0] : "-", is_static, cli_report(&to, c), e);
	if (!bad) {
		cli_note(c, 1, "%zu sentences, %lld words of width %d", t->n, (long long)t->offsets[t->n],
			t->width);
		bad = text_write(t, c->output, options, e);
	}
	encoding_free(&x);
	return bad ? -1 : 0;
}

int main(int argc, char **argv)
{
	const char *model = NULL;
	int is_static = 0;
	const struct cli_option options[] = {
		{"model", 0, CLI_STRING, &model, "DIR",
			"the encoder's folder: config.json, a tokenizer and *.safetensors (required)", 0, 0},
		{"words", 0, CLI_CHOICE, &is_static, "contextual|static",
			"as the sentence makes them or the vocabulary has them (default contextual)", 0, 0},
		{0}};
	const struct cli_tool tool = {.name = "text-encode",
		.operands = "[SENTENCES]",
		.summary =
			"Turn sentences (JSON Lines; stdin by default) into word vectors (text.safetensors).",
		.options = options,
		.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
		.max_operands = 1};
	struct err e = {0};
	struct cli c;

	cli_parse(&c, &tool, argc, argv);
	if (!model)
		cli_usage(&c, "--model DIR is required");
	cli_refuse_terminal(&c);
	cli_refuse_overwrite(&c, "SENTENCES model:" BERT_MODEL_PARTS, "output", NULL);
	if (run(&c, model, is_static, &e))
		return cli_fail(&c, &e);
	return cli_done(&c);
}
