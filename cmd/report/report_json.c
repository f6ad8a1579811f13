#include "cmd/report/reporting.h"

#include <stdlib.h>

int report_add(cJSON *to, const char *key, cJSON *value)
{
	if (value && cJSON_AddItemToObject(to, key, value))
		return 1;
	cJSON_Delete(value);
	return 0;
}

int report_json_put(FILE *out, const cJSON *value, struct err *e)
{
	char *json = cJSON_PrintUnformatted(value);

	if (!json)
		return err_set(e, ERR_SYSTEM, "page: out of memory");
	for (const char *at = json; *at; at++)
		if (*at == '<')
			fputs("\\u003c", out);
		else
			fputc(*at, out);
	free(json);
	return 0;
}
