#include "cmd/masks/painting.h"

#include "base/mem.h"
#include "base/name.h"
#include "formats/records/jsonl.h"
#include "formats/images/png.h"

#include <stdlib.h>
#include <string.h>

void painting_names_free(struct painting_names *names)
{
	for (size_t i = 0; i < names->n; i++)
		free(names->items[i].name);
	free(names->items);
	*names = (struct painting_names){0};
}

/* "#rrggbb" or "0" to "65535" at the beginning of a line: where it ends, or NULL. */
static char *take_colour(char *text, uint32_t *colour)
{
	const int is_hex = *text == '#';
	char *end, *digits = text + is_hex;
	const size_t n = strspn(digits, is_hex ? "0123456789abcdefABCDEF" : "0123456789");
	const unsigned long value = strtoul(digits, &end, is_hex ? 16 : 10);

	if (end != digits + n || (is_hex ? n != 6 : !n || value > 65535 || n > (value > 255 ? 5 : 3)) ||
		!strchr(" \t", *end))
		return NULL;
	*colour = is_hex ? (uint32_t)value : png_paint_number((uint32_t)value);
	return end;
}

const struct painting_name *painting_names_find(const struct painting_names *names, uint32_t colour)
{
	for (size_t i = 0; i < names->n; i++)
		if (names->items[i].colour == colour)
			return &names->items[i];
	return NULL;
}

static int has_name(const struct painting_names *names, const char *name)
{
	for (size_t i = 0; i < names->n; i++)
		if (!strcmp(names->items[i].name, name))
			return 1;
	return 0;
}

static int add_name(struct painting_names *names, const struct jsonl *j, struct err *e)
{
	char *text = j->line + strspn(j->line, " \t"), fault[NAME_FAULT];
	uint32_t colour;
	char *name = take_colour(text, &colour);

	if (!name)
		return jsonl_err(j, e, "does not begin with #rrggbb or 0 to 65535, and a blank");
	name += strspn(name, " \t");
	for (size_t n = strlen(name); n && strchr(" \t", name[n - 1]); n--)
		name[n - 1] = 0;
	const char *reason = name_fault(name, NAME_DATA, fault);
	if (reason)
		return jsonl_err(j, e, "the name %s", reason);
	if (painting_names_find(names, colour))
		return jsonl_err(j, e, "its colour or number has a name already");
	if (has_name(names, name))
		return jsonl_err(j, e, "the name '%s' has a colour already", name);
	if (mem_grow(
		    (void **)&names->items, &names->capacity, names->n + 1, sizeof *names->items, j->path, e))
		return -1;
	names->items[names->n] = (struct painting_name){colour, mem_strdup(name, e), 0};
	return names->items[names->n].name ? (int)(names->n++, 0) : -1;
}

int painting_names_read(struct painting_names *names, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	int got;

	*names = (struct painting_names){0};
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = jsonl_text(&j, e)) > 0)
		if (add_name(names, &j, e)) {
			got = -1;
			break;
		}
	if (!got && !names->n)
		got = err_set(e, ERR_FORMAT, "%s: holds no names", j.path);
	return got;
}
