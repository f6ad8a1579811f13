#include "formats/records/foreign.h"

#include "base/path.h"
#include "formats/records/json.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MEMBERS = 3 };

/* JSON that has these members; a list is told by those of its first item. */
struct kind {
	int is_list;
	const char *members[MEMBERS];
	const char *what, *way_out;
};

static const struct kind kinds[] = {
#define FOREIGN_JSON(...) {__VA_ARGS__},
#include "formats/records/foreign.def"
};

/* Files that are known by how their name ends, or by how they begin. */
static const struct {
	enum foreign_place place;
	const char *ending, *begin, *what, *way_out;
} files[] = {
#define FOREIGN_FILE(...) {__VA_ARGS__},
#include "formats/records/foreign.def"
};

int foreign_say(const char *name, const char *what, const char *way_out, struct err *e)
{
	const char *dot = strrchr(name, '.');
	const int stem = (int)(dot ? (size_t)(dot - name) : strlen(name));
	char text[512];
	size_t n = 0;

	for (; *way_out && n < sizeof text - 1; way_out++)
		if (*way_out == '%')
			n += (size_t)snprintf(text + n, 160, "%.*s", *++way_out == 'b' ? stem : 159, name);
		else
			text[n++] = *way_out;
	text[n] = 0;
	return err_file(e, name, "%s: %s", what, text);
}

static int has_members(const cJSON *object, const struct kind *k)
{
	for (int i = 0; i < MEMBERS && k->members[i]; i++)
		if (!json_get(object, k->members[i]))
			return 0;
	return 1;
}

int foreign_json(const cJSON *root, const char *name, struct err *e)
{
	const int is_list = cJSON_IsArray(root);
	const cJSON *object = is_list ? root->child : root;

	for (size_t i = 0; cJSON_IsObject(object) && i < sizeof kinds / sizeof *kinds; i++)
		if (kinds[i].is_list == is_list && has_members(object, &kinds[i]))
			return foreign_say(name, kinds[i].what, kinds[i].way_out, e);
	return 0;
}

int foreign_file(const char *name, enum foreign_place place, const void *data, size_t len, struct err *e)
{
	for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
		const size_t n = files[i].begin ? strlen(files[i].begin) : 0;
		if (files[i].place == place && (path_ends(name, files[i].ending) ||
						       (n && n <= len && !memcmp(data, files[i].begin, n))))
			return foreign_say(name, files[i].what, files[i].way_out, e);
	}
	return 0;
}
