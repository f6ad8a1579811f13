#include "cmd/jobs/overlay_words.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Appends, as far as there is room. */
static void say(char *out, size_t size, const char *format, ...)
{
	const size_t at = strlen(out);
	va_list args;

	va_start(args, format);
	vsnprintf(out + at, size - at, format, args);
	va_end(args);
}

/* The names that the sentence's record has for what it means; cJSON_Delete. NULL where it has none. */
static cJSON *meant(const struct text *t, size_t sentence)
{
	const char *list = t->object_lists ? t->object_lists[sentence] : "",
		   *object = text_object(t, sentence);

	if (*list)
		return cJSON_Parse(list);
	return object && *object ? cJSON_CreateStringArray(&object, 1) : NULL;
}

static int has_object(const struct lifted *l, const char *name)
{
	for (size_t o = 0; o < l->objects; o++)
		if (!strcmp(l->names[o], name))
			return 1;
	return 0;
}

static int is_answer(const struct request *r, size_t i, const char *name)
{
	const struct responses *a = &r->responses;
	const size_t k = a->answer[i];

	for (size_t at = a->begin[k]; at < a->begin[k + 1]; at++)
		if (!strcmp(r->model.lifted.names[a->objects[at]], name))
			return 1;
	return 0;
}

/* 1 right, 0 wrong, -1 where the model does not know what is meant. */
static int is_right(const struct request *r, size_t i)
{
	const size_t k = r->responses.answer[i];
	const int answered = (int)(r->responses.begin[k + 1] - r->responses.begin[k]);
	cJSON *names = meant(&r->text, r->refs[i]);
	const cJSON *one;
	int right = names ? cJSON_GetArraySize(names) == answered : -1;

	cJSON_ArrayForEach(one, names)
	{
		const char *name = cJSON_GetStringValue(one);
		if (!name || !has_object(&r->model.lifted, name))
			right = -1;
		else if (right > 0)
			right = is_answer(r, i, name);
	}
	cJSON_Delete(names);
	return right;
}

void overlay_words(const struct request *r, size_t i, double score, char *out, size_t size)
{
	const struct responses *a = &r->responses;
	const size_t k = a->answer[i];

	*out = 0;
	if (!a->begin) {
		say(out, size, "score %.2f", isfinite(score) ? score : 0);
		return;
	}
	for (size_t at = a->begin[k]; at < a->begin[k + 1]; at++)
		say(out, size, "%s%s", at > a->begin[k] ? ", " : "", r->model.lifted.names[a->objects[at]]);
	if (a->begin[k] == a->begin[k + 1])
		say(out, size, "nothing here is that");
	const int right = is_right(r, i);
	if (right >= 0)
		say(out, size, right ? ": right" : ": wrong");
	if (a->sure && a->begin[k] < a->begin[k + 1])
		say(out, size, ", %.0f%%", 100 * a->sure[i]);
}
