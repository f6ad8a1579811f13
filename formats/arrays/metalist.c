#include "formats/arrays/metalist.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/utf8.h"
#include "formats/records/json.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void metalist_free(char **strings, size_t n)
{
	for (size_t i = 0; strings && i < n; i++)
		free(strings[i]);
	free(strings);
}

/* The strings of a list, which has *n of them if it says; "" as reason where memory is out. */
static char **take_strings(const cJSON *list, size_t *n, char reason[64])
{
	struct err ignored;
	char **strings = mem_zalloc((size_t)cJSON_GetArraySize(list) + 1, sizeof *strings, "names", &ignored);

	*n = 0;
	*reason = 0;
	for (const cJSON *item = list->child; item && strings; item = item->next) {
		const char *s = item->valuestring;
		if (!cJSON_IsString(item) || utf8_check(s, strlen(s)) < strlen(s))
			snprintf(reason, 64, "entry %zu is not a UTF-8 string", *n);
		else if ((strings[*n] = mem_strdup(s, &ignored)) != NULL) {
			++*n;
			continue;
		}
		metalist_free(strings, *n);
		strings = NULL;
	}
	return strings;
}

char **metalist_read(const struct safetensors *st, const char *key, size_t n, const char *of, struct err *e)
{
	const char *value = safetensors_meta(st, key);
	cJSON *list = value ? cJSON_Parse(value) : NULL;
	char **strings = NULL, reason[64] = "";
	size_t used;

	if (!list || !cJSON_IsArray(list))
		err_file(e, st->path, "metadata '%s' is not a JSON list", key);
	else if (json_has_nul(value))
		err_file(e, st->path, "metadata '%s': a NUL character (\\u0000) in a string", key);
	else if ((size_t)cJSON_GetArraySize(list) != n)
		err_file(e, st->path, "metadata '%s' has %d entries for %zu %s", key,
			cJSON_GetArraySize(list), n, of);
	else if (!(strings = take_strings(list, &used, reason)))
		err_set(e, *reason ? ERR_FORMAT : ERR_SYSTEM, "%s: metadata '%s': %s", st->path, key,
			*reason ? reason : "out of memory");
	cJSON_Delete(list);
	return strings;
}

char **metalist_parse(const char *value, size_t *n, struct err *e)
{
	cJSON *list = cJSON_Parse(value);
	char **strings = NULL, reason[64] = "not a JSON list";

	*n = 0;
	if (cJSON_IsArray(list))
		strings = take_strings(list, n, reason);
	if (!strings)
		err_set(e, *reason ? ERR_FORMAT : ERR_SYSTEM, "%s", *reason ? reason : "out of memory");
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
			return err_file(e, path, "metadata '%s': entry %zu %s", key, i, reason);
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
			bad = err_file(e, path, "metadata '%s': '%s' appears twice", key, sorted[i]);
	free(sorted);
	return bad;
}

int64_t *metalist_offsets(
	const struct safetensors *st, const char *name, const char *of, size_t *n, struct err *e)
{
	int64_t *offsets = safetensors_copy(st, name, ST_I64, 1, (int64_t[]){-1}, n, e);

	if (!offsets || (*n >= 1 && *n <= INT32_MAX)) {
		*n = offsets ? *n - 1 : 0;
		return offsets;
	}
	err_file(e, st->path, "tensor '%s': has %zu entries, expected 1 more than %s", name, *n, of);
	free(offsets);
	*n = 0;
	return NULL;
}

int metalist_check_index(const int32_t *index, const int64_t *indptr, size_t n, size_t limit, const char *of,
	const char *path, struct err *e)
{
	for (size_t r = 0; r < n; r++)
		for (int64_t k = indptr[r]; k < indptr[r + 1]; k++)
			if (index[k] < 0 || (size_t)index[k] >= limit ||
				(k > indptr[r] && index[k] <= index[k - 1]))
				return err_file(e, path,
					"tensor 'index': item %lld does not rise within 0 to %lld, in %s %zu",
					(long long)k, (long long)limit - 1, of, r);
	return 0;
}

int metalist_check_offsets(const char *name, const int64_t *offsets, size_t n, int64_t count, const char *of,
	const char *path, struct err *e)
{
	if (offsets[0] != 0)
		return err_file(
			e, path, "tensor '%s': begins with %lld, expected 0", name, (long long)offsets[0]);
	for (size_t i = 0; i < n; i++)
		if (offsets[i + 1] < offsets[i])
			return err_file(e, path, "tensor '%s': falls from %lld to %lld at entry %zu", name,
				(long long)offsets[i], (long long)offsets[i + 1], i + 1);
	if (offsets[n] != count)
		return err_file(e, path, "tensor '%s': ends with %lld, but there are %lld %s", name,
			(long long)offsets[n], (long long)count, of);
	return 0;
}

int metalist_check_pieces(
	char *const *pieces, const int64_t *offsets, size_t n, const char *path, struct err *e)
{
	for (size_t i = 0; i < n; i++) {
		int64_t count = 0, words = offsets[i + 1] - offsets[i];
		for (const char *c = pieces[i]; *c; c++) {
			if (*c == ' ' && (c == pieces[i] || c[1] == ' ' || !c[1]))
				return err_file(e, path,
					"metadata 'pieces': entry %zu does not have one space between pieces, and none around",
					i);
			count += *c != ' ' && (c[1] == ' ' || !c[1]);
		}
		if (count != words)
			return err_file(e, path,
				"metadata 'pieces': entry %zu has %lld pieces for %lld words", i,
				(long long)count, (long long)words);
	}
	return 0;
}
