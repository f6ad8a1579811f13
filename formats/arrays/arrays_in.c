#include "formats/arrays/arrays_in.h"

#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "formats/arrays/metalist.h"

void arrays_in_begin(
	struct arrays_in *in, const struct safetensors *st, const char *format, int version, struct err *e)
{
	*in = (struct arrays_in){st, e, safetensors_need_format(st, format, version, e)};
}

size_t arrays_in_count(struct arrays_in *in, const char *key)
{
	long long count = 0;

	in->bad = in->bad || safetensors_meta_int(in->st, key, 0, INT32_MAX, &count, in->e);
	return in->bad ? 0 : (size_t)count;
}

const void *arrays_in_place(
	struct arrays_in *in, const char *name, enum st_dtype dtype, int64_t n, size_t *count)
{
	const struct st_tensor *t = in->bad ? NULL : safetensors_need(in->st, name, dtype, 1, &n, in->e);

	in->bad |= !t;
	if (count)
		*count = t ? (size_t)t->shape[0] : 0;
	return t ? t->data : NULL;
}

void *arrays_in_vector(struct arrays_in *in, const char *name, enum st_dtype dtype, int64_t n, size_t *count)
{
	void *copy = in->bad ? NULL : safetensors_copy(in->st, name, dtype, 1, &n, count, in->e);

	in->bad |= !copy;
	return copy;
}

void arrays_in_fill(struct arrays_in *in, const char *name, float *to, size_t n)
{
	const float *from = arrays_in_place(in, name, ST_F32, (int64_t)n, NULL);

	in->bad = !from || safetensors_check_finite(in->st, name, from, n, in->e);
	if (from)
		memcpy(to, from, n * sizeof *to);
}

float *arrays_in_floats(struct arrays_in *in, const char *name, size_t rows, int columns)
{
	const int64_t shape[] = {(int64_t)rows, columns};
	float *x = in->bad ? NULL : safetensors_copy(in->st, name, ST_F32, 2, shape, NULL, in->e);

	in->bad = !x || safetensors_check_finite(in->st, name, x, rows * (size_t)columns, in->e);
	return x;
}

int arrays_in_width(struct arrays_in *in, const char *name, enum st_dtype dtype, size_t *rows)
{
	const struct st_tensor *t =
		in->bad ? NULL : safetensors_need(in->st, name, dtype, 2, (int64_t[]){-1, -1}, in->e);

	in->bad |= !t;
	if (t && (t->shape[1] < 1 || t->shape[1] > 65536))
		in->bad = err_file(in->e, in->st->path, "tensor '%s': width %lld is not in 1 to 65536", name,
			(long long)t->shape[1]);
	*rows = in->bad ? 0 : (size_t)t->shape[0];
	return in->bad ? 0 : (int)t->shape[1];
}

int64_t *arrays_in_offsets(struct arrays_in *in, const char *name, const char *of, size_t *n)
{
	int64_t *offsets = arrays_in_vector(in, name, ST_I64, -1, n);

	if (offsets && (*n < 1 || *n > INT32_MAX))
		in->bad = err_file(in->e, in->st->path,
			"tensor '%s': has %zu entries, expected 1 more than %s", name, *n, of);
	*n = in->bad ? 0 : *n - 1;
	return offsets;
}

void arrays_in_check_offsets(struct arrays_in *in, const char *name, const int64_t *offsets, size_t n,
	size_t count, const char *of)
{
	if (!in->bad && offsets[0] != 0)
		in->bad = err_file(in->e, in->st->path, "tensor '%s': begins with %lld, expected 0", name,
			(long long)offsets[0]);
	for (size_t i = 0; i < n && !in->bad; i++)
		if (offsets[i + 1] < offsets[i])
			in->bad = err_file(in->e, in->st->path,
				"tensor '%s': falls from %lld to %lld at entry %zu", name,
				(long long)offsets[i], (long long)offsets[i + 1], i + 1);
	if (!in->bad && offsets[n] != (int64_t)count)
		in->bad = err_file(in->e, in->st->path, "tensor '%s': ends with %lld, but there are %zu %s",
			name, (long long)offsets[n], count, of);
}

void arrays_in_check_index(struct arrays_in *in, const int32_t *index, const int64_t *indptr, size_t n,
	size_t limit, const char *of)
{
	for (size_t r = 0; r < n && !in->bad; r++)
		for (int64_t k = indptr[r]; k < indptr[r + 1] && !in->bad; k++)
			if (index[k] < 0 || (size_t)index[k] >= limit ||
				(k > indptr[r] && index[k] <= index[k - 1]))
				in->bad = err_file(in->e, in->st->path,
					"tensor 'index': item %lld does not rise within 0 to %lld, in %s %zu",
					(long long)k, (long long)limit - 1, of, r);
}

char **arrays_in_list(struct arrays_in *in, const char *key, size_t n, const char *of)
{
	const char *value = in->bad ? NULL : safetensors_meta(in->st, key);
	char reason[METALIST_REASON];
	size_t used = 0;

	if (in->bad)
		return NULL;
	char **strings = value ? metalist_parse(value, &used, reason) : NULL;
	if (!strings && (!value || !strcmp(reason, "not a JSON list")))
		in->bad = err_file(in->e, in->st->path, "metadata '%s' is not a JSON list", key);
	else if (!strings)
		in->bad = err_set(in->e, strcmp(reason, "out of memory") ? ERR_FORMAT : ERR_SYSTEM,
			"%s: metadata '%s': %s", in->st->path, key, reason);
	else if (used != n)
		in->bad = err_file(
			in->e, in->st->path, "metadata '%s' has %zu entries for %zu %s", key, used, n, of);
	if (!in->bad)
		return strings;
	mem_free_strings(strings, used);
	return NULL;
}

void arrays_in_check_names(
	struct arrays_in *in, char *const *strings, size_t n, int may_be_empty, const char *key)
{
	char fault[NAME_FAULT];

	for (size_t i = 0; i < n && !in->bad; i++) {
		const char *reason = name_fault(strings[i], NAME_DATA, fault);
		if (reason && (*strings[i] || !may_be_empty))
			in->bad =
				err_file(in->e, in->st->path, "metadata '%s': entry %zu %s", key, i, reason);
	}
}

void arrays_in_check_unique(struct arrays_in *in, char *const *strings, size_t n, const char *key)
{
	size_t twice = NAMES_NONE, earlier;

	in->bad = in->bad || names_find_twice(strings, sizeof *strings, 0, n, &twice, &earlier, in->e);
	if (!in->bad && twice != NAMES_NONE)
		in->bad = err_file(
			in->e, in->st->path, "metadata '%s': '%s' appears twice", key, strings[twice]);
}

void arrays_in_check_pieces(struct arrays_in *in, char *const *pieces, const int64_t *offsets, size_t n)
{
	for (size_t i = 0; i < n && !in->bad; i++) {
		int64_t count = 0;
		int is_even = 1;
		for (const char *c = pieces[i]; *c; c++) {
			is_even &= *c != ' ' || (c > pieces[i] && c[1] != ' ' && c[1]);
			count += *c != ' ' && (c[1] == ' ' || !c[1]);
		}
		if (!is_even)
			in->bad = err_file(in->e, in->st->path,
				"metadata 'pieces': entry %zu does not have one space between pieces, and none around",
				i);
		else if (count != offsets[i + 1] - offsets[i])
			in->bad = err_file(in->e, in->st->path,
				"metadata 'pieces': entry %zu has %lld pieces for %lld words", i,
				(long long)count, (long long)(offsets[i + 1] - offsets[i]));
	}
}
