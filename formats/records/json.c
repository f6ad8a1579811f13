#include "formats/records/json.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/textfile.h"

#include <math.h>

enum { MEMBERS = 64 /* of an object whose keys are looked at; a table's are its reader's */ };

const char *json_find_twice(const cJSON *value)
{
	const int is_small = cJSON_IsObject(value) && cJSON_GetArraySize(value) <= MEMBERS;
	const cJSON *item, *before;
	const char *found = NULL;

	cJSON_ArrayForEach(item, value)
	{
		for (before = value->child; is_small && before != item; before = before->next)
			if (!strcmp(before->string, item->string))
				return item->string;
		if (item->child && (found = json_find_twice(item)))
			return found;
	}
	return NULL;
}

/* The next character that is in no text, from one that is not. */
static char *skip_text(char *at)
{
	for (; *at == '"'; at += *at != 0)
		for (at++; *at && *at != '"'; at++)
			at += *at == '\\' && at[1];
	return at;
}

cJSON *json_take(char *text, const char **stop)
{
	static const char *const words[] = {"NaN", "Infinity", "-Infinity"};
	cJSON *value = cJSON_ParseWithOpts(text, stop, 1);

	if (value || !strpbrk(text, "NI"))
		return value;
	for (char *at = skip_text(text); *at; at = skip_text(at + 1))
		for (int k = 0; k < 3; k++) {
			const size_t n = strlen(words[k]);
			if (strncmp(at, words[k], n) != 0)
				continue;
			at[0] = at[n - 1] = '"';
			at += n - 1;
		}
	return cJSON_ParseWithOpts(text, stop, 1);
}

/* The character before one, but for blanks; NUL at the beginning. */
static char character_before(const char *text, const char *at)
{
	do
		at--;
	while (at >= text && strchr(" \t\r\n", *at));
	return (char)(at >= text ? *at : 0);
}

const char *json_hint(const char *text, const char *stop)
{
	/* cJSON stops at what is wrong, or one character behind it; of a text that has no end at its first */
	const int is_behind = stop > text && strchr("]}'", stop[-1]) != NULL;
	const char *at = stop - is_behind;

	if ((*stop == ',' && stop[1]) || (*at && strchr("]}", *at) && character_before(text, at) == ','))
		return ": a comma too many";
	if (!*at || (at > text && at[-1] == '"'))
		return "";
	return *at == '/' || *at == '#' ? ": JSON has no comments"
	       : strchr("'TFN", *at)	? ": it is as Python prints it: json.dump writes JSON"
					: "";
}

cJSON *json_parse(char *text, size_t len, const char *name, struct err *e)
{
	const char *stop = NULL;
	cJSON *value = NULL;

	if (strlen(text) != len)
		err_file(e, name, "not JSON: a NUL byte at offset %zu", strlen(text));
	else if (!(value = json_take(text, &stop)))
		err_file(e, name, "not JSON at offset %td%s", stop ? stop - text : (ptrdiff_t)0,
			json_hint(text, stop ? stop : text));
	const char *twice = json_find_twice(value);
	const int has_nul = value && json_has_nul(text);
	if (!twice && !has_nul)
		return value;
	if (has_nul)
		err_file(e, name, "a NUL character (\\u0000) in a string");
	else
		err_file(e, name, "key '%.80s' is there twice in one object", twice);
	cJSON_Delete(value);
	return NULL;
}

cJSON *json_read(const char *path, struct err *e)
{
	SCOPED char *text = NULL;
	size_t len;

	if (textfile_read(path, &text, &len, e))
		return NULL;
	return json_parse(text, len, file_name(path), e);
}

int json_has_nul(const char *json)
{
	for (const char *p = strchr(json, '\\'); p && p[1]; p = strchr(p + 2, '\\'))
		if (!strncmp(p, "\\u0000", 6))
			return 1;
	return 0;
}

static int err_missing(const char *key, int need, const char *where, struct err *e)
{
	return need ? err_file(e, where, "key '%s' is missing", key) : 0;
}

int json_number(
	const cJSON *object, const char *key, int need, double *value, const char *where, struct err *e)
{
	const cJSON *item = json_member(object, key);

	if (!item)
		return err_missing(key, need, where, e);
	if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble))
		return err_file(e, where, "key '%s' is not a number", key);
	*value = item->valuedouble;
	return 1;
}

int json_string(
	const cJSON *object, const char *key, int need, const char **value, const char *where, struct err *e)
{
	const cJSON *item = json_member(object, key);

	if (!item)
		return err_missing(key, need, where, e);
	if (!cJSON_IsString(item))
		return err_file(e, where, "key '%s' is not a string", key);
	*value = item->valuestring;
	return 1;
}

int json_numbers(const cJSON *array, int count, double *values)
{
	const cJSON *item = cJSON_IsArray(array) ? array->child : NULL;

	for (int i = 0; i < count; i++, item = item->next) {
		if (!item || !cJSON_IsNumber(item) || !isfinite(item->valuedouble))
			return -1;
		values[i] = item->valuedouble;
	}
	return item ? -1 : 0;
}

int json_matrix(const cJSON *object, const char *key, int rows, int columns, double *values,
	const char *where, struct err *e)
{
	const cJSON *item = json_member(object, key), *row = cJSON_IsArray(item) ? item->child : NULL;
	int bad = 0;

	if (!item)
		return err_missing(key, 1, where, e);
	if (!columns) {
		if (json_numbers(item, rows, values))
			return err_file(e, where, "key '%s' is not %d numbers", key, rows);
		return 0;
	}
	for (int r = 0; !bad && r < rows; r++) {
		bad = !row || json_numbers(row, columns, values + r * columns);
		row = bad ? row : row->next;
	}
	if (bad || row)
		return err_file(e, where, "key '%s' is not %dx%d numbers", key, rows, columns);
	return 0;
}
