/* Command lines. cli_parse exits on mistakes, so each is tried in a child process. */
#include "unit.h"

#include "cli/cli.h"

#include <sys/wait.h>
#include <unistd.h>

static int flag, choice, size[2];
static long long whole, wide;
static double real;
static const char *text;

static const struct cli_option options[] = {
	{"flag", 'f', CLI_FLAG, &flag, NULL, "a flag", 0, 0},
	{"whole", 'w', CLI_INT, &whole, "N", "a whole number", -5, 100},
	{"wide", 0, CLI_INT, &wide, "N", "any whole number", 0, 0},
	{"real", 'r', CLI_REAL, &real, "X", "a number", 0, 1},
	{"choice", 0, CLI_CHOICE, &choice, "one|two|two-and-a-half", "a choice", 0, 0},
	{"size", 0, CLI_SIZE, size, "WxH", "a size", 1, 65536},
	{"text", 't', CLI_STRING, &text, "TEXT", "a text", 0, 0},
	{0},
};
static const struct cli_tool tool = {
	.name = "tool",
	.operands = "[FILE]...",
	.summary = "Does nothing.",
	.options = options,
	.common = CLI_VERBOSE | CLI_SEED | CLI_OUTPUT,
	.max_operands = 2,
};

/* Parses "tool" and the words of `line` in a child; returns its status and what it wrote, to stdout and
 * stderr, in `said`. A line that parses prints the values and exits 0. */
static int parse(const char *line, char said[2048])
{
	char words[512], *argv[32] = {"tool"};
	int argc = 1, ends[2], status;

	snprintf(words, sizeof words, "%s", line);
	for (char *w = strtok(words, " "); w; w = strtok(NULL, " "))
		argv[argc++] = strcmp(w, "''") ? w : (w[0] = 0, w);
	fflush(NULL);
	if (pipe(ends))
		return -1;
	pid_t child = fork();
	if (!child) {
		struct cli c;
		dup2(ends[1], 1);
		dup2(ends[1], 2);
		cli_parse(&c, &tool, argc, argv);
		printf("%d %lld %lld %g %d %dx%d %s v%d s%lld %s", flag, whole, wide, real, choice, size[0],
			size[1], text ? text : "-", c.verbose, c.seed, c.output);
		for (int i = 0; i < c.operand_count; i++)
			printf(" [%s]", c.operands[i]);
		fflush(stdout);
		_exit(0);
	}
	close(ends[1]);
	size_t used = 0;
	ssize_t got;
	while ((got = read(ends[0], said + used, 2047 - used)) > 0)
		used += (size_t)got;
	said[used] = 0;
	close(ends[0]);
	waitpid(child, &status, 0);
	return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void good_lines(void)
{
	static const char *const rows[][2] = {
		{"", "0 0 0 0 0 0x0 - v0 s1 -"},
		{"--flag --whole 7 --real 0.5 --choice two --size 3x4 --text x", "1 7 0 0.5 1 3x4 x v0 s1 -"},
		{"-f -w7 -r .5 -t x -o out", "1 7 0 0.5 0 0x0 x v0 s1 out"},
		{"-fw7", "1 7 0 0 0 0x0 - v0 s1 -"},
		{"-fw -5", "1 -5 0 0 0 0x0 - v0 s1 -"},
		{"--whole=+3 --real=1e-1 --choice=two-and-a-half", "0 3 0 0.1 2 0x0 - v0 s1 -"},
		{"--whole 1 --whole 2", "0 2 0 0 0 0x0 - v0 s1 -"},
		{"--wide 9223372036854775807", "0 0 9223372036854775807 0 0 0x0 - v0 s1 -"},
		{"-vv --verbose --seed 4294967295", "0 0 0 0 0 0x0 - v3 s4294967295 -"},
		{"a -f b", "1 0 0 0 0 0x0 - v0 s1 - [a] [b]"},
		{"- -f", "1 0 0 0 0 0x0 - v0 s1 - [-]"},
		{"-- -f --", "0 0 0 0 0 0x0 - v0 s1 - [-f] [--]"},
		{"--text= -t -f", "0 0 0 0 0 0x0 -f v0 s1 -"},
		{"--text --flag ''", "0 0 0 0 0 0x0 --flag v0 s1 - []"},
		{"--size 65536x1", "0 0 0 0 0 65536x1 - v0 s1 -"},
	};
	char said[2048];

	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		int status = parse(rows[i][0], said);
		CHECK(status == 0 && !strcmp(said, rows[i][1]), "'%s' gives %d '%s'", rows[i][0], status,
			said);
	}
}

static void bad_lines(void)
{
	static const char *const rows[][2] = {
		{"--whole", "--whole needs an argument"},
		{"-fw", "-w needs an argument"},
		{"--flag=1", "--flag takes no argument"},
		{"--fla", "unknown option '--fla'"},
		{"--wholes 1", "unknown option '--wholes'"},
		{"--=1", "unknown option '--'"},
		{"-fx", "unknown option '-x'"},
		{"-q", "unknown option '-q'"},
		{"--whole 101", "--whole: '101' is not a whole number from -5 to 100"},
		{"--whole -6", "--whole: '-6' is not a whole number from -5 to 100"},
		{"--whole 1.5", "--whole: '1.5' is not a whole number from -5 to 100"},
		{"--whole 1e1", "--whole: '1e1' is not a whole number from -5 to 100"},
		{"--whole 0x1", "--whole: '0x1' is not a whole number from -5 to 100"},
		{"--whole ''", "--whole: '' is not a whole number from -5 to 100"},
		{"--whole=\t1", "--whole: '\t1' is not a whole number from -5 to 100"},
		{"--whole -", "--whole: '-' is not a whole number from -5 to 100"},
		{"--wide 9223372036854775808", "--wide: '9223372036854775808' is not a whole number"},
		{"--wide x", "--wide: 'x' is not a whole number"},
		{"--real 1.01", "--real: '1.01' is not a number from 0 to 1"},
		{"--real nan", "--real: 'nan' is not a number from 0 to 1"},
		{"--real inf", "--real: 'inf' is not a number from 0 to 1"},
		{"--real 0x1p-1", "--real: '0x1p-1' is not a number from 0 to 1"},
		{"--real 0.5x", "--real: '0.5x' is not a number from 0 to 1"},
		{"--real 1e", "--real: '1e' is not a number from 0 to 1"},
		{"--choice tw", "--choice: 'tw' is not one of one|two|two-and-a-half"},
		{"--choice one|two", "--choice: 'one|two' is not one of one|two|two-and-a-half"},
		{"--choice ''", "--choice: '' is not one of one|two|two-and-a-half"},
		{"--size 3", "--size: '3' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 3x", "--size: '3x' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size x3", "--size: 'x3' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 3x4x", "--size: '3x4x' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 3x-4", "--size: '3x-4' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 0x4", "--size: '0x4' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 3x65537", "--size: '3x65537' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--size 99999999999999999999x1",
			"--size: '99999999999999999999x1' is not WIDTHxHEIGHT with both from 1 to 65536"},
		{"--seed -1", "--seed: '-1' is not a whole number from 0 to 4294967295"},
		{"a b c", "unexpected operand 'c'"},
	};
	char said[2048], expected[512];

	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		int status = parse(rows[i][0], said);
		snprintf(expected, sizeof expected, "tool: %s\nTry 'tool --help'.\n", rows[i][1]);
		CHECK(status == 2 && !strcmp(said, expected), "'%s' gives %d '%s'", rows[i][0], status, said);
	}
}

static void help(void)
{
	char said[2048], again[2048];

	CHECK(parse("--help", said) == 0 && parse("-fh", again) == 0 && !strcmp(said, again), "%s", again);
	CHECK(!strncmp(said, "Usage: tool [OPTION]... [FILE]...\nDoes nothing.\n\n", 48), "%s", said);
	CHECK(strstr(said, "\n  -w, --whole N                 a whole number\n") != NULL, "%s", said);
	CHECK(strstr(said, "\n      --choice one|two|two-and-a-half\n") != NULL, "%s", said);
	CHECK(parse("--version", said) == 0 && !strncmp(said, "tool (refersplat) ", 18), "%s", said);
}

int main(void)
{
	good_lines();
	bad_lines();
	help();
	return unit_end();
}
