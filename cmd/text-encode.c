/* Sentences to word vectors, by a BERT or CLIP's text tower. */
#include "base/mem.h"
#include "base/path.h"
#include "cli/cli.h"
#include "cmd/text/encode.h"

#include <stdio.h>

static struct {
	const char *model;
	int is_static, is_of_masks;
} options;

static const struct cli_option table[] = {
	CLI_TEXT("model", &options.model, "DIR",
		"the encoder's folder: config.json, a tokenizer and *.safetensors (default: where 'make encoder' puts it)"),
	CLI_ONE_OF("words", &options.is_static, "contextual|static",
		"as the sentence makes them or the vocabulary has them (default contextual)"),
	CLI_SWITCH("names", &options.is_of_masks,
		"the input is mask records: encode the names of their objects, as training sentences"),
	{0}};

static const struct cli_tool tool = {.name = "text-encode",
	.operands = "[SENTENCES]",
	.summary =
		"Turn sentences (JSON Lines, or one a line; stdin by default) into word vectors (text.safetensors).",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.max_operands = 1};

static int encode_all(
	const struct cli *c, struct encoding *x, struct encoder *with, const struct report *to, struct err *e)
{
	const struct text *t = &x->text;
	char record[512];
	int length;
	const char *name =
		path_last(options.model, &length); /* so that bytes do not depend on where a model is */

	snprintf(record, sizeof record, "--model %.*s%s", length, name,
		options.is_static ? " --words static" : "");
	if (encoding_read(x, c->operand_count ? c->operands[0] : "-", options.is_of_masks, e) ||
		encoder_read(with, options.model, options.is_static, e) || encode(x, with, to, e))
		return -1;
	cli_note(c, 1, "%zu sentences, %lld words of width %d", t->n, (long long)t->offsets[t->n], t->width);
	return text_write(t, c->output, record, e);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(encoding_free) struct encoding x = {0};
	SCOPED_BY(encoder_free) struct encoder with = {0};
	SCOPED char *usual = options.model ? NULL : cached_model("encoder", e);

	if (!options.model && !(options.model = usual))
		return -1;
	cli_refuse_terminal(c);
	cli_refuse_overwrite(c, "SENTENCES model:" ENCODER_PARTS, "output", NULL);
	return encode_all(c, &x, &with, to, e);
}

CLI_MAIN(tool, run)
