#include "formats/sentences.h"

#include "base/mem.h"
#include "base/names.h"
#include "base/utf8.h"
#include "formats/jsonl.h"

#include <stddef.h>
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

static char *copy_string(
	const struct jsonl *j, const char *key, const char *value, int may_be_empty, struct err *e)
{
	size_t len = strlen(value), bad = utf8_check(value, len);

	if (bad < len) {
		jsonl_err(j, e, "key '%s' is not UTF-8 at byte %zu", key, bad + 1);
		return NULL;
	}
	if (!len && !may_be_empty) {
		jsonl_err(j, e, "key '%s' is empty", key);
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
		s->views[s->view_count] = copy_string(j, "views", view->valuestring, 0, e);
		if (!s->views[s->view_count])
			return -1;
		s->view_count++;
	}
	return 0;
}

/* A NUL that JSON writes as \u0000 would silently end the string there. */
static int has_nul_escape(const char *line)
{
	for (const char *p = strchr(line, '\\'); p; p = strchr(p + 2, '\\'))
		if (!strncmp(p, "\\u0000", 6))
			return 1;
	return 0;
}

static int read_one(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	const char *ref, *target, *text, *split = "train";

	if (has_nul_escape(j->line))
		return jsonl_err(j, e, "a NUL character (\\u0000) in a string");
	if (jsonl_string(j, object, "ref", 1, &ref, e) < 0 ||
		jsonl_string(j, object, "object", 1, &target, e) < 0 ||
		jsonl_string(j, object, "text", 1, &text, e) < 0 ||
		jsonl_string(j, object, "split", 0, &split, e) < 0)
		return -1;
	if (strcmp(split, "train") && strcmp(split, "test"))
		return jsonl_err(j, e, "key 'split' is '%s', not 'train' or 'test'", split);
	s->split = !strcmp(split, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	s->ref = copy_string(j, "ref", ref, 0, e);
	s->object = s->ref ? copy_string(j, "object", target, 0, e) : NULL;
	s->text = s->object ? copy_string(j, "text", text, 1, e) : NULL;
	return s->text ? read_views(s, j, object, e) : -1;
}

static int check_unique(const struct sentences *s, const long *lines, const char *path, struct err *e)
{
	struct names refs;
	size_t earlier;

	if (names_make(&refs, s->items, sizeof *s->items, offsetof(struct sentence, ref), s->n, e))
		return -1;
	const size_t twice = names_twice(&refs, &earlier);
	names_free(&refs);
	return twice == NAMES_NONE ? 0
				   : err_set(e, ERR_FORMAT, "%s:%ld: ref '%s' is already on line %ld", path,
					     lines[twice], s->items[twice].ref, lines[earlier]);
}

static int read_all(struct sentences *s, struct jsonl *j, struct err *e)
{
	long *lines = NULL;
	size_t capacity = 0, line_capacity = 0;
	cJSON *object;
	int got;

	while ((got = jsonl_next(j, &object, e)) > 0) {
		struct sentence one = {0};
		int bad = read_one(&one, j, object, e) ||
			  mem_grow((void **)&s->items, &capacity, s->n + 1, sizeof *s->items, j->path, e) ||
			  mem_grow((void **)&lines, &line_capacity, s->n + 1, sizeof *lines, j->path, e);
		cJSON_Delete(object);
		if (bad) {
			sentence_free(&one);
			free(lines);
			return -1;
		}
		lines[s->n] = j->line_number;
		s->items[s->n++] = one;
	}
	if (!got && !s->n)
		got = err_set(e, ERR_FORMAT, "%s: holds no sentences", j->path);
	if (!got)
		got = check_unique(s, lines, j->path, e);
	free(lines);
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
