#include "cmd/render/draw.h"

#include "base/number.h"

#include <math.h>
#include <stdarg.h>
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

/* 1 right, 0 wrong, -1 where the model does not know what is meant. */
static int is_right(const struct request *r, size_t i)
{
	const struct responses *a = &r->responses;
	const size_t *begin = a->begin + a->answer[i];
	cJSON *names = meant_names(&r->text, r->refs[i]);
	const int right = meant_is(names, &r->model.lifted, a->objects + begin[0], begin[1] - begin[0]);

	cJSON_Delete(names);
	return right;
}

void overlay_words(const struct request *r, size_t i, double score, char *out, size_t size)
{
	const struct responses *a = &r->responses;
	const size_t k = a->answer[i];
	char percent[NUMBER_SIZE];

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
		say(out, size, ", %s", number_percent(percent, a->sure[i]));
}
