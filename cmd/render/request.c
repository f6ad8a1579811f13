#include "cmd/render/request.h"

#include "base/list.h"
#include "base/mem.h"
#include "base/number.h"
#include "formats/records/json.h"

#include <math.h>
#include <stdarg.h>

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
	SCOPED_BY(json_release) cJSON *names = meant_names(&r->text, r->refs[i]);

	return meant_is(names, &r->model.lifted, a->objects + begin[0], begin[1] - begin[0]);
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

int request_read(struct request *r, const struct request_options *options, struct err *e)
{
	r->options = options;
	return -(scene_read(&r->scene, options->scene, e) || scene_move(&r->scene, options->time, e) ||
		 text_read(&r->text, options->text, e) || anymodel_read(&r->model, options->model, e));
}

int request_choose(struct request *r, struct err *e)
{
	const struct request_options *o = r->options;
	SCOPED char *chosen = mem_zalloc(r->text.n, 1, "sentences", e);
	struct list_name name;
	int bad = !chosen || !(r->refs = mem_alloc(r->text.n, sizeof *r->refs, "sentences", e)) ||
		  (o->refs && text_mark(&r->text, o->refs, "--refs", chosen, e));

	if (!bad && choose_without(o->without, &r->parts, &name))
		bad = err_set(e, ERR_USAGE, "--without: no part '%.*s'", (int)name.length, name.text);
	for (size_t i = 0; i < r->text.n && !bad; i++)
		if (o->refs ? chosen[i]
			    : o->sentences == REQUEST_ALL || (int)r->text.splits[i] == o->sentences)
			r->refs[r->count++] = i;
	return bad ? -1 : 0;
}

int request_viewpoint(const struct request *r, struct viewpoint *from, struct err *e)
{
	const char *text = r->options->viewpoint;

	if (viewpoint_read(from, text, &r->scene.cameras, r->scene.offset))
		return err_set(e, ERR_USAGE, "--viewpoint: '%s' is no view and no x,y,z", text);
	return 0;
}

int request_answer(struct request *r, const struct viewpoint *from, struct err *e)
{
	const struct request_options *o = r->options;
	const struct anymodel_ask ask = {&r->scene, &r->text, o->model, o->text, r->refs, r->count,
		!o->is_plain, r->parts, o->least, o->wants_parts, from, &r->memo};

	responses_free(&r->responses);
	if (anymodel_follow(&r->model, &r->scene, e) || anymodel_track(&r->model, &r->scene, e))
		return -1;
	return anymodel_answer(&r->model, &ask, &r->responses, e);
}

void request_free(struct request *r)
{
	scene_free(&r->scene);
	text_free(&r->text);
	anymodel_free(&r->model);
	responses_free(&r->responses);
	parser_memo_free(&r->memo);
	free(r->refs);
}
