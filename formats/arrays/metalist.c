#include "formats/arrays/metalist.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "formats/records/json.h"

#include <stdio.h>

char **metalist_parse(const char *text, size_t *n, char reason[METALIST_REASON])
{
	SCOPED_BY(json_release) cJSON *list = cJSON_Parse(text);
	const int is_list = cJSON_IsArray(list) && !json_has_nul(text);
	struct err ignored;
	char **strings =
		is_list ? mem_zalloc((size_t)cJSON_GetArraySize(list) + 1, sizeof *strings, "names", &ignored)
			: NULL;

	*n = 0;
	snprintf(reason, METALIST_REASON, "%s",
		is_list		      ? "out of memory"
		: cJSON_IsArray(list) ? "a NUL character (\\u0000) in a string"
				      : "not a JSON list");
	for (const cJSON *item = strings ? list->child : NULL; item && strings; item = item->next) {
		const char *s = item->valuestring;
		if (!cJSON_IsString(item) || utf8_check(s, strlen(s)) < strlen(s))
			snprintf(reason, METALIST_REASON, "entry %zu is not a UTF-8 string", *n);
		else if ((strings[*n] = mem_strdup(s, &ignored)) != NULL) {
			++*n;
			continue;
		}
		mem_free_strings(strings, *n);
		strings = NULL;
	}
	return strings;
}

char *metalist_print(char *const *strings, size_t n)
{
	SCOPED_BY(json_release) cJSON *list = cJSON_CreateArray();
	int is_whole = list != NULL;

	for (size_t i = 0; i < n && is_whole; i++)
		is_whole = cJSON_AddItemToArray(list, cJSON_CreateString(strings[i]));
	return is_whole ? cJSON_PrintUnformatted(list) : NULL;
}
