#include "formats/arrays/safetensors.h"

#include "base/mem.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <libdeflate.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

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

static uint32_t checksum(const void *data, size_t len)
{
	return libdeflate_crc32(0, data, len);
}

/* One entry of the header; `data` is the file's data section. */
static int read_entry(struct st_tensor *t, const cJSON *item, const char *path, const unsigned char *data,
	size_t data_len, struct err *e)
{
	const cJSON *dtype = cJSON_GetObjectItemCaseSensitive(item, "dtype");
	const cJSON *shape = cJSON_GetObjectItemCaseSensitive(item, "shape");
	const cJSON *range = cJSON_GetObjectItemCaseSensitive(item, "data_offsets");
	size_t count = 1, bytes;
	int known;

	*t = (struct st_tensor){.name = item->string};
	if (!cJSON_IsString(dtype) || !cJSON_IsArray(shape) || !cJSON_IsArray(range) ||
		cJSON_GetArraySize(range) != 2)
		return err_set(
			e, ERR_FORMAT, "%s: tensor '%s': needs dtype, shape and data_offsets", path, t->name);
	for (known = 0; known < ST_DTYPES; known++)
		if (!strcmp(dtypes[known].name, dtype->valuestring))
			break;
	if (known == ST_DTYPES)
		return err_set(e, ERR_FORMAT, "%s: tensor '%s': dtype '%s' is not supported", path, t->name,
			dtype->valuestring);
	t->dtype = (enum st_dtype)known;
	for (const cJSON *d = shape->child; d; d = d->next) {
		double v = cJSON_IsNumber(d) ? d->valuedouble : -1;
		if (!(v >= 0 && v <= 9007199254740992.0) || v != floor(v) || t->dims == ST_MAX_DIMS)
			return err_set(e, ERR_FORMAT, "%s: tensor '%s': bad shape", path, t->name);
		t->shape[t->dims++] = (int64_t)v;
		if (mem_size(count, (size_t)v, &count))
			return err_set(e, ERR_FORMAT, "%s: tensor '%s': shape overflows", path, t->name);
	}
	double begin = range->child->valuedouble, end = range->child->next->valuedouble;
	if (!cJSON_IsNumber(range->child) || !cJSON_IsNumber(range->child->next) || !(begin >= 0) ||
		!(end >= begin) || begin != floor(begin) || end != floor(end))
		return err_set(e, ERR_FORMAT, "%s: tensor '%s': bad data_offsets", path, t->name);
	if (end > (double)data_len)
		return err_set(e, ERR_FORMAT,
			"%s: tensor '%s': ends at data offset %.0f but the file has %zu data bytes", path,
			t->name, end, data_len);
	t->data = data + (size_t)begin;
	t->bytes = (size_t)end - (size_t)begin;
	if (mem_size(count, dtypes[known].size, &bytes) || bytes != t->bytes)
		return err_set(e, ERR_FORMAT,
			"%s: tensor '%s': %zu bytes of data do not fit its shape and type", path, t->name,
			t->bytes);
	return 0;
}

static int read_meta(struct safetensors *st, const cJSON *meta, struct err *e)
{
	size_t n = 0;

	for (const cJSON *m = meta->child; m; m = m->next, n++)
		if (!cJSON_IsString(m))
			return err_set(
				e, ERR_FORMAT, "%s: __metadata__ '%s' is not a string", st->path, m->string);
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

	if (px != py)
		return px < py ? -1 : 1;
	return (x->bytes > y->bytes) - (x->bytes < y->bytes);
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
		return err_set(
			e, ERR_FORMAT, "%s: tensor '%s' appears twice", st->path, st->tensors[twice].name);
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
			return err_set(e, ERR_FORMAT,
				"%s: tensor '%s': begins at data offset %zu, expected %zu", st->path, t->name,
				begin, at);
		at += t->bytes;
	}
	if (at != data_len)
		return err_set(e, ERR_FORMAT, "%s: %zu bytes after the last tensor", st->path, data_len - at);
	return 0;
}

/* The key of a tensor's checksum; free() it. */
static char *crc_key(const char *tensor, struct err *e)
{
	static const char prefix[] = "crc32.";
	const size_t length = strlen(tensor);
	char *key = mem_alloc(sizeof prefix + length, 1, "tensor name", e);

	if (key) {
		memcpy(key, prefix, sizeof prefix - 1);
		memcpy(key + sizeof prefix - 1, tensor, length + 1);
	}
	return key;
}

static int check_crcs(const struct safetensors *st, struct err *e)
{
	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		char actual[16], *key = crc_key(t->name, e);
		if (!key)
			return -1;
		const char *expected = safetensors_meta(st, key);
		free(key);
		if (!expected)
			continue;
		snprintf(actual, sizeof actual, "%08x", checksum(t->data, t->bytes));
		if (strcmp(expected, actual))
			return err_set(e, ERR_FORMAT, "%s: tensor '%s': crc32 is %s, the header says %s",
				st->path, t->name, actual, expected);
	}
	return 0;
}

static int read_header(struct safetensors *st, const cJSON *root, size_t header_len, struct err *e)
{
	const unsigned char *data = st->map.data + 8 + header_len;
	size_t data_len = st->map.len - 8 - header_len;

	if (!cJSON_IsObject(root))
		return err_set(e, ERR_FORMAT, "%s: header at offset 8 is not a JSON object", st->path);
	st->tensors = mem_zalloc((size_t)cJSON_GetArraySize(root), sizeof *st->tensors, st->path, e);
	if (!st->tensors)
		return -1;
	for (const cJSON *item = root->child; item; item = item->next) {
		if (!strcmp(item->string, "__metadata__")) {
			if (!cJSON_IsObject(item) || st->meta)
				return err_set(e, ERR_FORMAT, "%s: __metadata__ is not one object", st->path);
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
	return sort_tensors(st, e) || check_layout(st, data, data_len, e) || check_crcs(st, e) ? -1 : 0;
}

/* Reads what st->map holds; closes on failure. */
static int read_map(struct safetensors *st, struct err *e)
{
	uint64_t header_len = 0;
	cJSON *root = NULL;

	if (st->map.len < 8) {
		err_set(e, ERR_FORMAT, "%s: %zu bytes, too short for a safetensors file", st->path,
			st->map.len);
		goto fail;
	}
	for (int i = 7; i >= 0; i--)
		header_len = header_len << 8 | st->map.data[i];
	if (header_len > st->map.len - 8 || header_len > 100000000) {
		err_set(e, ERR_FORMAT,
			"%s: header of %llu bytes does not fit a file of %zu: not safetensors, or cut short",
			st->path, (unsigned long long)header_len, st->map.len);
		goto fail;
	}
	const char *stop = NULL;
	root = cJSON_ParseWithLengthOpts((const char *)st->map.data + 8, (size_t)header_len, &stop, 0);
	if (!root) {
		err_set(e, ERR_FORMAT, "%s: header is not JSON at offset %td", st->path,
			stop ? stop - (const char *)st->map.data : 8);
		goto fail;
	}
	for (const char *end = (const char *)st->map.data + 8 + header_len; stop < end; stop++)
		if (*stop != ' ') {
			err_set(e, ERR_FORMAT, "%s: header has something after its JSON at offset %td",
				st->path, stop - (const char *)st->map.data);
			goto fail;
		}
	if (read_header(st, root, (size_t)header_len, e))
		goto fail;
	cJSON_Delete(root);
	return 0;
fail:
	cJSON_Delete(root);
	safetensors_close(st);
	return -1;
}

int safetensors_open(struct safetensors *st, const char *path, struct err *e)
{
	*st = (struct safetensors){0};
	st->path = mem_strdup(file_name(path), e);
	if (!st->path || file_map(path, &st->map, e)) {
		safetensors_close(st);
		return -1;
	}
	return read_map(st, e);
}

int safetensors_open_bytes(
	struct safetensors *st, const char *name, const unsigned char *bytes, size_t len, struct err *e)
{
	*st = (struct safetensors){.map = {.data = bytes, .len = len}, .is_borrowed = 1};
	st->path = mem_strdup(name, e);
	if (!st->path) {
		safetensors_close(st);
		return -1;
	}
	return read_map(st, e);
}

void safetensors_close(struct safetensors *st)
{
	for (size_t i = 0; i < st->n; i++)
		free((void *)(size_t)st->tensors[i].name);
	for (size_t i = 0; i < st->meta_count; i++) {
		free((void *)(size_t)st->meta[i].key);
		free((void *)(size_t)st->meta[i].value);
	}
	names_free(&st->tensor_names);
	names_free(&st->meta_keys);
	free(st->tensors);
	free(st->meta);
	free(st->path);
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

int safetensors_meta_int(const struct safetensors *st, const char *key, long long low, long long high,
	long long *value, struct err *e)
{
	const char *text = safetensors_meta(st, key);
	char *end = NULL;

	errno = 0;
	*value = text ? strtoll(text, &end, 10) : 0;
	if (!text || (*text != '-' && (*text < '0' || *text > '9')) || end == text || *end || errno ||
		*value < low || *value > high)
		return err_set(e, ERR_FORMAT,
			"%s: metadata '%s' is '%s', not a whole number from %lld to %lld", st->path, key,
			text ? text : "", low, high);
	return 0;
}

static void shape_text(char *text, size_t size, int dims, const int64_t *shape)
{
	size_t used = (size_t)snprintf(text, size, "[");

	for (int i = 0; i < dims && used < size; i++)
		if (shape[i] < 0)
			used += (size_t)snprintf(text + used, size - used, "%s*", i ? "," : "");
		else
			used += (size_t)snprintf(
				text + used, size - used, "%s%lld", i ? "," : "", (long long)shape[i]);
	if (used < size)
		snprintf(text + used, size - used, "]");
}

const struct st_tensor *safetensors_need(const struct safetensors *st, const char *name, enum st_dtype dtype,
	int dims, const int64_t *shape, struct err *e)
{
	const struct st_tensor *t = safetensors_find(st, name);
	char want[128], have[128];
	int same;

	if (!t) {
		err_set(e, ERR_FORMAT, "%s: tensor '%s' is missing", st->path, name);
		return NULL;
	}
	same = t->dtype == dtype && t->dims == dims;
	for (int i = 0; same && i < dims; i++)
		same = shape[i] < 0 || shape[i] == t->shape[i];
	if (same)
		return t;
	shape_text(want, sizeof want, dims, shape);
	shape_text(have, sizeof have, t->dims, t->shape);
	err_set(e, ERR_FORMAT, "%s: tensor '%s': is %s%s, expected %s%s", st->path, name,
		dtypes[t->dtype].name, have, dtypes[dtype].name, want);
	return NULL;
}

int safetensors_need_format(const struct safetensors *st, const char *format, int version, struct err *e)
{
	const char *have = safetensors_meta(st, "format"), *text = safetensors_meta(st, "version");
	char *end;

	if (!have || strcmp(have, format))
		return err_set(e, ERR_FORMAT, "%s: format is '%s', expected '%s'", st->path, have ? have : "",
			format);
	long v = text ? strtol(text, &end, 10) : 0;
	if (v < 1 || *end)
		return err_set(e, ERR_FORMAT, "%s: version is '%s', not a number from 1", st->path,
			text ? text : "");
	if (v > version)
		return err_set(e, ERR_FORMAT, "%s: %s version %ld is newer than this program reads (%d)",
			st->path, format, v, version);
	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		size_t at = (size_t)((const unsigned char *)t->data - st->map.data);
		if (t->bytes && at % dtypes[t->dtype].size)
			return err_set(e, ERR_FORMAT,
				"%s: tensor '%s': at offset %zu, not aligned to its type", st->path, t->name,
				at);
	}
	return 0;
}

/* The exponent of a half is 112 less than a float's; the product is exact, also for subnormal halves.
 * Infinities and NaN get the float's largest exponent. */
float st_half_to_float(uint16_t h)
{
	uint32_t bits = (uint32_t)(h & 0x7fff) << 13;
	float f;

	memcpy(&f, &bits, 4);
	f *= 0x1p112f;
	memcpy(&bits, &f, 4);
	bits |= (h & 0x7c00) == 0x7c00 ? 0x7f800000 : 0;
	bits |= (uint32_t)(h & 0x8000) << 16;
	memcpy(&f, &bits, 4);
	return f;
}

uint16_t st_float_to_half(float f)
{
	uint32_t bits;

	memcpy(&bits, &f, 4);
	uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
	bits &= 0x7fffffff;
	if (bits > 0x7f800000)
		return sign | 0x7e00;
	if (bits >= 0x477ff000)
		return sign | 0x7c00;
	if (bits < 0x38800000) { /* subnormal or zero: exact scaling, then round to nearest even */
		float a;
		memcpy(&a, &bits, 4);
		return sign | (uint16_t)lrintf(a * 0x1p24f);
	}
	bits += 0xfff + (bits >> 13 & 1);
	return sign | (uint16_t)((bits >> 13) - (112 << 10));
}

float st_bfloat_to_float(uint16_t b)
{
	uint32_t bits = (uint32_t)b << 16;
	float f;

	memcpy(&f, &bits, 4);
	return f;
}

int safetensors_to_float(const struct st_tensor *t, float *out, size_t count, struct err *e)
{
	const unsigned char *p = t->data;
	size_t size = dtypes[t->dtype].size;

	if (t->bytes / size != count)
		return err_set(e, ERR_FORMAT, "tensor '%s': has %zu items, expected %zu", t->name,
			t->bytes / size, count);
	if (t->dtype == ST_F32) {
		memcpy(out, p, 4 * count);
		return 0;
	}
	if (t->dtype == ST_F16) {
		for (size_t i = 0; i < count; i++) {
			uint16_t half;
			memcpy(&half, p + 2 * i, 2);
			out[i] = st_half_to_float(half);
		}
		return 0;
	}
	for (size_t i = 0; i < count; i++, p += size) {
		uint16_t half;
		double wide;
		switch (t->dtype) {
		case ST_F64:
			memcpy(&wide, p, 8);
			out[i] = (float)wide;
			break;
		case ST_BF16:
			memcpy(&half, p, 2);
			out[i] = st_bfloat_to_float(half);
			break;
		default:
			return err_set(e, ERR_FORMAT, "tensor '%s': is %s, expected a float type", t->name,
				dtypes[t->dtype].name);
		}
	}
	return 0;
}

static size_t tensor_bytes(const struct st_tensor *t)
{
	size_t bytes = dtypes[t->dtype].size;

	for (int i = 0; i < t->dims; i++)
		bytes *= (size_t)t->shape[i];
	return bytes;
}

/* The header with the tensors in the order `order`; NULL with *e set when memory is out. */
static char *make_header(const struct st_tensor *tensors, const size_t *order, size_t n,
	const struct st_meta *meta, size_t meta_count, struct err *e)
{
	cJSON *root = cJSON_CreateObject(), *m = cJSON_AddObjectToObject(root, "__metadata__");
	size_t at = 0;

	for (size_t i = 0; i < meta_count; i++)
		if (meta[i].value)
			cJSON_AddStringToObject(m, meta[i].key, meta[i].value);
	for (size_t k = 0; k < n; k++) {
		const struct st_tensor *t = &tensors[order[k]];
		size_t bytes = tensor_bytes(t);
		char value[16], *key = crc_key(t->name, e);
		if (!key) {
			cJSON_Delete(root);
			return NULL;
		}
		snprintf(value, sizeof value, "%08x", checksum(t->data, bytes));
		cJSON_AddStringToObject(m, key, value);
		free(key);
		cJSON *item = cJSON_AddObjectToObject(root, t->name);
		cJSON_AddStringToObject(item, "dtype", dtypes[t->dtype].name);
		cJSON *shape = cJSON_AddArrayToObject(item, "shape");
		for (int i = 0; i < t->dims; i++)
			cJSON_AddItemToArray(shape, cJSON_CreateNumber((double)t->shape[i]));
		cJSON *range = cJSON_AddArrayToObject(item, "data_offsets");
		cJSON_AddItemToArray(range, cJSON_CreateNumber((double)at));
		at += bytes;
		cJSON_AddItemToArray(range, cJSON_CreateNumber((double)at));
	}
	char *text = cJSON_PrintUnformatted(root);
	cJSON_Delete(root);
	if (!text)
		err_set(e, ERR_SYSTEM, "out of memory for the header");
	return text;
}

/* A failed write is found out at once, while errno still says why. */
static int put(struct file_out *out, const void *data, size_t bytes, struct err *e)
{
	return bytes && fwrite(data, 1, bytes, out->stream) != bytes
		       ? err_errno(e, "%s", file_name(out->path))
		       : 0;
}

int safetensors_write(const char *path, const struct st_tensor *tensors, size_t n, const struct st_meta *meta,
	size_t meta_count, struct err *e)
{
	static const char spaces[64] = "                                                                ";
	size_t *order = mem_alloc(n, sizeof *order, path, e);
	struct file_out out = {0};
	size_t k = 0;

	if (!order)
		return -1;
	for (size_t size = 8; size; size /= 2)
		for (size_t i = 0; i < n; i++)
			if (dtypes[tensors[i].dtype].size == size)
				order[k++] = i;
	char *header = make_header(tensors, order, n, meta, meta_count, e);
	if (!header) {
		free(order);
		return err_prefix(e, path);
	}
	if (file_out_open(&out, path, e)) {
		free(order);
		free(header);
		return -1;
	}
	size_t used = strlen(header), padded = (used + 8 + 63) / 64 * 64 - 8;
	unsigned char length[8];
	for (int i = 0; i < 8; i++)
		length[i] = (unsigned char)((uint64_t)padded >> (8 * i));
	int bad =
		put(&out, length, 8, e) || put(&out, header, used, e) || put(&out, spaces, padded - used, e);
	for (k = 0; k < n && !bad; k++)
		bad = put(&out, tensors[order[k]].data, tensor_bytes(&tensors[order[k]]), e);
	free(order);
	free(header);
	return file_out_end(&out, bad, e);
}
