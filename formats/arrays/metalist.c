#include "formats/arrays/metalist.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/utf8.h"
#include "formats/records/json.h"

#include <cjson/cJSON.h>
#include <stdlib.h>
#include <string.h>

void metalist_free(char **strings, size_t n)
{
	for (size_t i = 0; strings && i < n; i++)
		free(strings[i]);
	free(strings);
}

char **metalist_read(const struct safetensors *st, const char *key, size_t n, const char *of, struct err *e)
{
	const char *value = safetensors_meta(st, key);
	cJSON *list = value ? cJSON_Parse(value) : NULL;
	char **strings = NULL;
	size_t used = 0;

	if (!list || !cJSON_IsArray(list)) {
		err_set(e, ERR_FORMAT, "%s: metadata '%s' is not a JSON list", st->path, key);
		goto fail;
	}
	if (json_has_nul(value)) {
		err_set(e, ERR_FORMAT, "%s: metadata '%s': a NUL character (\\u0000) in a string", st->path,
			key);
		goto fail;
	}
	if ((size_t)cJSON_GetArraySize(list) != n) {
		err_set(e, ERR_FORMAT, "%s: metadata '%s' has %d entries for %zu %s", st->path, key,
			cJSON_GetArraySize(list), n, of);
		goto fail;
	}
	strings = mem_zalloc(n, sizeof *strings, st->path, e);
	if (!strings)
		goto fail;
	for (const cJSON *item = list->child; item; item = item->next, used++) {
		const char *s = item->valuestring;
		if (!cJSON_IsString(item) || utf8_check(s, strlen(s)) < strlen(s)) {
			err_set(e, ERR_FORMAT, "%s: metadata '%s': entry %zu is not a UTF-8 string", st->path,
				key, used);
			goto fail;
		}
		strings[used] = mem_strdup(s, e);
		if (!strings[used])
			goto fail;
	}
	cJSON_Delete(list);
	return strings;
fail:
	metalist_free(strings, used);
	cJSON_Delete(list);
	return NULL;
}

char **metalist_parse(const char *value, size_t *n, struct err *e)
{
	cJSON *list = cJSON_Parse(value);
	char **strings = NULL;

	*n = 0;
	if (!list || !cJSON_IsArray(list)) {
		err_set(e, ERR_FORMAT, "not a JSON list");
		goto done;
	}
	strings = mem_zalloc((size_t)cJSON_GetArraySize(list) + 1, sizeof *strings, "names", e);
	for (const cJSON *item = list->child; item && strings; item = item->next) {
		const char *s = item->valuestring;
		if (!cJSON_IsString(item) || utf8_check(s, strlen(s)) < strlen(s))
			err_set(e, ERR_FORMAT, "entry %zu is not a UTF-8 string", *n);
		else if ((strings[*n] = mem_strdup(s, e)) != NULL) {
			++*n;
			continue;
		}
		metalist_free(strings, *n);
		strings = NULL;
	}
done:
	cJSON_Delete(list);
	return strings;
}

char *metalist_print(char *const *strings, size_t n)
{
	cJSON *list = cJSON_CreateArray();
	char *text = NULL;

	for (size_t i = 0; list && i < n; i++) {
		cJSON *item = cJSON_CreateString(strings[i]);
		if (!item || !cJSON_AddItemToArray(list, item)) {
			cJSON_Delete(item);
			goto done;
		}
	}
	if (list)
		text = cJSON_PrintUnformatted(list);
done:
	cJSON_Delete(list);
	return text;
}

int metalist_check_names(
	char *const *strings, size_t n, int may_be_empty, const char *key, const char *path, struct err *e)
{
	char fault[NAME_FAULT];

	for (size_t i = 0; i < n; i++) {
		const char *reason = name_fault(strings[i], NAME_DATA, fault);
		if (reason && (*strings[i] || !may_be_empty))
			return err_set(
				e, ERR_FORMAT, "%s: metadata '%s': entry %zu %s", path, key, i, reason);
	}
	return 0;
}

static int by_name(const void *a, const void *b)
{
	return strcmp(*(char *const *)a, *(char *const *)b);
}

int metalist_check_unique(char *const *strings, size_t n, const char *key, const char *path, struct err *e)
{
	char **sorted = mem_alloc(n, sizeof *sorted, path, e);
	int bad = 0;

	if (!sorted)
		return -1;
	for (size_t i = 0; i < n; i++)
		sorted[i] = strings[i];
	if (n)
		qsort(sorted, n, sizeof *sorted, by_name);
	for (size_t i = 1; i < n && !bad; i++)
		if (!strcmp(sorted[i - 1], sorted[i]))
			bad = err_set(
				e, ERR_FORMAT, "%s: metadata '%s': '%s' appears twice", path, key, sorted[i]);
	free(sorted);
	return bad;
}

int metalist_check_offsets(const char *name, const int64_t *offsets, size_t n, int64_t count, const char *of,
	const char *path, struct err *e)
{
	if (offsets[0] != 0)
		return err_set(e, ERR_FORMAT, "%s: tensor '%s': begins with %lld, expected 0", path, name,
			(long long)offsets[0]);
	for (size_t i = 0; i < n; i++)
		if (offsets[i + 1] < offsets[i])
			return err_set(e, ERR_FORMAT, "%s: tensor '%s': falls from %lld to %lld at entry %zu",
				path, name, (long long)offsets[i], (long long)offsets[i + 1], i + 1);
	if (offsets[n] != count)
		return err_set(e, ERR_FORMAT, "%s: tensor '%s': ends with %lld, but there are %lld %s", path,
			name, (long long)offsets[n], (long long)count, of);
	return 0;
}

int metalist_check_pieces(
	char *const *pieces, const int64_t *offsets, size_t n, const char *path, struct err *e)
{
	for (size_t i = 0; i < n; i++) {
		int64_t count = 0, words = offsets[i + 1] - offsets[i];
		for (const char *c = pieces[i]; *c; c++) {
			if (*c == ' ' && (c == pieces[i] || c[1] == ' ' || !c[1]))
				return err_set(e, ERR_FORMAT,
					"%s: metadata 'pieces': entry %zu does not have one space between pieces, and none around",
					path, i);
			count += *c != ' ' && (c[1] == ' ' || !c[1]);
		}
		if (count != words)
			return err_set(e, ERR_FORMAT,
				"%s: metadata 'pieces': entry %zu has %lld pieces for %lld words", path, i,
				(long long)count, (long long)words);
	}
	return 0;
}
