#include "formats/splats/plyfile.h"

#include "base/mem.h"
#include "base/names.h"

#include <stdint.h>
#include <strings.h>

enum { HEADER_LIMIT = 1 << 20 };

static const struct {
	const char *name, *sized_name;
	size_t size;
} types[PLY_TYPES] = {
	[PLY_I8] = {"char", "int8", 1},
	[PLY_U8] = {"uchar", "uint8", 1},
	[PLY_I16] = {"short", "int16", 2},
	[PLY_U16] = {"ushort", "uint16", 2},
	[PLY_I32] = {"int", "int32", 4},
	[PLY_U32] = {"uint", "uint32", 4},
	[PLY_F32] = {"float", "float32", 4},
	[PLY_F64] = {"double", "float64", 8},
};

/* The next word of a line, cut off in place; "" at its end. */
static char *next_word(char **line)
{
	char *word = *line + strspn(*line, " \t\r"), *end = word + strcspn(word, " \t\r");

	*line = *end ? end + 1 : end;
	*end = 0;
	return word;
}

size_t plyfile_type_size(enum plyfile_type type)
{
	return types[type].size;
}

static int find_type(const char *word)
{
	for (int t = 0; t < PLY_TYPES; t++)
		if (!strcmp(word, types[t].name) || !strcmp(word, types[t].sized_name))
			return t;
	return -1;
}

static int read_format(struct plyfile *f, char *line, int number, struct err *e)
{
	static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
	const char *name = next_word(&line), *version = next_word(&line);

	for (int i = 0; i < 3; i++)
		if (!strcmp(name, names[i]) && !strcmp(version, "1.0")) {
			f->encoding = (enum plyfile_encoding)i;
			return 0;
		}
	return err_set(e, ERR_FORMAT,
		"%s:%d: format '%.40s %.40s' is not ascii, binary_little_endian or binary_big_endian 1.0",
		f->path, number, name, version);
}

static int read_element(struct plyfile *f, char *line, int number, struct err *e)
{
	const char *name = next_word(&line), *count = next_word(&line);
	size_t rows = 0;

	if (!*name || !*count || count[strspn(count, "0123456789")])
		return err_set(e, ERR_FORMAT, "%s:%d: not 'element NAME COUNT'", f->path, number);
	for (const char *p = count; *p; p++)
		if (mem_size(rows, 10, &rows) || (rows += (size_t)(*p - '0')) > PTRDIFF_MAX)
			return err_set(e, ERR_FORMAT,
				"%s:%d: element '%.80s': %.40s rows do not fit in memory", f->path, number,
				name, count);
	if (mem_grow((void **)&f->elements, &f->capacity, f->n + 1, sizeof *f->elements, f->path, e))
		return -1;
	f->elements[f->n++] = (struct plyfile_element){.name = name, .line = number, .rows = rows};
	return 0;
}

static int read_property(struct plyfile *f, char *line, int number, struct err *e)
{
	struct plyfile_element *el = f->n ? &f->elements[f->n - 1] : NULL;
	struct plyfile_property p = {.line = number};
	const char *word = next_word(&line);
	int type, count_type = PLY_U8;

	if (!el)
		return err_set(e, ERR_FORMAT, "%s:%d: property before any element", f->path, number);
	p.is_list = !strcmp(word, "list");
	if (p.is_list) {
		word = next_word(&line);
		count_type = find_type(word);
		if (count_type < 0 || count_type >= PLY_F32)
			return err_set(e, ERR_FORMAT, "%s:%d: list count type '%.40s' is not an integer type",
				f->path, number, word);
		word = next_word(&line);
	}
	type = find_type(word);
	if (type < 0)
		return err_set(e, ERR_FORMAT,
			"%s:%d: property type '%.40s' is unknown: export the scene with floats where it was made",
			f->path, number, word);
	p.type = (enum plyfile_type)type;
	p.count_type = (enum plyfile_type)count_type;
	p.name = next_word(&line);
	if (!*p.name)
		return err_set(e, ERR_FORMAT, "%s:%d: property without a name", f->path, number);
	if (mem_grow((void **)&el->properties, &el->capacity, el->n + 1, sizeof p, f->path, e))
		return -1;
	el->properties[el->n++] = p;
	el->has_list |= p.is_list;
	/* In ascii the shortest value is a digit and the blank after it (the last may lack that). */
	el->min_bytes += f->encoding == PLY_ASCII ? 2 : types[p.is_list ? p.count_type : p.type].size;
	return 0;
}

/* Whether text begins with one of the words, in any case. */
static int begins(const char *text, const char *const *words, size_t n)
{
	for (size_t i = 0; i < n; i++)
		if (!strncasecmp(text, words[i], strlen(words[i])))
			return 1;
	return 0;
}

/* Trainers say so how a scene is to be rendered; the last one counts. */
static void note_mode(struct plyfile *f, const char *comment)
{
	static const char *const keys[] = {"SplatRenderMode", "antialias", "train_flags"},
				 *const values[] = {"mip", "antialias", "1", "true", "yes", "on", "2dgs"};
	const char *value = comment + strcspn(comment, " \t\r:=");

	value += strspn(value, " \t\r:=");
	if (begins(comment, keys, 3))
		f->mode = !*value || begins(value, values, 7) ? comment : NULL;
}

/* One header line: 1 for end_header. */
static int read_line(struct plyfile *f, char *line, int number, struct err *e)
{
	const char *word = next_word(&line);

	if (number == 2)
		return !strcmp(word, "format")
			       ? read_format(f, line, number, e)
			       : err_set(e, ERR_FORMAT,
					 "%s:2: the second line is not 'format ...' (comments come after it)",
					 f->path);
	const int is_comment = !strcmp(word, "comment") || !strcmp(word, "obj_info");
	if (is_comment)
		note_mode(f, line + strspn(line, " \t"));
	if (!*word || is_comment)
		return 0;
	if (!strcmp(word, "element"))
		return read_element(f, line, number, e);
	if (!strcmp(word, "property"))
		return read_property(f, line, number, e);
	if (!strcmp(word, "end_header"))
		return 1;
	return err_set(e, ERR_FORMAT, "%s:%d: header line '%.40s' is unknown", f->path, number, word);
}

/* Elements have different names, and the properties of each. */
static int check_unique(const struct plyfile *f, struct err *e)
{
	size_t twice, earlier;

	if (names_find_twice(f->elements, sizeof *f->elements, offsetof(struct plyfile_element, name), f->n,
		    &twice, &earlier, e))
		return -1;
	if (twice != NAMES_NONE)
		return err_set(e, ERR_FORMAT, "%s:%d: element '%.80s' appears twice", f->path,
			f->elements[twice].line, f->elements[twice].name);
	for (size_t i = 0; i < f->n; i++) {
		const struct plyfile_element *el = &f->elements[i];
		if (names_find_twice(el->properties, sizeof *el->properties,
			    offsetof(struct plyfile_property, name), el->n, &twice, &earlier, e))
			return -1;
		if (twice != NAMES_NONE)
			return err_set(e, ERR_FORMAT, "%s:%d: property '%.80s' appears twice", f->path,
				el->properties[twice].line, el->properties[twice].name);
	}
	return 0;
}

static int read_header(struct plyfile *f, struct err *e)
{
	const char *data = (const char *)f->map.data;
	size_t len = f->map.len < HEADER_LIMIT ? f->map.len : HEADER_LIMIT, at = 0;

	if (len < 4 || memcmp(data, "ply", 3) ||
		(data[3] != '\n' && memcmp(data, "ply\r\n", len < 5 ? len : 5)))
		return err_file(e, f->path, "not a PLY file: the first line is not 'ply' and nothing else");
	f->header = mem_alloc(len + 1, 1, f->path, e);
	if (!f->header)
		return -1;
	memcpy(f->header, data, len);
	f->header[len] = 0;
	for (int number = 1;; number++) {
		const char *newline = memchr(data + at, '\n', len - at);
		if (!newline)
			return err_set(e, ERR_FORMAT, "%s:%d: the header has no end_header", f->path, number);
		char *line = f->header + at;
		size_t line_len = (size_t)(newline - data) - at;
		line[line_len] = 0;
		at += line_len + 1;
		if (strlen(line) != line_len)
			return err_set(e, ERR_FORMAT, "%s:%d: a NUL byte in the header", f->path, number);
		if (number == 1)
			continue;
		int state = read_line(f, line, number, e);
		if (state < 0)
			return -1;
		if (state)
			break;
	}
	f->at = at;
	return check_unique(f, e);
}

int plyfile_open(struct plyfile *f, const char *name, struct file_map *map, struct err *e)
{
	*f = (struct plyfile){.path = name, .map = *map};
	*map = (struct file_map){0};
	return read_header(f, e);
}

void plyfile_close(struct plyfile *f)
{
	for (size_t i = 0; i < f->n; i++)
		free(f->elements[i].properties);
	file_unmap(&f->map);
	mem_free_all(f->elements, f->header);
	*f = (struct plyfile){0};
}

const struct plyfile_element *plyfile_find(const struct plyfile *f, const char *element)
{
	for (size_t i = 0; i < f->n; i++)
		if (!strcmp(f->elements[i].name, element))
			return &f->elements[i];
	return NULL;
}

long plyfile_property(const struct plyfile_element *el, const char *name)
{
	for (size_t i = 0; i < el->n; i++)
		if (!strcmp(el->properties[i].name, name))
			return (long)i;
	return -1;
}

long plyfile_need(const struct plyfile *f, const struct plyfile_element *el, const char *name, struct err *e)
{
	long i = plyfile_property(el, name);

	if (i < 0)
		return err_file(e, f->path, "element '%.80s' has no property '%s'", el->name, name);
	if (el->properties[i].is_list)
		return err_file(e, f->path, "property '%s' is a list", name);
	return i;
}
