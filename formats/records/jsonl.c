#include "formats/records/jsonl.h"

#include "base/file.h"
#include "base/jsontext.h"
#include "base/mem.h"
#include "base/names.h"
#include "base/number.h"
#include "base/textfile.h"
#include "formats/records/foreign.h"
#include "formats/records/json.h"

#include <math.h>
#include <stdarg.h>
#include <sys/types.h>

int jsonl_open(struct jsonl *j, const char *path, struct err *e)
{
	*j = (struct jsonl){.path = file_name(path)};
	j->in = file_open(path, e);
	return j->in ? 0 : -1;
}

void jsonl_close(struct jsonl *j)
{
	file_close(j->in);
	mem_free_all(j->line, j->text);
	*j = (struct jsonl){0};
}

int jsonl_err(const struct jsonl *j, struct err *e, const char *format, ...)
{
	char reason[512];
	va_list ap;

	va_start(ap, format);
	vsnprintf(reason, sizeof reason, format, ap);
	va_end(ap);
	return err_set(e, ERR_FORMAT, "%s:%ld: %s", j->path, j->line_number, reason);
}

static ssize_t read_line(struct jsonl *j, struct err *e);

/* After `used` bytes of UTF-16 in j->line: reads on from all of the text as UTF-8. */
static int decode_rest(struct jsonl *j, size_t used, struct err *e)
{
	size_t got = used;

	while (got) {
		if (mem_grow((void **)&j->line, &j->capacity, used + 65536 + 1, 1, j->path, e))
			return -1;
		used += got = fread(j->line + used, 1, j->capacity - used - 1, j->in);
	}
	if (ferror(j->in))
		return err_errno(e, "%s", j->path);
	j->line[used] = 0;
	j->text = j->line;
	j->line = NULL;
	j->capacity = 0;
	if (textfile_decode(&j->text, &used, j->path, e))
		return -1;
	FILE *in = fmemopen(j->text, used ? used : 1, "r"); /* of no text, the NUL after it */
	if (!in)
		return err_errno(e, "%s", j->path);
	file_close(j->in);
	j->in = in;
	return 0;
}

/* The next line, with a NUL after it: its length, 0 at the end, -1 with *e. Nothing of a line that is too
 * long is kept beyond the limit. */
static ssize_t read_line(struct jsonl *j, struct err *e)
{
	size_t len = 0;
	int byte = 0;

	while (byte != '\n' && (byte = getc_unlocked(j->in)) != EOF) {
		if (len == JSONL_LINE_MAX) {
			j->line_number++;
			return jsonl_err(j, e, "a line of more than %d bytes", JSONL_LINE_MAX);
		}
		if (len + 2 > j->capacity &&
			mem_grow((void **)&j->line, &j->capacity, len + 2, 1, j->path, e))
			return -1;
		j->line[len++] = (char)byte;
		if (byte == '\r') { /* without a newline after it, it ends a line by itself */
			const int next = getc_unlocked(j->in);
			ungetc(next, j->in);
			byte = next == '\n' ? byte : '\n';
		}
	}
	if (ferror(j->in))
		return err_errno(e, "%s", j->path);
	if (len)
		j->line[len] = 0;
	const int is_first = !j->line_number && !j->text;
	if (is_first && textfile_is_wide(j->line, len))
		return decode_rest(j, len, e) ? -1 : read_line(j, e);
	if (is_first && textfile_decode(&j->line, &len, j->path, e))
		return -1;
	return (ssize_t)len;
}

/* The next line that is not blank: its length, 0 at the end, -1 with *e. */
static ssize_t next_line(struct jsonl *j, struct err *e)
{
	const size_t peeked = j->peeked;

	j->peeked = 0;
	while (!peeked) {
		ssize_t len = read_line(j, e);
		if (len <= 0)
			return len;
		j->line_number++;
		if ((size_t)len != strlen(j->line))
			return jsonl_err(j, e, "a NUL byte at column %zu", strlen(j->line) + 1);
		if (strspn(j->line, " \t\r\n") < (size_t)len)
			return len;
	}
	return (ssize_t)peeked;
}

int jsonl_peek(struct jsonl *j, struct err *e)
{
	const ssize_t len = next_line(j, e);

	j->peeked = len > 0 ? (size_t)len : 0;
	return len < 0 ? -1 : len > 0;
}

/* A file of another program, which is one JSON value over many lines, or on the first. */
static int check_foreign(const struct jsonl *j, const cJSON *first, struct err *e)
{
	struct err ignored;
	SCOPED_BY(json_release) cJSON *whole = first ? NULL : json_read(j->path, &ignored);
	const cJSON *root = first ? first : whole;
	const int is_list = cJSON_IsArray(root);

	if (!root || foreign_json(root, j->path, e))
		return root ? -1 : 0;
	if (!is_list && root == first)
		return 0;
	return err_file(e, j->path, "%s, not one on each line: 'jq %s %s' writes it so",
		is_list ? "a list" : "an object over several lines",
		cJSON_IsString(root->child) && is_list ? "-r .[]"
		: is_list			       ? "-c .[]"
						       : "-c .",
		j->path);
}

int jsonl_next(struct jsonl *j, cJSON **object, struct err *e)
{
	const char *stop = NULL;
	ssize_t len = next_line(j, e);

	if (len <= 0)
		return (int)len;
	const int is_first = !j->records++;
	snprintf(j->where, sizeof j->where, "%s:%ld", j->path, j->line_number);
	*object = json_take(j->line, &stop);
	const int is_cut = json_has_nul(j->line);
	const char *twice = json_find_twice(*object);
	if (twice)
		len = jsonl_err(j, e, "key '%.80s' is there twice", twice);
	else if (is_first && check_foreign(j, *object, e))
		len = -1;
	else if (!*object)
		len = jsonl_err(j, e, "not JSON at column %td%s", stop ? stop - j->line + 1 : 1,
			json_hint(j->line, stop ? stop : j->line));
	else if (is_cut || !cJSON_IsObject(*object))
		len = jsonl_err(j, e, is_cut ? "a NUL character (\\u0000) in a string" : "not a JSON object");
	if (len > 0)
		return 1;
	cJSON_Delete(*object);
	*object = NULL;
	return -1;
}

int jsonl_records(struct jsonl *j, size_t size,
	int (*read)(const struct jsonl *j, const cJSON *object, void *record, struct err *e),
	void (*release)(void *record), void **records, size_t *n, long **lines, struct err *e)
{
	size_t capacity = 0, line_capacity = 0;
	long *at = NULL;
	cJSON *object;
	int got;

	*n = 0;
	*records = NULL;
	while ((got = jsonl_next(j, &object, e)) > 0) {
		int bad = mem_grow(records, &capacity, *n + 1, size, j->path, e) ||
			  mem_grow((void **)&at, &line_capacity, *n + 1, sizeof *at, j->path, e);
		if (!bad) {
			void *record = (char *)*records + *n * size;
			at[(*n)++] = j->line_number;
			bad = read(j, object, memset(record, 0, size), e);
		}
		cJSON_Delete(object);
		if (bad) {
			got = -1;
			break;
		}
	}
	for (size_t i = 0; got && i < *n; i++)
		release((char *)*records + i * size);
	if (got) {
		free(*records);
		*records = NULL;
		*n = 0;
	}
	if (lines)
		*lines = got ? NULL : at;
	if (got || !lines)
		free(at);
	return got;
}

int jsonl_check_refs(const struct jsonl *j, const void *records, size_t size, size_t offset, size_t n,
	const long *lines, struct err *e)
{
	size_t twice, earlier;
	const char *ref;

	if (names_find_twice(records, size, offset, n, &twice, &earlier, e))
		return -1;
	if (twice == NAMES_NONE)
		return 0;
	memcpy(&ref, (const char *)records + twice * size + offset, sizeof ref);
	return err_set(e, ERR_FORMAT, "%s:%ld: ref '%s' is already on line %ld", j->path, lines[twice], ref,
		lines[earlier]);
}

int jsonl_text(struct jsonl *j, struct err *e)
{
	ssize_t len = next_line(j, e);

	if (len <= 0)
		return (int)len;
	while (len && strchr("\r\n", j->line[len - 1]))
		j->line[--len] = 0;
	return 1;
}

const char *jsonl_name_text(const cJSON *item, char digits[NUMBER_SIZE])
{
	const double x = cJSON_IsNumber(item) ? item->valuedouble : NAN;

	if (!(fabs(x) < 1e15) || x != floor(x))
		return cJSON_GetStringValue(item);
	snprintf(digits, NUMBER_SIZE, "%.0f", x + 0.0);
	return digits;
}

int jsonl_name(const struct jsonl *j, const cJSON *object, const char *key, enum name_kind kind, int need,
	char **name, struct err *e)
{
	char fault[NAME_FAULT], digits[NUMBER_SIZE];
	const char *text = jsonl_name_text(json_get(object, key), digits);

	if (!text && json_string(object, key, need, &text, j->where, e) < 0)
		return -1;
	SCOPED char *copy = text ? name_copy(text, e) : NULL;
	if (!copy)
		return text ? -1 : 0;
	const char *trimmed = kind == NAME_DATA ? name_trim(copy) : copy,
		   *reason = name_fault(trimmed, kind, fault);
	if (reason)
		return jsonl_err(j, e, "key '%s' %s", key, reason);
	*name = mem_strdup(trimmed, e);
	return *name ? 0 : -1;
}

int jsonl_number(const struct jsonl *j, const cJSON *object, const char *key, double *number, struct err *e)
{
	*number = NAN;
	return -(json_number(object, key, 0, number, j->where, e) < 0);
}

void jsonl_put_string(FILE *out, const char *before, const char *text)
{
	fputs(before, out);
	jsontext_quote(out, text);
}

void jsonl_put_numbers(FILE *out, const char *before, const double *x, int n)
{
	char text[NUMBER_SIZE];

	for (int i = 0; i < n; i++)
		if (x[i] == floor(x[i]) && fabs(x[i]) < 1e9)
			fprintf(out, "%s%.0f", i ? "," : before, x[i] + 0.0);
		else
			fprintf(out, "%s%s", i ? "," : before, number_text(text, x[i]));
	fputc(']', out);
}
