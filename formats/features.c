#include "formats/features.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VERSION_READ = 1 };

static int check_numbers(const struct features *f, struct err *e)
{
	const char *path = f->file.path;

	for (size_t i = 0; i < f->gaussians; i++) {
		if (!(f->reliability[i] >= 0 && f->reliability[i] <= 1))
			return err_set(e, ERR_FORMAT, "%s: tensor 'reliability': item %zu is not in 0 to 1",
				path, i);
		if (!(f->weight[i] >= 0 && isfinite(f->weight[i])))
			return err_set(e, ERR_FORMAT, "%s: tensor 'weight': item %zu is not a number from 0",
				path, i);
		if (f->labels && f->labels[i] < -1)
			return err_set(e, ERR_FORMAT, "%s: tensor 'labels': item %zu is %d, below -1", path,
				i, (int)f->labels[i]);
		if (f->labels && f->labels[i] > FEATURES_MAX_LABEL)
			return err_set(e, ERR_FORMAT, "%s: tensor 'labels': item %zu is %d, above %d", path,
				i, (int)f->labels[i], FEATURES_MAX_LABEL);
	}
	return 0;
}

/* Half floats and floats alike are not finite where all bits of the exponent are set. */
static int check_finite(const struct features *f, struct err *e)
{
	const size_t count = f->gaussians * f->channels;
	const uint16_t *half = f->values;
	const float *single = f->values;

	for (size_t i = 0; i < count; i++)
		if (f->is_half ? (half[i] & 0x7c00) == 0x7c00 : !isfinite(single[i]))
			return err_set(e, ERR_FORMAT, "%s: tensor 'features': item %zu is not finite",
				f->file.path, i);
	return 0;
}

static int read_labels(struct features *f, struct err *e)
{
	const int64_t n[] = {(int64_t)f->gaussians};
	const struct st_tensor *labels = safetensors_need(&f->file, "labels", ST_I32, 1, n, e);

	f->labels = labels ? labels->data : NULL;
	return labels ? 0 : -1;
}

static int read_features(struct features *f, struct err *e)
{
	const int64_t shape[] = {(int64_t)f->gaussians, -1};
	const struct st_tensor *t = safetensors_find(&f->file, "features");

	if (!t)
		return err_set(e, ERR_FORMAT, "%s: tensor 'features' or 'labels' is missing", f->file.path);
	f->is_half = t->dtype == ST_F16;
	t = safetensors_need(&f->file, "features", f->is_half ? ST_F16 : ST_F32, 2, shape, e);
	if (!t)
		return -1;
	if (t->shape[1] < 1 || t->shape[1] > FEATURES_MAX_CHANNELS)
		return err_set(e, ERR_FORMAT, "%s: tensor 'features': %lld channels, not 1 to %d",
			f->file.path, (long long)t->shape[1], FEATURES_MAX_CHANNELS);
	f->channels = (size_t)t->shape[1];
	f->values = t->data;
	return check_finite(f, e);
}

static int read_all(struct features *f, struct err *e)
{
	const struct safetensors *st = &f->file;
	long long gaussians = 0;

	if (safetensors_need_format(st, "refer.features", VERSION_READ, e) ||
		safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &gaussians, e) ||
		fingerprint_read(&f->scene, st, "scene", e))
		return -1;
	f->gaussians = (size_t)gaussians;
	const int64_t n[] = {gaussians};
	const struct st_tensor *reliability = safetensors_need(st, "reliability", ST_F32, 1, n, e);
	const struct st_tensor *weight = reliability ? safetensors_need(st, "weight", ST_F32, 1, n, e) : NULL;
	if (!weight)
		return -1;
	f->reliability = reliability->data;
	f->weight = weight->data;
	if (safetensors_find(st, "labels") ? read_labels(f, e) : read_features(f, e))
		return -1;
	return check_numbers(f, e);
}

int features_open(struct features *f, const char *path, struct err *e)
{
	*f = (struct features){0};
	if (safetensors_open(&f->file, path, e))
		return -1;
	if (!read_all(f, e))
		return 0;
	features_close(f);
	return -1;
}

void features_close(struct features *f)
{
	safetensors_close(&f->file);
	*f = (struct features){0};
}

void features_floats(const struct features *f, size_t first, size_t n, float *out)
{
	const size_t from = first * f->channels, count = n * f->channels;
	const uint16_t *half = f->values;

	if (!f->is_half)
		memcpy(out, (const float *)f->values + from, count * sizeof *out);
	else
		for (size_t i = 0; i < count; i++)
			out[i] = st_half_to_float(half[from + i]);
}

int features_write(const struct features *f, const char *path, const char *options, struct err *e)
{
	const int64_t n = (int64_t)f->gaussians;
	const struct st_tensor tensors[] = {
		f->labels ? (struct st_tensor){.name = "labels",
				    .dtype = ST_I32,
				    .dims = 1,
				    .shape = {n},
				    .data = f->labels}
			  : (struct st_tensor){.name = "features",
				    .dtype = f->is_half ? ST_F16 : ST_F32,
				    .dims = 2,
				    .shape = {n, (int64_t)f->channels},
				    .data = f->values},
		{.name = "reliability", .dtype = ST_F32, .dims = 1, .shape = {n}, .data = f->reliability},
		{.name = "weight", .dtype = ST_F32, .dims = 1, .shape = {n}, .data = f->weight},
	};
	char gaussians[24];

	snprintf(gaussians, sizeof gaussians, "%lld", (long long)n);
	const struct st_meta meta[] = {{"format", "refer.features"}, {"version", "1"},
		{"tool", "feature-lift"}, {"options", options}, {"seed", "0"}, {"gaussians", gaussians},
		{"scene", fingerprint_text(&f->scene)}};
	return safetensors_write(
		path, tensors, sizeof tensors / sizeof *tensors, meta, sizeof meta / sizeof *meta, e);
}
