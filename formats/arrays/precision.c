#include "formats/arrays/precision.h"

#include "base/mem.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 255 }; /* steps between the lowest number and the highest */

static const struct {
	const char *name;
	enum st_dtype dtype;
	double limit; /* of what it holds; u8: low + step * 255 stays far from overflow */
} precisions[PRECISIONS] = {{"f32", ST_F32, FLT_MAX}, {"f16", ST_F16, 65504}, {"u8", ST_U8, 1e38}};

const char *precision_name(enum precision p)
{
	return precisions[p].name;
}

int precision_parse(const char *name)
{
	for (int i = 0; i < PRECISIONS; i++)
		if (!strcmp(name, precisions[i].name))
			return i;
	return -1;
}

enum st_dtype precision_dtype(enum precision p)
{
	return precisions[p].dtype;
}

int precision_check(const float *x, size_t n, double limit, enum err_code code, const char *path,
	const char *name, struct err *e)
{
	for (size_t i = 0; i < n; i++) {
		if (fabs((double)x[i]) <= limit)
			continue;
		if (!isfinite(x[i]))
			return err_set(e, code, "%s: tensor '%s': item %zu is not finite", path, name, i);
		return err_set(e, code, "%s: tensor '%s': item %zu is %g, too large for this precision", path,
			name, i, (double)x[i]);
	}
	return 0;
}

/* The ranges of the groups of x, as low and step. */
static void find_ranges(
	const float *x, size_t rows, size_t columns, enum precision_group group, float *low, float *step)
{
	const size_t groups = group == PRECISION_ROWS ? rows : columns;

	for (size_t g = 0; g < groups; g++) {
		const size_t first = group == PRECISION_ROWS ? g * columns : g;
		const size_t stride = group == PRECISION_ROWS ? 1 : columns;
		const size_t n = group == PRECISION_ROWS ? columns : rows;
		float least = n ? x[first] : 0, most = least;
		for (size_t i = 1; i < n; i++) {
			const float value = x[first + i * stride];
			least = value < least ? value : least;
			most = value > most ? value : most;
		}
		low[g] = least;
		step[g] = (float)(((double)most - (double)least) / LEVELS);
	}
}

static void quantise(const float *x, size_t rows, size_t columns, enum precision_group group,
	const float *low, const float *step, uint8_t *q)
{
	for (size_t r = 0; r < rows; r++)
		for (size_t c = 0; c < columns; c++) {
			const size_t g = group == PRECISION_ROWS ? r : c, i = r * columns + c;
			const double level =
				step[g] > 0 ? ((double)x[i] - (double)low[g]) / (double)step[g] : 0;
			q[i] = (uint8_t)lrint(fmin(level, LEVELS));
		}
}

/* Half floats, or levels with their low and step, in memory of the matrix's own. */
static int convert(struct precision_matrix *m, const char *name, enum precision p, enum precision_group group,
	size_t rows, size_t columns, const float *x, const char *path, struct err *e)
{
	const size_t count = rows * columns, groups = group == PRECISION_ROWS ? rows : columns;
	const size_t floats = p == PRECISION_U8 ? 2 * groups + (count + 3) / 4 : (count + 1) / 2;

	m->owned = mem_alloc(floats, sizeof(float), path, e);
	if (!m->owned)
		return -1;
	if (p == PRECISION_F16) {
		uint16_t *half = (uint16_t *)m->owned;
		for (size_t i = 0; i < count; i++)
			half[i] = st_float_to_half(x[i]);
		m->tensors[0].data = half;
		return 0;
	}
	float *low = m->owned, *step = low + groups;
	uint8_t *q = (uint8_t *)(step + groups);
	find_ranges(x, rows, columns, group, low, step);
	quantise(x, rows, columns, group, low, step, q);
	snprintf(m->low, sizeof m->low, "%s.low", name);
	snprintf(m->step, sizeof m->step, "%s.step", name);
	m->tensors[0].data = q;
	m->tensors[1] = (struct st_tensor){.name = m->low, .dtype = ST_F32, .dims = 2, .data = low};
	m->tensors[2] = (struct st_tensor){.name = m->step, .dtype = ST_F32, .dims = 2, .data = step};
	for (int t = 1; t < 3; t++) {
		m->tensors[t].shape[0] = group == PRECISION_ROWS ? (int64_t)rows : 1;
		m->tensors[t].shape[1] = group == PRECISION_ROWS ? 1 : (int64_t)columns;
	}
	m->count = 3;
	return 0;
}

int precision_put(struct precision_matrix *m, const char *name, enum precision p, enum precision_group group,
	size_t rows, size_t columns, const float *x, const char *path, struct err *e)
{
	*m = (struct precision_matrix){.count = 1};
	m->tensors[0] = (struct st_tensor){.name = name,
		.dtype = precisions[p].dtype,
		.dims = 2,
		.shape = {(int64_t)rows, (int64_t)columns},
		.data = x};
	if (precision_check(x, rows * columns, precisions[p].limit, ERR_CHECK, path, name, e))
		return -1;
	return p == PRECISION_F32 ? 0 : convert(m, name, p, group, rows, columns, x, path, e);
}

void precision_free(struct precision_matrix *m)
{
	free(m->owned);
	m->owned = NULL;
}

/* NAME.low or NAME.step: finite, one for each group. */
static const float *get_groups(const struct safetensors *st, const char *name, const char *suffix,
	enum precision_group group, size_t groups, struct err *e)
{
	char full[128];
	const int64_t shape[2] = {
		group == PRECISION_ROWS ? (int64_t)groups : 1, group == PRECISION_ROWS ? 1 : (int64_t)groups};

	snprintf(full, sizeof full, "%s.%s", name, suffix);
	const struct st_tensor *t = safetensors_need(st, full, ST_F32, 2, shape, e);
	return t && !precision_check(t->data, groups, FLT_MAX, ERR_FORMAT, st->path, full, e) ? t->data
											      : NULL;
}

int precision_get(const struct safetensors *st, const char *name, enum precision p,
	enum precision_group group, size_t rows, size_t columns, float *x, struct err *e)
{
	const size_t groups = group == PRECISION_ROWS ? rows : columns;
	const struct st_tensor *t = safetensors_need(
		st, name, precisions[p].dtype, 2, (int64_t[]){(int64_t)rows, (int64_t)columns}, e);

	if (!t)
		return -1;
	if (p == PRECISION_U8) {
		const float *low = get_groups(st, name, "low", group, groups, e);
		const float *step = low ? get_groups(st, name, "step", group, groups, e) : NULL;
		const uint8_t *q = t->data;
		if (!step)
			return -1;
		for (size_t r = 0; r < rows; r++)
			for (size_t c = 0; c < columns; c++) {
				const size_t g = group == PRECISION_ROWS ? r : c;
				x[r * columns + c] = low[g] + step[g] * (float)q[r * columns + c];
			}
	} else if (safetensors_to_float(t, x, rows * columns, e)) {
		return -1;
	}
	return precision_check(x, rows * columns, FLT_MAX, ERR_FORMAT, st->path, name, e);
}
