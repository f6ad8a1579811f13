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
	for (size_t i = 0; i < s->object_count; i++)
		free(s->objects[i]);
	free(s->views);
	free(s->objects);
	free(s->view);
	free(s->kind);
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

/* A list of strings that may be absent or null: then *strings stays NULL. */
static int read_list(char ***strings, size_t *n, const struct jsonl *j, const cJSON *object, const char *key,
	struct err *e)
{
	const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, key), *item;

	if (!list || cJSON_IsNull(list))
		return 0;
	if (!cJSON_IsArray(list))
		return jsonl_err(j, e, "key '%s' is not a list", key);
	*strings = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof **strings, j->path, e);
	if (!*strings)
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		if (!cJSON_IsString(item))
			return jsonl_err(j, e, "key '%s' holds something other than strings", key);
		(*strings)[*n] = copy_string(j, key, item->valuestring, 0, e);
		if (!(*strings)[*n])
			return -1;
		++*n;
	}
	return 0;
}

static int read_objects(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	if (read_list(&s->objects, &s->object_count, j, object, "objects", e))
		return -1;
	s->has_objects = s->objects != NULL;
	for (size_t i = 0; i < s->object_count; i++)
		for (size_t k = 0; k < i; k++)
			if (!strcmp(s->objects[i], s->objects[k]))
				return jsonl_err(j, e, "key 'objects' names '%s' twice", s->objects[i]);
	return 0;
}

/* The name of the target: where it is not given, that of the only object. What teaches has one. */
static int read_target(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	int is_free = s->has_objects && (s->object_count == 1 || s->split == SPLIT_TEST);
	const char *target = s->object_count == 1 ? s->objects[0] : "";
	int got = jsonl_string(j, object, "object", !is_free, &target, e);

	if (got < 0)
		return -1;
	if (got > 0 && s->object_count == 1 && strcmp(target, s->objects[0]))
		return jsonl_err(
			j, e, "key 'object' is '%s', but the one of 'objects' '%s'", target, s->objects[0]);
	s->object = copy_string(j, "object", target, !got, e);
	return s->object ? 0 : -1;
}

/* A name that may be absent or null: then *to stays NULL. */
static int read_name(char **to, const struct jsonl *j, const cJSON *object, const char *key, struct err *e)
{
	const char *name = NULL;

	if (jsonl_string(j, object, key, 0, &name, e) < 0)
		return -1;
	if (name && !(*to = copy_string(j, key, name, 0, e)))
		return -1;
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
	const char *ref, *text, *split = "train";

	if (has_nul_escape(j->line))
		return jsonl_err(j, e, "a NUL character (\\u0000) in a string");
	if (jsonl_string(j, object, "ref", 1, &ref, e) < 0 ||
		jsonl_string(j, object, "split", 0, &split, e) < 0)
		return -1;
	if (strcmp(split, "train") && strcmp(split, "test"))
		return jsonl_err(j, e, "key 'split' is '%s', not 'train' or 'test'", split);
	s->split = !strcmp(split, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	s->ref = copy_string(j, "ref", ref, 0, e);
	if (!s->ref || read_objects(s, j, object, e) || read_target(s, j, object, e) ||
		jsonl_string(j, object, "text", 1, &text, e) < 0)
		return -1;
	s->text = copy_string(j, "text", text, 1, e);
	return !s->text || read_list(&s->views, &s->view_count, j, object, "views", e) ||
			       read_name(&s->view, j, object, "view", e) ||
			       read_name(&s->kind, j, object, "kind", e)
		       ? -1
		       : 0;
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
