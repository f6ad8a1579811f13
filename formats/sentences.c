#include "formats/sentences.h"

#include "base/mem.h"
#include "base/utf8.h"
#include "formats/jsonl.h"

#include <stdlib.h>
#include <string.h>

static void sentence_free(struct sentence *s)
{
	for (size_t i = 0; i < s->view_count; i++)
		free(s->views[i]);
	free(s->views);
	free(s->ref);
	free(s->object);
	free(s->text);
}

void sentences_free(struct sentences *s)
{
	for (size_t i = 0; i < s->n; i++)
		sentence_free(&s->items[i]);
	free(s->items);
	*s = (struct sentences){0};
}

static char *copy_text(const struct jsonl *j, const char *value, struct err *e)
{
	size_t len = strlen(value), bad = utf8_check(value, len);

	if (bad < len) {
		jsonl_err(j, e, "key 'text' is not UTF-8 at byte %zu", bad + 1);
		return NULL;
	}
	return mem_strdup(value, e);
}

static char *copy_view(const struct jsonl *j, const char *value, struct err *e)
{
	char fault[NAME_FAULT];
	const char *reason = name_fault(value, NAME_VIEW, fault);

	if (reason) {
		jsonl_err(j, e, "key 'views': item '%s' %s", value, reason);
		return NULL;
	}
	return mem_strdup(value, e);
}

static int read_views(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, "views"), *view;

	if (!list || cJSON_IsNull(list))
		return 0;
	if (!cJSON_IsArray(list))
		return jsonl_err(j, e, "key 'views' is not a list");
	s->views = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof *s->views, j->path, e);
	if (!s->views)
		return -1;
	cJSON_ArrayForEach(view, list)
	{
		if (!cJSON_IsString(view))
			return jsonl_err(j, e, "key 'views' holds something other than strings");
		s->views[s->view_count] = copy_view(j, view->valuestring, e);
		if (!s->views[s->view_count])
			return -1;
		s->view_count++;
	}
	return 0;
}

static int read_one(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	const char *text, *split = "train";

	if (jsonl_name(j, object, "ref", NAME_DATA, 1, &s->ref, e) ||
		jsonl_name(j, object, "object", NAME_DATA, 1, &s->object, e) ||
		jsonl_string(j, object, "text", 1, &text, e) < 0 ||
		jsonl_string(j, object, "split", 0, &split, e) < 0)
		return -1;
	if (strcmp(split, "train") && strcmp(split, "test"))
		return jsonl_err(j, e, "key 'split' is '%s', not 'train' or 'test'", split);
	s->split = !strcmp(split, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	s->text = copy_text(j, text, e);
	return s->text ? read_views(s, j, object, e) : -1;
}

struct ref_place {
	const char *ref;
	long line;
};

static int by_ref(const void *a, const void *b)
{
	const struct ref_place *x = a, *y = b;
	int order = strcmp(x->ref, y->ref);

	return order ? order : (x->line > y->line) - (x->line < y->line);
}

/* Sorts the places; two equal refs then stand side by side, the earlier line first. */
static int check_unique(struct ref_place *places, size_t n, const char *path, struct err *e)
{
	const struct ref_place *found = NULL;

	if (!places)
		return 0;
	qsort(places, n, sizeof *places, by_ref);
	for (size_t i = 1; i < n; i++)
		if (!strcmp(places[i - 1].ref, places[i].ref) && (!found || places[i].line < found->line))
			found = &places[i];
	if (!found)
		return 0;
	return err_set(e, ERR_FORMAT, "%s:%ld: ref '%s' is already on line %ld", path, found->line,
		found->ref, found[-1].line);
}

static int read_all(struct sentences *s, struct jsonl *j, struct err *e)
{
	struct ref_place *places = NULL;
	size_t capacity = 0, place_capacity = 0;
	cJSON *object;
	int got;

	while ((got = jsonl_next(j, &object, e)) > 0) {
		struct sentence one = {0};
		int bad = read_one(&one, j, object, e) ||
			  mem_grow((void **)&s->items, &capacity, s->n + 1, sizeof *s->items, j->path, e) ||
			  mem_grow((void **)&places, &place_capacity, s->n + 1, sizeof *places, j->path, e);
		cJSON_Delete(object);
		if (bad) {
			sentence_free(&one);
			free(places);
			return -1;
		}
		places[s->n] = (struct ref_place){one.ref, j->line_number};
		s->items[s->n++] = one;
	}
	if (!got && !s->n)
		got = err_set(e, ERR_FORMAT, "%s: holds no sentences", j->path);
	if (!got)
		got = check_unique(places, s->n, j->path, e);
	free(places);
	return got;
}

int sentences_read(struct sentences *s, const char *path, struct err *e)
{
	struct jsonl j;

	*s = (struct sentences){0};
	if (jsonl_open(&j, path, e))
		return -1;
	int bad = read_all(s, &j, e);
	jsonl_close(&j);
	if (bad)
		sentences_free(s);
	return bad;
}
