/* What readers of a format need of a safetensors file: numbers, tensors of a type and shape, its format. */
#include "base/half.h"
#include "base/little.h"
#include "base/mem.h"
#include "formats/arrays/safetensors.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>

int safetensors_meta_int(const struct safetensors *st, const char *key, long long low, long long high,
	long long *value, struct err *e)
{
	const char *text = safetensors_meta(st, key);
	char *end = NULL;

	errno = 0;
	*value = text ? strtoll(text, &end, 10) : 0;
	if (!text || (*text != '-' && (*text < '0' || *text > '9')) || end == text || *end || errno ||
		*value < low || *value > high)
		return err_file(e, st->path, "metadata '%s' is '%s', not a whole number from %lld to %lld",
			key, text ? text : "", low, high);
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
		err_file(e, st->path, "tensor '%s' is missing", name);
		return NULL;
	}
	same = t->dtype == dtype && t->dims == dims;
	for (int i = 0; same && i < dims; i++)
		same = shape[i] < 0 || shape[i] == t->shape[i];
	if (same)
		return t;
	shape_text(want, sizeof want, dims, shape);
	shape_text(have, sizeof have, t->dims, t->shape);
	err_file(e, st->path, "tensor '%s': is %s%s, expected %s%s", name, st_dtype_name(t->dtype), have,
		st_dtype_name(dtype), want);
	return NULL;
}

void *safetensors_copy(const struct safetensors *st, const char *name, enum st_dtype dtype, int dims,
	const int64_t *shape, size_t *n, struct err *e)
{
	const struct st_tensor *t = safetensors_need(st, name, dtype, dims, shape, e);
	void *copy = t ? mem_alloc(t->bytes, 1, st->path, e) : NULL;

	if (copy)
		memcpy(copy, t->data, t->bytes);
	if (copy && n)
		*n = (size_t)t->shape[0];
	return copy;
}

int safetensors_check_finite(
	const struct safetensors *st, const char *name, const float *x, size_t n, struct err *e)
{
	for (size_t i = 0; i < n; i++)
		if (!isfinite(x[i]))
			return err_file(e, st->path, "tensor '%s': item %zu is not finite", name, i);
	return 0;
}

int safetensors_need_format(const struct safetensors *st, const char *format, int version, struct err *e)
{
	const char *have = safetensors_meta(st, "format"), *text = safetensors_meta(st, "version");
	char *end;

	if (!have || strcmp(have, format))
		return err_file(e, st->path, "format is '%s', expected '%s'", have ? have : "", format);
	long v = text ? strtol(text, &end, 10) : 0;
	if (v < 1 || *end)
		return err_file(e, st->path, "version is '%s', not a number from 1", text ? text : "");
	if (v > version)
		return err_file(e, st->path, "%s version %ld is newer than this program reads (%d)", format,
			v, version);
	for (size_t i = 0; i < st->n; i++) {
		const struct st_tensor *t = &st->tensors[i];
		size_t at = (size_t)((const unsigned char *)t->data - st->map.data);
		if (t->bytes && at % st_dtype_size(t->dtype))
			return err_file(e, st->path, "tensor '%s': at offset %zu, not aligned to its type",
				t->name, at);
	}
	return 0;
}

int safetensors_to_float(const struct st_tensor *t, float *out, size_t count, struct err *e)
{
	const unsigned char *p = t->data;
	size_t size = st_dtype_size(t->dtype);

	if (t->bytes / size != count)
		return err_set(e, ERR_FORMAT, "tensor '%s': has %zu items, expected %zu", t->name,
			t->bytes / size, count);
	if (t->dtype == ST_F32) {
		memcpy(out, p, 4 * count);
		return 0;
	}
	if (t->dtype == ST_F16) {
		half_to_floats(p, count, out);
		return 0;
	}
	if (t->dtype != ST_F64 && t->dtype != ST_BF16)
		return err_set(e, ERR_FORMAT, "tensor '%s': is %s, expected a float type", t->name,
			st_dtype_name(t->dtype));
	for (size_t i = 0; i < count; i++, p += size) {
		double wide = 0;
		uint32_t bits;
		if (t->dtype == ST_F64) {
			memcpy(&wide, p, 8);
			out[i] = (float)wide;
		} else { /* the higher half of a float */
			bits = (uint32_t)little_get(p, 2) << 16;
			memcpy(&out[i], &bits, 4);
		}
	}
	return 0;
}
