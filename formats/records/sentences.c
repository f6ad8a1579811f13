#include "formats/records/sentences.h"

#include "base/mem.h"
#include "base/path.h"
#include "base/utf8.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"

static void sentence_free(void *record)
{
	const struct sentence *s = record;

	mem_free_strings(s->views, s->view_count);
	mem_free_strings(s->objects, s->object_count);
	mem_free_all(s->view, s->kind, s->ref, s->object, s->text);
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
	char *text = mem_strdup(value, e);
	if (text)
		utf8_plain(text);
	return text;
}

static char *copy_item(
	const struct jsonl *j, const char *key, enum name_kind kind, const char *value, struct err *e)
{
	char fault[NAME_FAULT];
	const char *reason = name_fault(value, kind, fault);

	if (reason) {
		jsonl_err(j, e, "key '%s': item '%s' %s", key, value, reason);
		return NULL;
	}
	return name_copy(value, e);
}

/* A list of strings that may be absent or null: then *strings stays NULL. */
static int read_list(char ***strings, size_t *n, const struct jsonl *j, const cJSON *object, const char *key,
	enum name_kind kind, struct err *e)
{
	const cJSON *list = json_member(object, key), *item;

	if (!list)
		return 0;
	if (!cJSON_IsArray(list))
		return jsonl_err(j, e, "key '%s' is not a list", key);
	*strings = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof **strings, j->path, e);
	if (!*strings)
		return -1;
	cJSON_ArrayForEach(item, list)
	{
		char digits[NUMBER_SIZE];
		const char *text = jsonl_name_text(item, digits);
		if (!text)
			return jsonl_err(j, e, "key '%s' holds something other than strings", key);
		(*strings)[*n] = copy_item(j, key, kind, text, e);
		if (!(*strings)[*n])
			return -1;
		++*n;
	}
	return 0;
}

static int read_objects(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	if (read_list(&s->objects, &s->object_count, j, object, "objects", NAME_DATA, e))
		return -1;
	s->has_objects = s->objects != NULL;
	for (size_t i = 0; i < s->object_count; i++)
		for (size_t k = 0; k < i; k++)
			if (!strcmp(s->objects[i], s->objects[k]))
				return jsonl_err(j, e, "key 'objects' names '%s' twice", s->objects[i]);
	return 0;
}

/* The name of the target: where it is not given, that of the only object. What teaches has one, or means
 * nothing.
 */
static int read_target(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	const int is_free = s->has_objects && (s->object_count <= 1 || s->split == SPLIT_TEST);
	const char *only = s->object_count == 1 ? s->objects[0] : "";

	if (jsonl_name(j, object, "object", NAME_DATA, !is_free, &s->object, e))
		return -1;
	if (s->object && s->object_count == 1 && strcmp(s->object, only))
		return jsonl_err(
			j, e, "key 'object' is '%s', but the one of 'objects' '%s'", s->object, only);
	if (!s->object)
		s->object = mem_strdup(only, e);
	return s->object ? 0 : -1;
}

static int read_when(struct sentence *s, const struct jsonl *j, const cJSON *object, struct err *e)
{
	const cJSON *when = json_member(object, "when");

	if (!when)
		return 0;
	s->has_when = 1;
	return json_numbers(when, 2, s->when) || s->when[1] < s->when[0]
		       ? jsonl_err(j, e, "key 'when' is not [from,to]")
		       : 0;
}

static int read_one(const struct jsonl *j, const cJSON *object, void *record, struct err *e)
{
	struct sentence *s = record;
	const char *text, *split = "train";

	if (jsonl_name(j, object, "ref", NAME_DATA, 1, &s->ref, e) ||
		json_string(object, "split", 0, &split, j->where, e) < 0)
		return -1;
	if (strcmp(split, "train") && strcmp(split, "test"))
		return jsonl_err(j, e, "key 'split' is '%s', not 'train' or 'test'", split);
	s->split = !strcmp(split, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	if (read_objects(s, j, object, e) || read_target(s, j, object, e) ||
		json_string(object, "text", 1, &text, j->where, e) < 0)
		return -1;
	s->text = copy_text(j, text, e);
	return -(!s->text || read_when(s, j, object, e) ||
		 read_list(&s->views, &s->view_count, j, object, "views", NAME_VIEW, e) ||
		 jsonl_name(j, object, "view", NAME_VIEW, 0, &s->view, e) ||
		 jsonl_name(j, object, "kind", NAME_DATA, 0, &s->kind, e));
}

static int read_all(struct sentences *s, struct jsonl *j, struct err *e)
{
	SCOPED long *lines = NULL;
	int bad = jsonl_records(
		j, sizeof *s->items, read_one, sentence_free, (void **)&s->items, &s->n, &lines, e);

	return bad || jsonl_check_refs(
			      j, s->items, sizeof *s->items, offsetof(struct sentence, ref), s->n, lines, e)
		       ? -1
		       : 0;
}

/* Whether a line may be a row of a table: a number and a comma, no blank after a comma, or bars between
 * cells. */
static int has_cells(const char *line)
{
	const size_t digits = strspn(line, "0123456789");

	if (digits && line[digits] && strchr(",;", line[digits]))
		return 1;
	for (; *line; line++)
		if (*line == '|' || (strchr(",;", *line) && line[1] && !strchr(" \t0123456789", line[1])))
			return 1;
	return 0;
}

/* A line's sentence, cut in place: without a list's mark or number before it ("- ", "12. ", "12) ", "12: ",
 * or "12" and a tab), and without quotes around it. NULL of a comment. */
static char *bare_line(char *line)
{
	static const char *const marks[] = {"- ", "* ", "\xe2\x80\xa2 "};
	char *quote;

	line += strspn(line, " ");
	if (*line == '#' && strchr("# \t", line[1]))
		return NULL;
	for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
		line += strncmp(line, marks[i], strlen(marks[i])) ? 0 : strlen(marks[i]);
	char *end = line + strspn(line, "0123456789");
	const int is_marked = *end && strchr(".):", *end);
	const size_t blanks = strspn(end + is_marked, " \t");
	if (end > line && blanks && (is_marked || *end == '\t'))
		line = end + is_marked + blanks;
	if (*line == '"' && (quote = strchr(line + 1, '"')) && !quote[1]) {
		*quote = 0;
		line++;
	}
	return line;
}

static int read_line(struct sentences *s, size_t *capacity, const struct jsonl *j, char *line, struct err *e)
{
	const size_t len = strlen(line), bad = utf8_check(line, len);
	char ref[24], fault[NAME_FAULT];

	if (strchr(line, '\t'))
		return err_file(e, j->path, "a table: write a sentence on each line, or JSON Lines");
	if (bad < len)
		return jsonl_err(j, e, "not UTF-8 at byte %zu: save the file as UTF-8",
			(size_t)(line - j->line) + bad + 1);
	utf8_plain(line);
	const char *reason = name_fault(line, NAME_DATA, fault);
	if (reason)
		return jsonl_err(j, e, "a sentence that %s: is the file text?", reason);
	snprintf(ref, sizeof ref, "%ld", j->line_number);
	if (mem_grow((void **)&s->items, capacity, s->n + 1, sizeof *s->items, j->path, e))
		return -1;
	struct sentence *one = &s->items[s->n++];
	*one = (struct sentence){.split = SPLIT_TEST, .ref = mem_strdup(ref, e)};
	return one->ref && (one->object = mem_strdup("?", e)) && (one->text = mem_strdup(line, e)) ? 0 : -1;
}

static int read_plain(struct sentences *s, struct jsonl *j, struct err *e)
{
	static const char *const kinds[] = {".csv", ".tsv", ".yaml", ".yml", ".html", ".rtf", ".docx"};
	size_t capacity = 0, rows = 0, kind = 0;
	int got;

	while ((got = jsonl_text(j, e)) > 0) {
		char *line = bare_line(j->line);
		rows += line && has_cells(line);
		if (line && read_line(s, &capacity, j, line, e))
			return -1;
	}
	while (kind < sizeof kinds / sizeof *kinds && !path_ends(j->path, kinds[kind]))
		kind++;
	if (!got && (kind < sizeof kinds / sizeof *kinds || (rows > 1 && rows + 1 >= s->n)))
		return err_file(e, j->path, "a table: write a sentence on each line, or JSON Lines");
	return got;
}

/* Whether the file's text begins as JSON may; -1 with *e. */
static int is_json(struct jsonl *j, struct err *e)
{
	const int got = jsonl_peek(j, e);

	return got < 0 ? -1 : !got || strchr("{[", j->line[strspn(j->line, " \t")]);
}

static int read_file(struct sentences *s, const char *path, int is_any, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};

	*s = (struct sentences){0};
	if (jsonl_open(&j, path, e))
		return -1;
	const int json = is_any ? is_json(&j, e) : 1;
	int bad = json < 0 ? -1 : json ? read_all(s, &j, e) : read_plain(s, &j, e);
	if (!bad && !s->n)
		bad = err_file(e, j.path, "holds no sentences");
	return bad;
}

int sentences_read(struct sentences *s, const char *path, struct err *e)
{
	return read_file(s, path, 0, e);
}

int sentences_read_any(struct sentences *s, const char *path, struct err *e)
{
	return read_file(s, path, 1, e);
}

int sentences_add(struct sentences *s, const char *ref, const char *object, const char *text, struct err *e)
{
	size_t capacity = s->n;

	if (mem_grow((void **)&s->items, &capacity, s->n + 1, sizeof *s->items, "sentences", e))
		return -1;
	struct sentence *one = &s->items[s->n++];
	*one = (struct sentence){0};
	one->ref = mem_strdup(ref, e);
	one->object = one->ref ? mem_strdup(object, e) : NULL;
	one->text = one->object ? mem_strdup(text, e) : NULL;
	return one->text ? 0 : -1;
}
