#include "cmd/render/request.h"

#include <string.h>

cJSON *meant_names(const struct text *t, size_t sentence)
{
	const char *list = t->object_lists ? t->object_lists[sentence] : "",
		   *object = text_object(t, sentence);

	if (*list)
		return cJSON_Parse(list);
	return object ? cJSON_CreateStringArray(&object, 1) : NULL;
}

static int has_name(const cJSON *list, const char *name)
{
	const cJSON *one;

	cJSON_ArrayForEach(one, list) if (!strcmp(cJSON_GetStringValue(one), name)) return 1;
	return 0;
}

/* Whether the model has all objects of these names. */
static int are_known(const struct lifted *l, const cJSON *names)
{
	const cJSON *one;

	cJSON_ArrayForEach(one, names)
	{
		size_t o = 0;
		while (o < l->objects && strcmp(l->names[o], cJSON_GetStringValue(one)))
			o++;
		if (o == l->objects)
			return 0;
	}
	return 1;
}

int meant_is(const cJSON *meant, const struct lifted *l, const cJSON *answered)
{
	const cJSON *one;

	if (!meant || !are_known(l, meant))
		return -1;
	if (cJSON_GetArraySize(meant) != cJSON_GetArraySize(answered))
		return 0;
	cJSON_ArrayForEach(one, meant) if (!has_name(answered, cJSON_GetStringValue(one))) return 0;
	return 1;
}
