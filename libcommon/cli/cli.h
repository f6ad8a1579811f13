/* Command lines: one option table a tool, from which parsing, range checks and --help are made. cmd/ only:
 * unlike the rest of the library these functions print, and cli_parse exits on --help, -V and mistakes. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cli/overwrite.h"

#include <stdio.h>

enum cli_type {
	CLI_FLAG,   /* int *, counts how often it was given */
	CLI_STRING, /* const char ** */
	CLI_INT,    /* long long *, whole decimal string within [min,max] */
	CLI_REAL,   /* double *, whole string, finite, within [min,max] */
	CLI_CHOICE, /* int *, the index in `arg`, which reads "first|second|..." */
	CLI_SIZE,   /* int[2], "WxH", each within [min,max] */
};

struct cli_option {
	const char *name; /* long name without dashes; NULL ends a table */
	char letter;	  /* short name or 0 */
	enum cli_type type;
	void *value;
	const char *arg; /* what --help calls the argument; the choices of CLI_CHOICE */
	const char *help;
	double min, max; /* CLI_INT, CLI_REAL, CLI_SIZE; both 0: any */
};

/* Rows of a table, for those that have no short name and no range. */
#define CLI_TEXT(name, value, arg, help)                                                                     \
	{                                                                                                    \
		name, 0, CLI_STRING, value, arg, help, 0, 0                                                  \
	}
#define CLI_SWITCH(name, value, help)                                                                        \
	{                                                                                                    \
		name, 0, CLI_FLAG, value, NULL, help, 0, 0                                                   \
	}
#define CLI_ONE_OF(name, value, choices, help)                                                               \
	{                                                                                                    \
		name, 0, CLI_CHOICE, value, choices, help, 0, 0                                              \
	}

/* Options that every tool may have; a tool names those it honours. -h and -V are always there. */
enum {
	CLI_VERBOSE = 1, /* -v --verbose; -vv is 2 */
	CLI_QUIET = 2,	 /* -q --quiet */
	CLI_THREADS = 4, /* --threads N, 0 (default) is all processors; applied to OpenMP by cli_parse */
	CLI_SEED = 8,	 /* --seed N, default 1 */
	CLI_OUTPUT = 16, /* -o --output FILE, default "-" */
	CLI_JSON = 32,	 /* --json */
};

struct cli_tool {
	const char *name;
	const char *operands; /* as --help shows them: "[CANDIDATES]" */
	const char *summary;  /* one sentence */
	const struct cli_option *options;
	unsigned common;
	int min_operands, max_operands; /* max -1: any number */
	const char *output_arg;		/* what --help calls -o's argument; NULL: FILE */
	int needs_output;		/* -o must be given */
};

struct cli {
	const struct cli_tool *tool;
	int verbose, quiet, json;
	long long threads, seed;
	const char *output;
	const char **operands; /* points into argv */
	int operand_count;
	double start; /* monotonic seconds at cli_parse */
};

/* Parses argv (options and operands in any order, "--" ends options). Prints and exits 0 for -h and -V, 2 for
 * a mistake. Has the signals that end a process remove the temporary files of open outputs before they do. */
void cli_parse(struct cli *c, const struct cli_tool *tool, int argc, char **argv);

/* Prints "tool: message" and "Try 'tool --help'.", and exits 2: for rules that a table cannot state. */
_Noreturn void cli_usage(const struct cli *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints "tool: message"; returns the exit status that belongs to *e. */
int cli_fail(const struct cli *c, const struct err *e);

/* "tool: ..." on stderr, when -v was given at least `level` times. */
void cli_note(const struct cli *c, int level, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* "tool: warning: ..." on stderr, unless -q. */
void cli_warn(const struct cli *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Refuses (exit 2) to write binary data to a terminal, when -o is "-" and stdout is one. */
void cli_refuse_terminal(const struct cli *c);

/* With -v the closing line of wall time and peak memory. Returns 0, for `return cli_done(&c)`. */
int cli_done(const struct cli *c);

/* What a job reports to (base/report.h): these warnings and notes, and progress on stderr (or the descriptor,
 * 3 to 9, in REFERSPLAT_PROGRESS): only on a terminal, not with -q, not in the first second, and at most five
 * times a second. Neither may move while it is used. */
struct cli_report {
	struct report report;
	const struct cli *c;
	const char *what; /* of progress: "views", "iterations" */
	double total, start, last;
	int is_shown;
};
const struct report *cli_report(struct cli_report *r, const struct cli *c);

/* A whole tool: parses, and calls `run`, which checks what a table cannot state, and works. It returns 0, the
 * exit status of a check that was false, or -1 with *e set. Returns the exit status. */
int cli_main(const struct cli_tool *tool, int argc, char **argv,
	int (*run)(const struct cli *c, const struct report *to, struct err *e));

/* The main of a tool that is such a table and such a function. */
#define CLI_MAIN(tool, run)                                                                                  \
	int main(int argc, char **argv)                                                                      \
	{                                                                                                    \
		return cli_main(&(tool), argc, argv, run);                                                   \
	}

/* Monotonic seconds. */
double cli_seconds(void);
