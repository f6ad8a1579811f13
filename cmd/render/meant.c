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

/* The object that a model calls so; `objects` where there is none. */
static size_t find_object(const struct lifted *l, const char *name)
{
	size_t o = 0;

	while (o < l->objects && strcmp(l->names[o], name))
		o++;
	return o;
}

int meant_is(const cJSON *meant, const struct lifted *l, const size_t *things, size_t count)
{
	const cJSON *one;
	int found = 0;

	cJSON_ArrayForEach(one, meant)
	{
		const char *name = cJSON_GetStringValue(one);
		if (find_object(l, name) == l->objects)
			return -1;
		size_t k = 0;
		while (k < count && strcmp(l->names[things[k]], name))
			k++;
		found += k < count;
	}
	const int n = cJSON_GetArraySize(meant);
	return meant ? found == n && (size_t)n == count : -1;
}
