#include "formats/arrays/npy.h"

#include "base/half.h"
#include "base/little.h"
#include "base/mem.h"

#include <ctype.h>

static const char MAGIC[6] = "\x93NUMPY";
enum {
	FIXED_BYTES = 10, /* magic, version, u16 length of the header */
	ALIGNMENT = 64,	  /* of the data, and so of everything before them */
	HEADER_ROOM = 310,
};

static const struct {
	char descr[4];
	size_t size;
} types[NPY_TYPES] = {[NPY_F16] = {"<f2", 2},
	[NPY_F32] = {"<f4", 4},
	[NPY_F64] = {"<f8", 8},
	[NPY_U8] = {"|u1", 1},
	[NPY_I8] = {"|i1", 1},
	[NPY_U16] = {"<u2", 2},
	[NPY_I16] = {"<i2", 2},
	[NPY_U32] = {"<u4", 4},
	[NPY_I32] = {"<i4", 4},
	[NPY_I64] = {"<i8", 8}};

/* A walk through the header's Python dict. `at` is an offset in the file. */
struct walk {
	const char *path, *data;
	size_t at, end;
	struct err *e;
};

static int walk_err(const struct walk *w, const char *reason)
{
	return err_file(w->e, w->path, "header, offset %zu: %s", w->at, reason);
}

static void skip_blank(struct walk *w)
{
	while (w->at < w->end && (w->data[w->at] == ' ' || w->data[w->at] == '\n'))
		w->at++;
}

/* 1 and past it when the next thing is this character. */
static int take(struct walk *w, char c)
{
	skip_blank(w);
	if (w->at >= w->end || w->data[w->at] != c)
		return 0;
	w->at++;
	return 1;
}

/* A quoted string without escapes; NULL where there is none. */
static const char *take_string(struct walk *w, size_t *len)
{
	char quote = take(w, '\'') ? '\'' : take(w, '"') ? '"' : 0;
	size_t begin = w->at;

	if (!quote)
		return NULL;
	const char *close = memchr(w->data + begin, quote, w->end - begin);
	if (!close)
		return NULL;
	*len = (size_t)(close - (w->data + begin));
	w->at = begin + *len + 1;
	return w->data + begin;
}

static int is_text(const char *text, size_t len, const char *expected)
{
	return text && len == strlen(expected) && !memcmp(text, expected, len);
}

static int take_word(struct walk *w, const char *word)
{
	size_t len = strlen(word);

	skip_blank(w);
	if (w->end - w->at < len || memcmp(w->data + w->at, word, len))
		return 0;
	w->at += len;
	return 1;
}

static int take_shape(struct walk *w, struct npy *a)
{
	a->dims = 0;
	a->count = 1;
	if (!take(w, '('))
		return walk_err(w, "'shape' is not a tuple");
	while (!take(w, ')')) {
		size_t side = 0, digits = 0;
		skip_blank(w);
		if (a->dims == NPY_MAX_DIMS)
			return walk_err(w, "'shape' has more than 8 dimensions");
		for (; w->at < w->end && isdigit((unsigned char)w->data[w->at]); w->at++, digits++) {
			if (mem_size(side, 10, &side))
				return walk_err(w, "'shape' is too large");
			side += (size_t)(w->data[w->at] - '0');
		}
		if (!digits)
			return walk_err(w, "'shape' is not a tuple of whole numbers");
		if (mem_size(a->count, side, &a->count))
			return walk_err(w, "'shape' is too large");
		a->shape[a->dims++] = side;
		if (!take(w, ',') && (w->at >= w->end || w->data[w->at] != ')'))
			return walk_err(w, "'shape' is not a tuple of whole numbers");
	}
	return 0;
}

/* -1 where it is none of ours. */
static int find_type(const char *text, size_t len)
{
	for (int t = 0; t < NPY_TYPES; t++)
		if (is_text(text, len, types[t].descr))
			return t;
	return -1;
}

static int take_type(struct walk *w, struct npy *a)
{
	size_t len = 0;

	skip_blank(w);
	const size_t begin = w->at;
	const char *text = take_string(w, &len);
	const int type = find_type(text, len);
	if (type >= 0) {
		a->type = (enum npy_type)type;
		return 0;
	}
	w->at = begin;
	return walk_err(w, "'descr' is no float or whole number, little-endian");
}

static int read_header(struct walk *w, struct npy *a)
{
	enum { HAVE_TYPE = 1, HAVE_ORDER = 2, HAVE_SHAPE = 4, HAVE_ALL = 7 };
	int have = 0;

	if (!take(w, '{'))
		return walk_err(w, "not a dict");
	while (!take(w, '}')) {
		size_t len = 0;
		const char *key = take_string(w, &len);
		if (!key || !take(w, ':'))
			return walk_err(w, "not a key and a colon");
		if (is_text(key, len, "descr")) {
			if (take_type(w, a))
				return -1;
			have |= HAVE_TYPE;
		} else if (is_text(key, len, "fortran_order")) {
			if (!take_word(w, "False"))
				return walk_err(w, "'fortran_order' is not False");
			have |= HAVE_ORDER;
		} else if (is_text(key, len, "shape")) {
			if (take_shape(w, a))
				return -1;
			have |= HAVE_SHAPE;
		} else {
			return walk_err(w, "a key other than 'descr', 'fortran_order' and 'shape'");
		}
		skip_blank(w);
		if (!take(w, ',') && (w->at >= w->end || w->data[w->at] != '}'))
			return walk_err(w, "not a comma or a closing brace");
	}
	skip_blank(w);
	if (w->at != w->end)
		return walk_err(w, "something follows the dict");
	if (have != HAVE_ALL)
		return walk_err(w, "'descr', 'fortran_order' or 'shape' is missing");
	return 0;
}

static int read_bytes(struct npy *a, const char *data, size_t len, const char *path, struct err *e)
{
	const unsigned char *u = (const unsigned char *)data;
	size_t begin = FIXED_BYTES, bytes;

	if (len < FIXED_BYTES || memcmp(data, MAGIC, sizeof MAGIC))
		return err_file(e, path, "not a .npy file: it does not begin with \\x93NUMPY");
	if ((u[6] != 1 && u[6] != 2) || u[7])
		return err_file(e, path, "offset 6: version %d.%d, expected 1.0 or 2.0", u[6], u[7]);
	size_t header = u[8] | (size_t)u[9] << 8;
	if (u[6] == 2) {
		begin = FIXED_BYTES + 2;
		if (len < begin)
			return err_file(e, path, "offset %zu: the file ends inside the header", len);
		header |= (size_t)u[10] << 16 | (size_t)u[11] << 24;
	}
	if (len - begin < header)
		return err_file(e, path, "offset %zu: the file ends inside the header", len);
	struct walk w = {path, data, begin, begin + header, e};
	if (read_header(&w, a))
		return -1;
	const size_t have = len - begin - header, size = types[a->type].size;
	if (mem_size(a->count, size, &bytes) || bytes != have)
		return err_file(e, path, "offset %zu: %zu bytes of data, the shape has %zu values of %zu",
			begin + header, have, a->count, size);
	a->data = u + begin + header;
	return 0;
}

int npy_open(struct npy *a, const char *path, struct err *e)
{
	*a = (struct npy){0};
	return -(file_map(path, &a->map, e) ||
		 read_bytes(a, (const char *)a->map.data, a->map.len, file_name(path), e));
}

int npy_open_bytes(struct npy *a, char *data, size_t len, const char *name, struct err *e)
{
	*a = (struct npy){.map = {(const unsigned char *)data, len, 0}};
	return read_bytes(a, data, len, name, e);
}

void npy_close(struct npy *a)
{
	file_unmap(&a->map);
	*a = (struct npy){0};
}

/* A number of `size` bytes with a sign. */
static double whole(const unsigned char *at, int size)
{
	const uint64_t bits = little_get(at, size), sign = (uint64_t)1 << (8 * size - 1);

	return (double)(int64_t)((bits ^ sign) - sign);
}

double npy_value(const struct npy *a, size_t i)
{
	const int size = (int)types[a->type].size;
	const unsigned char *at = a->data + i * (size_t)size;

	switch (a->type) {
	case NPY_F16:
		return (double)half_to_float((uint16_t)little_get(at, size));
	case NPY_F32:
		return (double)little_get_f32(at);
	case NPY_F64:
		return little_get_f64(at);
	case NPY_U8:
	case NPY_U16:
	case NPY_U32:
		return (double)little_get(at, size);
	default:
		return whole(at, size);
	}
}

void npy_floats(const struct npy *a, size_t first, size_t n, float *out)
{
	if (a->type == NPY_F32)
		memcpy(out, a->data + first * sizeof *out, n * sizeof *out);
	else
		for (size_t i = 0; i < n; i++)
			out[i] = (float)npy_value(a, first + i);
}

int npy_write(const char *path, const float *values, const size_t *shape, int dims, struct err *e)
{
	char header[FIXED_BYTES + HEADER_ROOM];
	struct file_out out;
	size_t count = 1;
	int used = FIXED_BYTES;

	used += snprintf(header + used, HEADER_ROOM, "{'descr': '<f4', 'fortran_order': False, 'shape': (");
	for (int i = 0; i < dims; i++) {
		if (mem_size(count, shape[i], &count))
			return err_set(e, ERR_SYSTEM, "%s: the array does not fit in memory", path);
		used += snprintf(header + used, 32, i ? ", %zu" : "%zu", shape[i]);
	}
	/* Python writes a tuple of one with a comma */
	used += snprintf(header + used, 32, dims == 1 ? ",), }" : "), }");
	while ((used + 1) % ALIGNMENT)
		header[used++] = ' ';
	header[used++] = '\n';
	memcpy(header, MAGIC, sizeof MAGIC);
	header[6] = 1;
	header[7] = 0;
	header[8] = (char)((used - FIXED_BYTES) & 255);
	header[9] = (char)((used - FIXED_BYTES) >> 8);
	if (file_out_open(&out, path, e))
		return -1;
	fwrite(header, 1, (size_t)used, out.stream);
	const int bad = fwrite(values, sizeof *values, count, out.stream) != count;
	return file_out_end(&out, bad ? err_errno(e, "%s", path) : 0, e);
}
