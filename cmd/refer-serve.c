/* refer-serve: a lifted scene for a browser and for other programs. */
#include "answer/responses.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/serve/serving.h"

#include <signal.h>

static struct {
	struct serving_options serving;
	const char *address;
	long long port;
	int is_stdio;
} options = {.serving = {.least = RESPONSES_LEAST, .splats = 200000}, .address = "127.0.0.1", .port = 8017};

static const struct cli_option table[] = {
	{"port", 0, CLI_INT, &options.port, "N", "where to listen; 0: a free one (default 8017)", 0, 65535},
	CLI_TEXT("address", &options.address, "ADDRESS",
		"of which interface, as a number (default 127.0.0.1: this machine alone can ask)"),
	CLI_SWITCH("stdio", &options.is_stdio, "instead: answer lines of JSON from stdin on stdout"),
	CLI_TEXT("labels", &options.serving.labels, "FILE",
		"what is named, as mask records (default: RUN/labels.jsonl)"),
	CLI_TEXT("encoder", &options.serving.encoder, "DIR",
		"the encoder's folder (default: where 'make encoder' puts it)"),
	CLI_TEXT("viewer", &options.serving.viewer, "DIR",
		"modules of the viewer (default: where 'make viewer' puts them)"),
	{"min-probability", 0, CLI_REAL, &options.serving.least, "P",
		"a question less likely to mean anything that is here is refused (default 0.5)", 0, 1},
	{"splats", 0, CLI_INT, &options.serving.splats, "N",
		"Gaussians in the viewer at most (default 200000)", 1, 100000000},
	{0}};

static const struct cli_tool tool = {.name = "refer-serve",
	.operands = "RUN",
	.summary = "Serve a scene to a browser: ask, look, and name things by a click.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS,
	.min_operands = 1,
	.max_operands = 1};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	const struct serving_http at = {options.address, (int)options.port};
	SCOPED_BY(serving_close) struct serving s = {0};

	sigset_t ends;

	/* Before there are threads: they are waited for, and whoever is being answered gets the answer. */
	sigemptyset(&ends);
	sigaddset(&ends, SIGINT);
	sigaddset(&ends, SIGTERM);
	if (!options.is_stdio)
		pthread_sigmask(SIG_BLOCK, &ends, NULL);
	options.serving.run = c->operands[0];
	if (options.serving.labels && !strcmp(options.serving.labels, "-"))
		cli_usage(c, "--labels must name a file");
	if (serving_open(&s, &options.serving, to, e))
		return -1;
	return options.is_stdio ? serving_lines(&s, stdout, e) : serving_http(&s, &at, stdout, e);
}

CLI_MAIN(tool, run)
