#include "formats/arrays/precision.h"

#include "base/half.h"

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

/* All numbers to be written are within +-limit. */
static void check(struct arrays_out *out, const float *x, size_t n, double limit, const char *name)
{
	for (size_t i = 0; i < n && !out->bad; i++) {
		if (fabs((double)x[i]) <= limit)
			continue;
		if (!isfinite(x[i]))
			out->bad = err_set(out->e, ERR_CHECK, "%s: tensor '%s': item %zu is not finite",
				out->path, name, i);
		else
			out->bad = err_set(out->e, ERR_CHECK,
				"%s: tensor '%s': item %zu is %g, too large for this precision", out->path,
				name, i, (double)x[i]);
	}
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

void precision_put(struct arrays_out *out, const char *name, enum precision p, enum precision_group group,
	size_t rows, size_t columns, const float *x)
{
	const size_t count = rows * columns, groups = group == PRECISION_ROWS ? rows : columns;
	const int64_t down = group == PRECISION_ROWS ? (int64_t)rows : 1;
	const int64_t across = group == PRECISION_ROWS ? 1 : (int64_t)columns;
	const void *data = x;

	check(out, x, count, precisions[p].limit, name);
	float *low = p == PRECISION_U8 ? arrays_out_memory(out, 2 * groups, sizeof *low) : NULL;
	if (p == PRECISION_F16) {
		uint16_t *half = arrays_out_memory(out, count, sizeof *half);
		for (size_t i = 0; i < count && half; i++)
			half[i] = half_of_float(x[i]);
		data = half;
	} else if (p == PRECISION_U8) {
		uint8_t *q = arrays_out_memory(out, count, 1);
		if (q) {
			find_ranges(x, rows, columns, group, low, low + groups);
			quantise(x, rows, columns, group, low, low + groups, q);
		}
		data = q;
	}
	arrays_out_put(out, st_matrix(name, precisions[p].dtype, (int64_t)rows, (int64_t)columns, data));
	if (p == PRECISION_U8 && !out->bad) {
		arrays_out_put(
			out, st_matrix(arrays_out_print(out, "%s.low", name), ST_F32, down, across, low));
		arrays_out_put(out, st_matrix(arrays_out_print(out, "%s.step", name), ST_F32, down, across,
					    low + groups));
	}
}

void precision_put_vector(struct arrays_out *out, const char *name, size_t n, const float *x)
{
	check(out, x, n, FLT_MAX, name);
	arrays_out_put(out, st_vector(name, ST_F32, (int64_t)n, x));
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
	return t && !safetensors_check_finite(st, full, t->data, groups, e) ? t->data : NULL;
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
	return safetensors_check_finite(st, name, x, rows * columns, e);
}
