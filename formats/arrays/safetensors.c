#include "formats/arrays/safetensors.h"

#include "base/compare.h"
#include "base/little.h"
#include "base/mem.h"
#include "formats/records/json.h"

#include <cjson/cJSON.h>
#include <libdeflate.h>
#include <math.h>

static const struct {
	const char *name;
	size_t size;
} dtypes[ST_DTYPES] = {{"U8", 1}, {"I8", 1}, {"I32", 4}, {"I64", 8}, {"F16", 2}, {"BF16", 2}, {"F32", 4},
	{"F64", 8}, {"BOOL", 1}, {"I16", 2}, {"U16", 2}, {"U32", 4}, {"U64", 8}, {"F8_E4M3", 1},
	{"F8_E5M2", 1}};

size_t st_dtype_size(enum st_dtype t)
{
	return dtypes[t].size;
}

const char *st_dtype_name(enum st_dtype t)
{
	return dtypes[t].name;
}

/* One entry of the header; `data` is the file's data section. */
static int read_entry(struct st_tensor *t, const cJSON *item, const char *path, const unsigned char *data,
	size_t data_len, struct err *e)
{
	const cJSON *dtype = json_get(item, "dtype");
	const cJSON *shape = json_get(item, "shape");
	const cJSON *range = json_get(item, "data_offsets");
	size_t count = 1, bytes;
	int known;

	*t = (struct st_tensor){.name = item->string};
	if (!cJSON_IsString(dtype) || !cJSON_IsArray(shape) || !cJSON_IsArray(range) ||
		cJSON_GetArraySize(range) != 2)
		return err_file(e, path, "tensor '%s': needs dtype, shape and data_offsets", t->name);
	for (known = 0; known < ST_DTYPES; known++)
		if (!strcmp(dtypes[known].name, dtype->valuestring))
			break;
	if (known == ST_DTYPES)
		return err_file(
			e, path, "tensor '%s': dtype '%s' is not supported", t->name, dtype->valuestring);
	t->dtype = (enum st_dtype)known;
	for (const cJSON *d = shape->child; d; d = d->next) {
		double v = cJSON_IsNumber(d) ? d->valuedouble : -1;
		if (!(v >= 0 && v <= 9007199254740992.0) || v != floor(v) || t->dims == ST_MAX_DIMS)
			return err_file(e, path, "tensor '%s': bad shape", t->name);
		t->shape[t->dims++] = (int64_t)v;
		if (mem_size(count, (size_t)v, &count))
			return err_file(e, path, "tensor '%s': shape overflows", t->name);
	}
	double begin = range->child->valuedouble, end = range->child->next->valuedouble;
	if (!cJSON_IsNumber(range->child) || !cJSON_IsNumber(range->child->next) || !(begin >= 0) ||
		!(end >= begin) || begin != floor(begin) || end != floor(end))
		return err_file(e, path, "tensor '%s': bad data_offsets", t->name);
	if (end > (double)data_len)
		return err_file(e, path,
			"tensor '%s': ends at data offset %.0f but the file has %zu data bytes", t->name, end,
			data_len);
	t->data = data + (size_t)begin;
	t->bytes = (size_t)end - (size_t)begin;
	if (mem_size(count, dtypes[known].size, &bytes) || bytes != t->bytes)
		return err_file(e, path, "tensor '%s': %zu bytes of data do not fit its shape and type",
			t->name, t->bytes);
	return 0;
}

static int read_meta(struct safetensors *st, const cJSON *meta, struct err *e)
{
	size_t n = 0;

	for (const cJSON *m = meta->child; m; m = m->next, n++)
		if (!cJSON_IsString(m))
			return err_file(e, st->path, "__metadata__ '%s' is not a string", m->string);
	st->meta = mem_zalloc(n, sizeof *st->meta, st->path, e);
	if (!st->meta)
		return -1;
	for (const cJSON *m = meta->child; m; m = m->next) {
		struct st_meta *row = &st->meta[st->meta_count];
		row->key = mem_strdup(m->string, e);
		row->value = mem_strdup(m->valuestring, e);
		st->meta_count++;
		if (!row->key || !row->value)
			return -1;
	}
	return names_make(
		&st->meta_keys, st->meta, sizeof *st->meta, offsetof(struct st_meta, key), st->meta_count, e);
}

static int by_offset(const void *a, const void *b)
{
	const struct st_tensor *x = a, *y = b;
	const unsigned char *px = x->data, *py = y->data;

	return px != py ? COMPARE(px, py) : COMPARE(x->bytes, y->bytes);
}

/* No name stands for two tensors; then their names are looked up where they are in the order of the data. */
static int sort_tensors(struct safetensors *st, struct err *e)
{
	size_t earlier;

	if (names_make(&st->tensor_names, st->tensors, sizeof *st->tensors, offsetof(struct st_tensor, name),
		    st->n, e))
		return -1;
	const size_t twice = names_twice(&st->tensor_names, &earlier);
	if (twice != NAMES_NONE)
		return err_file(e, st->path, "tensor '%s' appears twice", st->tensors[twice].name);
	names_free(&st->tensor_names);
	qsort(st->tensors, st->n, sizeof *st->tensors, by_offset);
	return names_make(&st->tensor_names, st->tensors, sizeof *st->tensors,
		offsetof(struct st_tensor, name), st->n, e);
}

static int check_layout(
	const struct safetensors *st, const unsigned char *data, size_t data_len, struct err *e)
{
	size_t at = 0;

	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		size_t begin = (size_t)((const unsigned char *)t->data - data);
		if (begin != at)
			return err_file(e, st->path, "tensor '%s': begins at data offset %zu, expected %zu",
				t->name, begin, at);
		at += t->bytes;
	}
	if (at != data_len)
		return err_file(e, st->path, "%zu bytes after the last tensor", data_len - at);
	return 0;
}

static int check_crcs(const struct safetensors *st, struct err *e)
{
	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		char actual[16], *key = st_crc_key(t->name, e);
		if (!key)
			return -1;
		const char *expected = safetensors_meta(st, key);
		free(key);
		if (!expected)
			continue;
		snprintf(actual, sizeof actual, "%08x", libdeflate_crc32(0, t->data, t->bytes));
		if (strcmp(expected, actual))
			return err_file(e, st->path, "tensor '%s': crc32 is %s, the header says %s", t->name,
				actual, expected);
	}
	return 0;
}

static int read_header(struct safetensors *st, const cJSON *root, size_t header_len, struct err *e)
{
	const unsigned char *data = st->map.data + 8 + header_len;
	size_t data_len = st->map.len - 8 - header_len;

	if (!cJSON_IsObject(root))
		return err_file(e, st->path, "header at offset 8 is not a JSON object");
	st->tensors = mem_zalloc((size_t)cJSON_GetArraySize(root), sizeof *st->tensors, st->path, e);
	if (!st->tensors)
		return -1;
	for (const cJSON *item = root->child; item; item = item->next) {
		if (!strcmp(item->string, "__metadata__")) {
			if (!cJSON_IsObject(item) || st->meta)
				return err_file(e, st->path, "__metadata__ is not one object");
			if (read_meta(st, item, e))
				return -1;
			continue;
		}
		struct st_tensor *t = &st->tensors[st->n];
		if (read_entry(t, item, st->path, data, data_len, e))
			return -1;
		t->name = mem_strdup(item->string, e);
		if (!t->name)
			return -1;
		st->n++;
	}
	return -(sort_tensors(st, e) || check_layout(st, data, data_len, e) || check_crcs(st, e));
}

static int refuse_length(const struct safetensors *st, uint64_t header_len, struct err *e)
{
	size_t printed = 0;

	while (printed < 8 && st->map.data[printed] >= '\t')
		printed++;
	if (printed == 8)
		return err_file(e, st->path, "text, not safetensors: of sentences text-encode makes them");
	return err_file(e, st->path,
		"header of %llu bytes does not fit a file of %zu: not safetensors, or cut short",
		(unsigned long long)header_len, st->map.len);
}

/* Reads what st->map holds. */
static int read_map(struct safetensors *st, struct err *e)
{
	const char *data = (const char *)st->map.data, *stop = NULL;

	if (st->map.len < 8)
		return err_file(e, st->path, "%zu bytes, too short for a safetensors file", st->map.len);
	const uint64_t header_len = little_get(st->map.data, 8);
	if (header_len > st->map.len - 8 || header_len > 100000000)
		return refuse_length(st, header_len, e);
	SCOPED_BY(json_release)
	cJSON *root = cJSON_ParseWithLengthOpts(data + 8, (size_t)header_len, &stop, 0);
	if (!root)
		return err_file(e, st->path, "header is not JSON at offset %td", stop ? stop - data : 8);
	const char *const end = data + 8 + header_len;
	while (stop < end && *stop == ' ')
		stop++;
	if (stop < end)
		return err_file(
			e, st->path, "header has something after its JSON at offset %td", stop - data);
	return read_header(st, root, (size_t)header_len, e);
}

int safetensors_open(struct safetensors *st, const char *path, struct err *e)
{
	*st = (struct safetensors){.path = mem_strdup(file_name(path), e)};
	return !st->path || file_map(path, &st->map, e) ? -1 : read_map(st, e);
}

int safetensors_open_bytes(
	struct safetensors *st, const char *name, const unsigned char *bytes, size_t len, struct err *e)
{
	*st = (struct safetensors){.map = {.data = bytes, .len = len}, .is_borrowed = 1};
	st->path = mem_strdup(name, e);
	return st->path ? read_map(st, e) : -1;
}

void safetensors_close(struct safetensors *st)
{
	for (size_t i = 0; i < st->n; i++)
		free((void *)(size_t)st->tensors[i].name);
	for (size_t i = 0; i < st->meta_count; i++)
		mem_free_all((void *)(size_t)st->meta[i].key, (void *)(size_t)st->meta[i].value);
	names_free(&st->tensor_names);
	names_free(&st->meta_keys);
	mem_free_all(st->tensors, st->meta, st->path);
	if (!st->is_borrowed)
		file_unmap(&st->map);
	*st = (struct safetensors){0};
}

const struct st_tensor *safetensors_find(const struct safetensors *st, const char *name)
{
	const size_t i = names_find(&st->tensor_names, name);

	return i == NAMES_NONE ? NULL : &st->tensors[i];
}

const char *safetensors_meta(const struct safetensors *st, const char *key)
{
	const size_t i = names_find(&st->meta_keys, key);

	return i == NAMES_NONE ? NULL : st->meta[i].value;
}
