#include "cli/cli.h"

#include "cli/signals.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#ifndef VERSION
#define VERSION "unknown"
#endif

enum { COMMON_COUNT = 8, MOST_ROWS = 64, HELP_COLUMN = 32 };

/* Every option of a tool in the order of --help: its own, the shared ones, and at last help and version,
 * which are taken before others are looked for. */
struct options {
	struct cli_option common[COMMON_COUNT];
	const struct cli_option *rows[MOST_ROWS];
	size_t n, found; /* found: without the last two */
};

/* The shared options that this tool honours, as rows of the same kind as its own. */
static int common_rows(struct cli *c, struct cli_option rows[COMMON_COUNT])
{
	unsigned common = c->tool->common;
	const char *output_arg = c->tool->output_arg ? c->tool->output_arg : "FILE";
	int n = 0;

	if (common & CLI_OUTPUT)
		rows[n++] = (struct cli_option){"output", 'o', CLI_STRING, &c->output, output_arg,
			c->tool->needs_output ? "where to write (required)"
					      : "where to write; - is stdout (default)",
			0, 0};
	if (common & CLI_JSON)
		rows[n++] = (struct cli_option){
			"json", 0, CLI_FLAG, &c->json, NULL, "print JSON instead of text", 0, 0};
	if (common & CLI_SEED)
		rows[n++] = (struct cli_option){"seed", 0, CLI_INT, &c->seed, "N",
			"seed of the random numbers (default 1)", 0, 4294967295.0};
	if (common & CLI_THREADS)
		rows[n++] = (struct cli_option){"threads", 0, CLI_INT, &c->threads, "N",
			"threads to use; 0 (default): every processor; results do not depend on it", 0, 1024};
	if (common & CLI_VERBOSE)
		rows[n++] = (struct cli_option){"verbose", 'v', CLI_FLAG, &c->verbose, NULL,
			"say more, and time and memory at the end", 0, 0};
	if (common & CLI_QUIET)
		rows[n++] = (struct cli_option){
			"quiet", 'q', CLI_FLAG, &c->quiet, NULL, "no progress and no warnings", 0, 0};
	rows[n++] = (struct cli_option){"help", 'h', CLI_FLAG, NULL, NULL, "print this help", 0, 0};
	rows[n++] = (struct cli_option){"version", 'V', CLI_FLAG, NULL, NULL, "print the version", 0, 0};
	return n;
}

static void list_options(struct options *all, struct cli *c)
{
	const int n = common_rows(c, all->common);

	all->n = 0;
	for (const struct cli_option *o = c->tool->options; o && o->name && all->n + COMMON_COUNT < MOST_ROWS;
		o++)
		all->rows[all->n++] = o;
	for (int i = 0; i < n; i++)
		all->rows[all->n++] = &all->common[i];
	all->found = all->n - 2;
}

/* Words after a margin of HELP_COLUMN columns, broken before column 100. */
static void print_wrapped(const char *text, int column)
{
	while (*text) {
		int len = (int)strcspn(text, " ");
		if (column + 1 + len > 100 && column > HELP_COLUMN)
			column = printf("\n%*s", HELP_COLUMN, "") - 1;
		column += printf("%s%.*s", column > HELP_COLUMN ? " " : "", len, text);
		text += len + (text[len] == ' ');
	}
	printf("\n");
}

static void print_row(const struct cli_option *o)
{
	int used = o->letter ? printf("  -%c, --%s", o->letter, o->name) : printf("      --%s", o->name);

	if (o->arg)
		used += printf(" %s", o->arg);
	if (used + 2 > HELP_COLUMN) {
		printf("\n");
		used = 0;
	}
	printf("%*s", HELP_COLUMN - used, "");
	print_wrapped(o->help, HELP_COLUMN);
}

static void print_help(const struct cli *c, const struct options *all)
{
	printf("Usage: %s [OPTION]... %s\n%s\n\n", c->tool->name, c->tool->operands, c->tool->summary);
	for (size_t i = 0; i < all->n; i++)
		print_row(all->rows[i]);
}

static void print_line(const struct cli *c, const char *before, const char *format, va_list ap)
{
	fprintf(stderr, "%s: %s", c->tool->name, before);
	vfprintf(stderr, format, ap);
	fputc('\n', stderr);
}

_Noreturn void cli_usage(const struct cli *c, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	print_line(c, "", format, ap);
	va_end(ap);
	fprintf(stderr, "Try '%s --help'.\n", c->tool->name);
	exit(ERR_USAGE);
}

static int in_range(const struct cli_option *o, double x)
{
	return (o->min == 0 && o->max == 0) || (x >= o->min && x <= o->max);
}

static void set_choice(const struct cli *c, const struct cli_option *o, const char *text)
{
	const char *p = o->arg;

	for (int i = 0; *p; i++) {
		size_t len = strcspn(p, "|");
		if (strlen(text) == len && !strncmp(p, text, len)) {
			*(int *)o->value = i;
			return;
		}
		p += len + (p[len] == '|');
	}
	cli_usage(c, "--%s: '%s' is not one of %s", o->name, text, o->arg);
}

static void set_size(const struct cli *c, const struct cli_option *o, const char *text)
{
	const char *at = text;

	for (int i = 0; i < 2; i++) {
		char *end;
		long side = strtol(at, &end, 10);
		if (*at < '0' || *at > '9' || *end != (i ? 0 : 'x') || side > INT_MAX ||
			!in_range(o, (double)side))
			cli_usage(c, "--%s: '%s' is not WIDTHxHEIGHT with both from %.0f to %.0f", o->name,
				text, o->min, o->max);
		((int *)o->value)[i] = (int)side;
		at = end + 1;
	}
}

/* Digits and `others` after an optional sign: no blanks, hexadecimal, nan or inf, as strtod takes. */
static int is_number(const char *text, const char *others)
{
	text += *text == '-' || *text == '+';
	for (const char *p = text; *p; p++)
		if ((*p < '0' || *p > '9') && !strchr(others, *p))
			return 0;
	return *text != 0;
}

static _Noreturn void refuse_number(
	const struct cli *c, const struct cli_option *o, const char *kind, const char *text)
{
	if (o->min == 0 && o->max == 0)
		cli_usage(c, "--%s: '%s' is not %s", o->name, text, kind);
	cli_usage(c, "--%s: '%s' is not %s from %.10g to %.10g", o->name, text, kind, o->min, o->max);
}

static void set_value(const struct cli *c, const struct cli_option *o, const char *text)
{
	char *end;

	errno = 0;
	switch (o->type) {
	case CLI_STRING:
		*(const char **)o->value = text;
		return;
	case CLI_INT: {
		long long x = strtoll(text, &end, 10);
		if (!is_number(text, "") || *end || errno || !in_range(o, (double)x))
			refuse_number(c, o, "a whole number", text);
		*(long long *)o->value = x;
		return;
	}
	case CLI_REAL: {
		double x = strtod(text, &end);
		if (!is_number(text, ".eE+-") || *end || !isfinite(x) || !in_range(o, x))
			refuse_number(c, o, "a number", text);
		*(double *)o->value = x;
		return;
	}
	case CLI_CHOICE:
		set_choice(c, o, text);
		return;
	case CLI_SIZE:
		set_size(c, o, text);
		return;
	case CLI_FLAG:
		*(int *)o->value += 1;
		return;
	}
}

static const struct cli_option *find_row(const struct options *all, const char *name, size_t len, char letter)
{
	for (size_t i = 0; i < all->found; i++) {
		const struct cli_option *o = all->rows[i];
		if (letter ? o->letter == letter : (strlen(o->name) == len && !strncmp(o->name, name, len)))
			return o;
	}
	return NULL;
}

static void check_help(const struct cli *c, const struct options *all, int is_help, int is_version)
{
	if (is_help)
		print_help(c, all);
	else if (is_version)
		printf("%s (refersplat) %s\n", c->tool->name, VERSION);
	else
		return;
	if (!fflush(stdout) && !ferror(stdout))
		exit(0);
	fprintf(stderr, "%s: stdout: %s\n", c->tool->name, strerror(errno));
	exit(ERR_SYSTEM);
}

static void parse_long(const struct cli *c, const struct options *all, char **argv, int argc, int *i)
{
	const char *name = argv[*i] + 2, *equals = strchr(name, '=');
	size_t len = equals ? (size_t)(equals - name) : strlen(name);

	check_help(c, all, !strcmp(name, "help"), !strcmp(name, "version"));
	const struct cli_option *o = find_row(all, name, len, 0);
	if (!o)
		cli_usage(c, "unknown option '--%.*s'", (int)len, name);
	if (o->type == CLI_FLAG) {
		if (equals)
			cli_usage(c, "--%s takes no argument", o->name);
		set_value(c, o, "");
	} else if (equals) {
		set_value(c, o, equals + 1);
	} else {
		if (++*i >= argc)
			cli_usage(c, "--%s needs an argument", o->name);
		set_value(c, o, argv[*i]);
	}
}

static void parse_short(const struct cli *c, const struct options *all, char **argv, int argc, int *i)
{
	for (const char *p = argv[*i] + 1; *p; p++) {
		check_help(c, all, *p == 'h', *p == 'V');
		const struct cli_option *o = find_row(all, "", 0, *p);
		if (!o)
			cli_usage(c, "unknown option '-%c'", *p);
		if (o->type == CLI_FLAG) {
			set_value(c, o, "");
			continue;
		}
		if (p[1]) {
			set_value(c, o, p + 1);
		} else {
			if (++*i >= argc)
				cli_usage(c, "-%c needs an argument", *p);
			set_value(c, o, argv[*i]);
		}
		return;
	}
}

void cli_parse(struct cli *c, const struct cli_tool *tool, int argc, char **argv)
{
	struct options all;
	int only_operands = 0;

	*c = (struct cli){
		.tool = tool, .seed = 1, .output = tool->needs_output ? NULL : "-", .start = cli_seconds()};
	signals_catch(tool->name);
	c->operands = (const char **)(argv + 1);
	list_options(&all, c);
	for (int i = 1; i < argc; i++)
		if (only_operands || argv[i][0] != '-' || !argv[i][1])
			c->operands[c->operand_count++] = argv[i];
		else if (!strcmp(argv[i], "--"))
			only_operands = 1;
		else if (argv[i][1] == '-')
			parse_long(c, &all, argv, argc, &i);
		else
			parse_short(c, &all, argv, argc, &i);
	if (tool->needs_output && !c->output)
		cli_usage(c, "-o %s is required", tool->output_arg ? tool->output_arg : "FILE");
	if (c->operand_count < tool->min_operands)
		cli_usage(c, "missing operand: %s", tool->operands);
	if (tool->max_operands >= 0 && c->operand_count > tool->max_operands)
		cli_usage(c, "unexpected operand '%s'", c->operands[tool->max_operands]);
	if (c->threads)
		omp_set_num_threads((int)c->threads);
	else
		c->threads = omp_get_max_threads();
}

int cli_fail(const struct cli *c, const struct err *e)
{
	if (e->code == ERR_USAGE)
		cli_usage(c, "%s", e->message);
	fprintf(stderr, "%s: %s\n", c->tool->name, e->message);
	return e->code ? (int)e->code : ERR_SYSTEM;
}

static void print_note(const struct cli *c, int level, const char *format, va_list ap)
{
	if (c->verbose >= level && (!c->quiet || level))
		print_line(c, "", format, ap);
}

static void print_warning(const struct cli *c, const char *format, va_list ap)
{
	if (!c->quiet)
		print_line(c, "warning: ", format, ap);
}

void cli_note(const struct cli *c, int level, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	print_note(c, level, format, ap);
	va_end(ap);
}

void cli_warn(const struct cli *c, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	print_warning(c, format, ap);
	va_end(ap);
}

void cli_refuse_terminal(const struct cli *c)
{
	if (!strcmp(c->output, "-") && isatty(STDOUT_FILENO))
		cli_usage(c, "binary data are not written to a terminal; use -o FILE");
}

int cli_done(const struct cli *c)
{
	struct rusage usage;

	if (c->verbose && !getrusage(RUSAGE_SELF, &usage))
		cli_note(c, 1, "%.2f s, peak memory %.1f MiB", cli_seconds() - c->start,
			(double)usage.ru_maxrss / 1024);
	return 0;
}

double cli_seconds(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Where progress goes: standard error, or the descriptor that a script which keeps standard error names. */
static int progress_fd(void)
{
	const char *other = getenv("REFERSPLAT_PROGRESS");

	return other && *other >= '3' && *other <= '9' && !other[1] ? *other - '0' : STDERR_FILENO;
}

static void report_a_note(void *to, int level, const char *format, va_list ap)
{
	print_note(((struct cli_report *)to)->c, level, format, ap);
}

static void report_a_warning(void *to, const char *format, va_list ap)
{
	print_warning(((struct cli_report *)to)->c, format, ap);
}

static void report_a_start(void *to, const char *what, double total)
{
	struct cli_report *r = to;

	r->what = what;
	r->total = total;
	r->start = r->last = cli_seconds();
	r->is_shown = 0;
}

static void report_a_step(void *to, double done, const char *note)
{
	struct cli_report *r = to;
	double now = cli_seconds();

	if (r->c->quiet || now - r->start < 1 || now - r->last < 0.2 || !isatty(progress_fd()))
		return;
	r->last = now;
	double rate = done / (now - r->start);
	double left = rate > 0 ? (r->total - done) / rate : 0;
	dprintf(progress_fd(), "\r%s: %.0f/%.0f %s, %.3g/s, %d:%02d left%s%s\033[K", r->c->tool->name, done,
		r->total, r->what, rate, (int)left / 60, (int)left % 60, note ? ", " : "", note ? note : "");
	r->is_shown = 1;
}

static void report_an_end(void *to)
{
	struct cli_report *r = to;

	if (r->is_shown)
		dprintf(progress_fd(), "\r\033[K");
	r->is_shown = 0;
}

const struct report *cli_report(struct cli_report *r, const struct cli *c)
{
	*r = (struct cli_report){.c = c};
	r->report = (struct report){
		r, report_a_note, report_a_warning, report_a_start, report_a_step, report_an_end};
	return &r->report;
}

int cli_main(const struct cli_tool *tool, int argc, char **argv,
	int (*run)(const struct cli *c, const struct report *to, struct err *e))
{
	struct err e = {0};
	struct cli_report to;
	struct cli c;

	cli_parse(&c, tool, argc, argv);
	const int status = run(&c, cli_report(&to, &c), &e);
	if (status < 0)
		return cli_fail(&c, &e);
	cli_done(&c);
	return status;
}
