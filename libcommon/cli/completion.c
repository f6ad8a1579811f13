#include "cli/completion.h"

#include <string.h>

/* What completes an option's argument. */
enum argument { NO_ARGUMENT, CHOICES, FILES, FOLDERS, NOTHING, ARGUMENTS };

static enum argument argument_of(const struct cli_option *o)
{
	static const char capitals[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";

	if (o->type == CLI_FLAG)
		return NO_ARGUMENT;
	if (o->type == CLI_CHOICE)
		return CHOICES;
	if (o->type != CLI_STRING || o->arg[strspn(o->arg, capitals)])
		return NOTHING;
	return strcmp(o->arg, "DIR") ? FILES : FOLDERS;
}

/* The choices with blanks between. */
static void print_choices(const struct cli_option *o)
{
	for (const char *p = o->arg; *p; p++)
		putchar(*p == '|' ? ' ' : *p);
}

/* A shell function's name: the tool's with '_' for '-'. */
static void print_function(const struct cli_tool *tool)
{
	putchar('_');
	for (const char *p = tool->name; *p; p++)
		putchar(*p == '-' ? '_' : *p);
}

static void print_pattern(const struct cli_option *o, const char *before)
{
	printf("%s--%s", before, o->name);
	if (o->letter)
		printf(" | -%c", o->letter);
}

/* An arm of `case $prev` for all options whose arguments are of one kind. */
static void print_arm(
	const struct cli_option *const *rows, size_t n, enum argument kind, const char *completed)
{
	const char *before = "\t";

	for (size_t i = 0; i < n; i++)
		if (argument_of(rows[i]) == kind) {
			print_pattern(rows[i], before);
			before = " | ";
		}
	if (*before == ' ')
		printf(")\n\t\t%s\n\t\treturn\n\t\t;;\n", completed);
}

void completion_bash(const struct cli_tool *tool, const struct cli_option *const *rows, size_t n)
{
	printf("# Completion of %s for bash, made of its table of options.\n", tool->name);
	print_function(tool);
	printf("()\n{\n\tlocal cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}\n"
	       "\t# --option=argument is three words\n"
	       "\tif [[ $cur == = ]]; then\n\t\tcur=\n"
	       "\telif [[ $prev == = ]]; then\n\t\tprev=${COMP_WORDS[COMP_CWORD - 2]}\n\tfi\n"
	       "\tCOMPREPLY=()\n\tcase $prev in\n");
	for (size_t i = 0; i < n; i++) {
		if (argument_of(rows[i]) != CHOICES)
			continue;
		print_pattern(rows[i], "\t");
		printf(")\n\t\tmapfile -t COMPREPLY < <(compgen -W '");
		print_choices(rows[i]);
		printf("' -- \"$cur\")\n\t\treturn\n\t\t;;\n");
	}
	print_arm(rows, n, FILES, "mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")");
	print_arm(rows, n, FOLDERS, "mapfile -t COMPREPLY < <(compgen -d -- \"$cur\")");
	print_arm(rows, n, NOTHING, "compopt +o default 2>/dev/null");
	printf("\tesac\n\tif [[ $cur == -* ]]; then\n\t\tmapfile -t COMPREPLY < <(compgen -W '");
	for (size_t i = 0; i < n; i++)
		printf("%s--%s", i ? " " : "", rows[i]->name);
	printf("' -- \"$cur\")\n\telse\n\t\tmapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n\tfi\n}\n");
	printf("complete -o filenames -F ");
	print_function(tool);
	printf(" %s\n", tool->name);
}

/* A description within single quotes and brackets, where a colon is no end. */
static void print_description(const char *text)
{
	for (; *text; text++)
		if (*text == '\'')
			fputs("'\\''", stdout);
		else
			printf("%s%c", strchr("[]:\\", *text) ? "\\" : "", *text);
}

static void print_zsh_argument(const struct cli_option *o)
{
	static const char *const actions[ARGUMENTS] = {
		[CHOICES] = "(", [FILES] = "_files", [FOLDERS] = "_files -/", [NOTHING] = " "};

	putchar(':');
	print_description(o->arg);
	printf(":%s", actions[argument_of(o)]);
	if (argument_of(o) == CHOICES) {
		print_choices(o);
		putchar(')');
	}
}

/* One word of _arguments for one name of an option. */
static void print_zsh_row(const struct cli_option *o, const char *dashes, const char *name)
{
	const int has_argument = argument_of(o) != NO_ARGUMENT;

	printf(" \\\n\t'*%s%s%s[", dashes, name, !has_argument ? "" : dashes[1] ? "=" : "+");
	print_description(o->help);
	putchar(']');
	if (has_argument)
		print_zsh_argument(o);
	putchar('\'');
}

void completion_zsh(const struct cli_tool *tool, const struct cli_option *const *rows, size_t n)
{
	printf("#compdef %s\n# Completion of %s for zsh, made of its table of options.\n_arguments -s -S",
		tool->name, tool->name);
	for (size_t i = 0; i < n; i++) {
		const char letter[] = {rows[i]->letter, 0};
		print_zsh_row(rows[i], "--", rows[i]->name);
		if (*letter)
			print_zsh_row(rows[i], "-", letter);
	}
	printf(" \\\n\t'*:file:_files'\n");
}
