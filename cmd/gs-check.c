/* gs-check: says whether files of the suite are well-formed, and what is in them. */
#include "base/jsontext.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/check/check.h"

#include <ctype.h>
#include <stdio.h>

static const struct cli_tool tool = {
	.name = "gs-check",
	.operands = "FILE...",
	.summary = "Say whether files and scene folders are well-formed, and what is in them.",
	.common = CLI_JSON | CLI_VERBOSE,
	.min_operands = 1,
	.max_operands = -1,
};

/* The fingerprints that a file may have, in the order in which they are printed. */
enum { FINGERPRINTS = 3 };
static const char *const fingerprint_names[FINGERPRINTS] = {"scene", "camera", "encoder"};

static const char *fingerprint(const struct check *c, int which)
{
	const struct fingerprint *const all[FINGERPRINTS] = {&c->scene, &c->camera, &c->encoder};

	return fingerprint_text(all[which]);
}

static void print_text(const char *name, const struct check *c)
{
	printf("%s: ok: %s", name, c->kind);
	if (c->precision)
		printf(", %s", c->precision);
	if (c->width)
		printf(", %dx%d", c->width, c->height);
	for (int i = 0; i < c->n; i++)
		printf(", %lld %s", c->facts[i].value, c->facts[i].name);
	for (int i = 0; i < FINGERPRINTS; i++)
		if (fingerprint(c, i))
			printf(", %s %s", fingerprint_names[i], fingerprint(c, i));
	printf("\n");
	for (size_t i = 0; i < c->listing.n; i++) {
		const struct st_tensor *t = &c->listing.tensors[i];
		putchar('\t');
		for (const char *p = t->name; *p; p++)
			putchar(iscntrl((unsigned char)*p) ? '?' : *p);
		printf(" %s[", st_dtype_name(t->dtype));
		for (int d = 0; d < t->dims; d++)
			printf("%s%lld", d ? "," : "", (long long)t->shape[d]);
		printf("]\n");
	}
}

static void put_listing(struct jsontext *to, const struct safetensors *st)
{
	jsontext_open(to, "list", '[');
	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "name", t->name);
		jsontext_string(to, "dtype", st_dtype_name(t->dtype));
		jsontext_open(to, "shape", '[');
		for (int d = 0; d < t->dims; d++)
			jsontext_number(to, NULL, (double)t->shape[d]);
		jsontext_close(to, ']');
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
}

/* One object a line; c is NULL where the file is malformed, for the reason given. */
static void print_json(const char *name, const struct check *c, const char *reason)
{
	struct jsontext j = {.out = stdout}, *to = &j;
	char key[64];

	jsontext_open(to, NULL, '{');
	jsontext_string(to, "file", name);
	jsontext_flag(to, "ok", c != NULL);
	if (reason)
		jsontext_string(to, "reason", reason);
	if (c)
		jsontext_string(to, "kind", c->kind);
	if (c && c->precision)
		jsontext_string(to, "precision", c->precision);
	if (c && c->width) {
		jsontext_number(to, "width", c->width);
		jsontext_number(to, "height", c->height);
	}
	for (int i = 0; c && i < c->n; i++) {
		snprintf(key, sizeof key, "%s", c->facts[i].name);
		for (char *p = key; *p; p++)
			*p = *p == ' ' ? '_' : *p;
		jsontext_number(to, key, (double)c->facts[i].value);
	}
	for (int i = 0; c && i < FINGERPRINTS; i++)
		if (fingerprint(c, i))
			jsontext_string(to, fingerprint_names[i], fingerprint(c, i));
	if (c && c->listing.n)
		put_listing(to, &c->listing);
	jsontext_close(to, '}');
	putchar('\n');
}

/* Checks and prints one operand; the exit status that it alone would have. */
static int check_one(const struct cli *cli, const char *path, struct err *e)
{
	const char *name = strcmp(path, "-") ? path : "stdin";
	size_t len = strlen(name);
	SCOPED_BY(check_free) struct check c = {0};

	if ((name != path && check_spool(e)) || check_file(&c, path, e)) {
		if (e->code != ERR_FORMAT)
			return cli_fail(cli, e);
		/* The message begins with the path, or with that of the scene folder's file at fault. */
		int is_named = !strncmp(e->message, name, len) && strchr(":/", e->message[len]);
		if (cli->json)
			print_json(name, NULL, e->message);
		else
			printf("%s%s%s\n", is_named ? "" : name, is_named ? "" : ": ", e->message);
		return ERR_CHECK;
	}
	if (cli->json)
		print_json(name, &c, NULL);
	else
		print_text(name, &c);
	return 0;
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	int worst = 0;

	(void)to;
	for (int i = 0; i < c->operand_count; i++) {
		int status = check_one(c, c->operands[i], e);
		worst = status > worst ? status : worst;
	}
	return fflush(stdout) || ferror(stdout) ? err_errno(e, "stdout") : worst;
}

CLI_MAIN(tool, run)
