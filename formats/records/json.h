/* Whole JSON files, and members of their objects with messages that say where. formats/records/json.md. */
#pragma once

#include "base/err.h"

#include <cjson/cJSON.h>
#include <string.h>

/* The value in a file ("-" is stdin): cJSON_Delete it. NULL with *e set ("path: not JSON at offset N"). */
cJSON *json_read(const char *path, struct err *e);

/* The same of `len` bytes in memory and a NUL after them, which json_take may change; name is for messages.
 */
cJSON *json_parse(char *text, size_t len, const char *name, struct err *e);

/* cJSON_ParseWithOpts of all of a text, in which NaN, Infinity and -Infinity, as Python's json writes numbers
 * that are none, become texts of their length: what needs a number there says so, other keys may have them.
 * NULL with *stop where it is no JSON. */
cJSON *json_take(char *text, const char **stop);

/* What is wrong there, ": a comma too many", or "". */
const char *json_hint(const char *text, const char *stop);

/* Of a local, where its block is left: SCOPED_BY(json_release) cJSON *root = json_read(...). */
static inline void json_release(cJSON **value)
{
	cJSON_Delete(*value);
}

/* 1 where a string in JSON that was parsed has the escape \u0000, at which cJSON silently ends the string. */
int json_has_nul(const char *json);

/* A key that an object in a value has twice, of which programs take the first or the last; or NULL. */
const char *json_find_twice(const cJSON *value);

/* A member of an object, or NULL. */
static inline cJSON *json_get(const cJSON *object, const char *key)
{
	return cJSON_GetObjectItemCaseSensitive(object, key);
}

/* The same, and NULL too where it is null. */
static inline cJSON *json_member(const cJSON *object, const char *key)
{
	cJSON *item = json_get(object, key);

	return cJSON_IsNull(item) ? NULL : item;
}

/* 1 where the value is that text. */
static inline int json_is(const cJSON *value, const char *text)
{
	return cJSON_IsString(value) && !strcmp(value->valuestring, text);
}

/* A number member, finite. Returns 1 and *value, 0 where it is absent or null (an error if `need`), -1 with
 * *e ("WHERE: key 'k' ..."). */
int json_number(
	const cJSON *object, const char *key, int need, double *value, const char *where, struct err *e);

/* A string member: as json_number. *value belongs to the object. */
int json_string(
	const cJSON *object, const char *key, int need, const char **value, const char *where, struct err *e);

/* A member that is an array of `rows` arrays of `columns` finite numbers, or of `rows` numbers where columns
 * is 0. Returns 0, or -1 with *e. */
int json_matrix(const cJSON *object, const char *key, int rows, int columns, double *values,
	const char *where, struct err *e);

/* `count` finite numbers of an array, no more and no fewer: 0, or -1. */
int json_numbers(const cJSON *array, int count, double *values);
