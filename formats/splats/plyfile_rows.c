/* The rows of a PLY file's elements, one after another. */
#include "base/little.h"
#include "base/mem.h"
#include "formats/splats/plyfile.h"

#include <ctype.h>
#include <math.h>

int plyfile_check_rows(const struct plyfile *f, const struct plyfile_element *el, struct err *e)
{
	size_t bytes, left = f->map.len - f->at;

	if (f->encoding == PLY_ASCII)
		left++; /* no blank is needed after the file's last value */
	if (mem_size(el->rows, el->min_bytes, &bytes) || bytes > left)
		return err_file(e, f->path,
			"element '%.80s': %zu rows of %s%zu bytes from offset %zu do not fit a file of %zu",
			el->name, el->rows, el->has_list || f->encoding == PLY_ASCII ? "at least " : "",
			el->min_bytes, f->at, f->map.len);
	return 0;
}

static int err_short(const struct plyfile *f, const struct plyfile_element *el, size_t row, struct err *e)
{
	return err_file(e, f->path, "element '%.80s': the file ends at offset %zu, within row %zu of %zu",
		el->name, f->map.len, row, el->rows);
}

static double decode(const unsigned char *p, enum plyfile_type type, int is_big)
{
	const int size = (int)plyfile_type_size(type);
	unsigned char turned[8];

	for (int i = 0; is_big && i < size; i++)
		turned[i] = p[size - 1 - i];
	p = is_big ? turned : p;
	switch (type) {
	case PLY_I8:
		return (int8_t)*p;
	case PLY_I16:
		return (int16_t)little_get(p, size);
	case PLY_I32:
		return (int32_t)little_get(p, size);
	case PLY_F32:
		return little_get_f32(p);
	case PLY_F64:
		return little_get_f64(p);
	default:
		return (double)little_get(p, size);
	}
}

double plyfile_value(const struct plyfile *f, size_t at, enum plyfile_type type)
{
	return decode(f->map.data + at, type, f->encoding == PLY_BIG);
}

/* The next value at f->at: 0, or -1 with *e. */
static int next_value(struct plyfile *f, const struct plyfile_element *el, size_t row, enum plyfile_type type,
	double *value, struct err *e)
{
	const unsigned char *data = f->map.data;
	char word[64], *end;
	size_t len = 0;

	if (f->encoding != PLY_ASCII) {
		if (plyfile_type_size(type) > f->map.len - f->at)
			return err_short(f, el, row, e);
		*value = plyfile_value(f, f->at, type);
		f->at += plyfile_type_size(type);
		return 0;
	}
	while (f->at < f->map.len && isspace(data[f->at]))
		f->at++;
	if (f->at == f->map.len)
		return err_short(f, el, row, e);
	while (f->at + len < f->map.len && len < sizeof word - 1 && !isspace(data[f->at + len])) {
		word[len] = (char)data[f->at + len];
		len++;
	}
	word[len] = 0;
	*value = strtod(word, &end);
	if (end == word || *end || len == sizeof word - 1)
		return err_file(e, f->path, "element '%.80s', row %zu: no number at offset %zu", el->name,
			row, f->at);
	f->at += len;
	return 0;
}

/* Passes over the `count` items of a list. */
static int skip_items(struct plyfile *f, const struct plyfile_element *el, size_t row, enum plyfile_type type,
	double count, struct err *e)
{
	double unused;

	if (!(count >= 0 && count <= 4294967295.0) || count != floor(count))
		return err_file(e, f->path, "element '%.80s', row %zu: a list of %g items, before offset %zu",
			el->name, row, count, f->at);
	if (f->encoding == PLY_ASCII) {
		for (size_t i = 0; i < (size_t)count; i++)
			if (next_value(f, el, row, type, &unused, e))
				return -1;
		return 0;
	}
	if ((size_t)count > (f->map.len - f->at) / plyfile_type_size(type))
		return err_short(f, el, row, e);
	f->at += (size_t)count * plyfile_type_size(type);
	return 0;
}

int plyfile_row(
	struct plyfile *f, const struct plyfile_element *el, size_t row, double *values, struct err *e)
{
	for (size_t i = 0; i < el->n; i++) {
		const struct plyfile_property *p = &el->properties[i];
		if (next_value(f, el, row, p->is_list ? p->count_type : p->type, &values[i], e) ||
			(p->is_list && skip_items(f, el, row, p->type, values[i], e)))
			return -1;
	}
	return 0;
}

int plyfile_skip(struct plyfile *f, const struct plyfile_element *el, struct err *e)
{
	if (!el->n)
		return 0;
	if (plyfile_check_rows(f, el, e))
		return -1;
	if (!el->has_list && f->encoding != PLY_ASCII) {
		f->at += el->rows * el->min_bytes;
		return 0;
	}
	SCOPED double *values = mem_alloc(el->n, sizeof *values, f->path, e);
	int bad = values ? 0 : -1;
	for (size_t i = 0; !bad && i < el->rows; i++)
		bad = plyfile_row(f, el, i, values, e);
	return bad;
}

int plyfile_end(const struct plyfile *f, struct err *e)
{
	size_t at = f->at;

	while (at < f->map.len && (isspace(f->map.data[at]) || !f->map.data[at]))
		at++;
	if (at < f->map.len)
		return err_file(
			e, f->path, "%zu bytes after the last element, from offset %zu", f->map.len - at, at);
	return 0;
}
