/* gs-check: says whether files of the suite are well-formed, and what is in them. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/check/check.h"

#include <cjson/cJSON.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>

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

static cJSON *listing_json(const struct safetensors *st)
{
	cJSON *list = cJSON_CreateArray();

	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		cJSON *item = cJSON_CreateObject(), *shape = cJSON_CreateArray();
		cJSON_AddStringToObject(item, "name", t->name);
		cJSON_AddStringToObject(item, "dtype", st_dtype_name(t->dtype));
		for (int d = 0; d < t->dims; d++)
			cJSON_AddItemToArray(shape, cJSON_CreateNumber((double)t->shape[d]));
		cJSON_AddItemToObject(item, "shape", shape);
		cJSON_AddItemToArray(list, item);
	}
	return list;
}

/* One object a line; c is NULL where the file is malformed, for the reason given. Returns -1 when memory is
 * out. */
static int print_json(const char *name, const struct check *c, const char *reason)
{
	cJSON *object = cJSON_CreateObject();

	cJSON_AddStringToObject(object, "file", name);
	cJSON_AddBoolToObject(object, "ok", c != NULL);
	if (c) {
		cJSON_AddStringToObject(object, "kind", c->kind);
		if (c->precision)
			cJSON_AddStringToObject(object, "precision", c->precision);
		if (c->width) {
			cJSON_AddNumberToObject(object, "width", c->width);
			cJSON_AddNumberToObject(object, "height", c->height);
		}
		for (int i = 0; i < c->n; i++) {
			char key[64];
			snprintf(key, sizeof key, "%s", c->facts[i].name);
			for (char *p = key; *p; p++)
				*p = *p == ' ' ? '_' : *p;
			cJSON_AddNumberToObject(object, key, (double)c->facts[i].value);
		}
		for (int i = 0; i < FINGERPRINTS; i++)
			if (fingerprint(c, i))
				cJSON_AddStringToObject(object, fingerprint_names[i], fingerprint(c, i));
		if (c->listing.n)
			cJSON_AddItemToObject(object, "list", listing_json(&c->listing));
	} else {
		cJSON_AddStringToObject(object, "reason", reason);
	}
	SCOPED char *text = cJSON_PrintUnformatted(object);
	cJSON_Delete(object);
	if (!text)
		return -1;
	printf("%s\n", text);
	return 0;
}

/* Checks and prints one operand; the exit status that it alone would have. */
static int check_one(const struct cli *cli, const char *path, struct err *e)
{
	const char *name = strcmp(path, "-") ? path : "stdin";
	size_t len = strlen(name);
	struct check c;
	int bad = 0;

	if ((name != path && check_spool(e)) || check_file(&c, path, e)) {
		if (e->code != ERR_FORMAT)
			return cli_fail(cli, e);
		/* The message begins with the path, or with that of the scene folder's file at fault. */
		int is_named = !strncmp(e->message, name, len) && strchr(":/", e->message[len]);
		if (cli->json)
			bad = print_json(name, NULL, e->message);
		else
			printf("%s%s%s\n", is_named ? "" : name, is_named ? "" : ": ", e->message);
		return bad ? ERR_SYSTEM : ERR_CHECK;
	}
	if (cli->json)
		bad = print_json(name, &c, NULL);
	else
		print_text(name, &c);
	check_free(&c);
	return bad ? ERR_SYSTEM : 0;
}

int main(int argc, char **argv)
{
	struct cli cli;
	struct err e = {0};
	int worst = 0;

	cli_parse(&cli, &tool, argc, argv);
	for (int i = 0; i < cli.operand_count; i++) {
		int status = check_one(&cli, cli.operands[i], &e);
		worst = status > worst ? status : worst;
	}
	if (fflush(stdout) || ferror(stdout)) {
		err_errno(&e, "stdout");
		return cli_fail(&cli, &e);
	}
	cli_done(&cli);
	return worst;
}
