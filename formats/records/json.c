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

cJSON *json_parse(const char *text, size_t len, const char *name, struct err *e)
{
	const char *stop = NULL;
	cJSON *value = NULL;

	if (strlen(text) != len)
		err_file(e, name, "not JSON: a NUL byte at offset %zu", strlen(text));
	else if (!(value = cJSON_ParseWithOpts(text, &stop, 1)))
		err_file(e, name, "not JSON at offset %td", stop ? stop - text : (ptrdiff_t)0);
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
