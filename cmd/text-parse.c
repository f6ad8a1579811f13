/* Sentences taken apart: who is meant, and how it stands to what. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/encoders/parser_weights.h"
#include "formats/records/parses.h"
#include "formats/scene/text.h"
#include "lang/parser.h"
#include "lang/rules.h"

#include <omp.h>
#include <stdio.h>

enum { BOTH, GRAMMAR };

static const char *weights, *list;
static int method = BOTH;

static int put_parses(const struct parser *parser, const struct text *t, FILE *out, struct err *e)
{
	for (size_t r = 0; r < t->n; r++) {
		struct parser_vectors v = {.width = t->width};
		SCOPED_BY(parse_free) struct parse p = {0};
		if (t->pieces)
			v = (struct parser_vectors){t->pieces[r], method == BOTH ? text_middle(t, r) : NULL,
				(int)(t->offsets[r + 1] - t->offsets[r]), t->width};
		if (parse_sentence(&p, parser, t->texts[r], &v, e))
			return -1;
		int bad = parses_put(out, t->refs[r], t->texts[r], &p, e);
		if (bad)
			return -1;
	}
	return 0;
}

static const struct cli_option options[] = {
	CLI_TEXT("parser", &weights, "PARSER",
		"weights of the learnt parser (default: those that come with the program)"),
	CLI_ONE_OF("method", &method, "both|grammar",
		"by word vectors and closed-class words, or by closed-class words alone (default both)"),
	CLI_TEXT("without", &list, "RULE,...",
		"leave out rules: isnt, viewer, over_by, corner, doubled, empty, who, compared, from, group, content, one_of, members, companion"),
	{0},
};

static const struct cli_tool tool = {
	.name = "text-parse",
	.operands = "[TEXT]",
	.summary =
		"Take encoded sentences (text.safetensors; stdin by default) apart into parses (JSON Lines).",
	.options = options,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT,
	.max_operands = 1,
};

static int parse_all(
	const struct cli *c, const char *path, struct parser_weights *w, unsigned without, struct err *e)
{
	SCOPED_BY(text_free) struct text t = {0};
	struct parser parser = {.weights = w, .without = without};
	struct file_out out;

	if ((weights ? parser_weights_read(w, weights, e) : parser_weights_default(w, e)) ||
		text_read(&t, path, e))
		return -1;
	parser.encoder = t.encoder.hex;
	const int is_other = *w->encoder && *t.encoder.hex && strcmp(w->encoder, t.encoder.hex);
	if (method == BOTH && (!t.pieces || !t.middle || t.width != w->width || is_other))
		cli_warn(c, "%s: %s: by grammar alone", file_name(path),
			!t.pieces   ? "has no word pieces"
			: !t.middle ? "has no tensor 'middle'"
				    : "of another encoder than the parser's weights");
	return file_out_end(
		&out, file_out_open(&out, c->output, e) || put_parses(&parser, &t, out.stream, e), e);
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(parser_weights_free) struct parser_weights w = {0};
	struct list_name unknown;
	unsigned without;

	(void)to;
	if (rules_without(list, &without, &unknown))
		cli_usage(c, "--without: '%.*s' is no rule", (int)unknown.length, unknown.text);
	cli_refuse_overwrite(c, "TEXT parser", "output", NULL);
	/* a sentence is too little to share among threads */
	omp_set_num_threads(1);
	return parse_all(c, c->operand_count ? c->operands[0] : "-", &w, without, e);
}

CLI_MAIN(tool, run)
