#include "formats/scene/features.h"

#include "base/half.h"
#include "formats/arrays/arrays_in.h"

#include <math.h>
#include <string.h>

static int check_numbers(const struct features *f, struct err *e)
{
	const char *path = f->file.path;

	for (size_t i = 0; i < f->gaussians; i++) {
		if (!(f->reliability[i] >= 0 && f->reliability[i] <= 1))
			return err_file(e, path, "tensor 'reliability': item %zu is not in 0 to 1", i);
		if (!(f->weight[i] >= 0 && isfinite(f->weight[i])))
			return err_file(e, path, "tensor 'weight': item %zu is not a number from 0", i);
		if (f->labels && f->labels[i] < -1)
			return err_file(
				e, path, "tensor 'labels': item %zu is %d, below -1", i, (int)f->labels[i]);
		if (f->labels && f->labels[i] > FEATURES_MAX_LABEL)
			return err_file(e, path, "tensor 'labels': item %zu is %d, above %d", i,
				(int)f->labels[i], FEATURES_MAX_LABEL);
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
			return err_file(e, f->file.path, "tensor 'features': item %zu is not finite", i);
	return 0;
}

static int read_features(struct features *f, struct err *e)
{
	const int64_t shape[] = {(int64_t)f->gaussians, -1};
	const struct st_tensor *t = safetensors_find(&f->file, "features");

	if (!t)
		return err_file(e, f->file.path, "tensor 'features' or 'labels' is missing");
	f->is_half = t->dtype == ST_F16;
	t = safetensors_need(&f->file, "features", f->is_half ? ST_F16 : ST_F32, 2, shape, e);
	if (!t)
		return -1;
	if (t->shape[1] < 1 || t->shape[1] > FEATURES_MAX_CHANNELS)
		return err_file(e, f->file.path, "tensor 'features': %lld channels, not 1 to %d",
			(long long)t->shape[1], FEATURES_MAX_CHANNELS);
	f->channels = (size_t)t->shape[1];
	f->values = t->data;
	return check_finite(f, e);
}

static int read_all(struct features *f, struct err *e)
{
	const struct safetensors *st = &f->file;
	const int is_labels = safetensors_find(st, "labels") != NULL;
	struct arrays_in in;

	arrays_in_begin(&in, st, "refer.features", 1, e);
	f->gaussians = arrays_in_count(&in, "gaussians");
	in.bad = in.bad || fingerprint_read(&f->scene, st, "scene", e);
	const int64_t n = (int64_t)f->gaussians;
	f->reliability = arrays_in_place(&in, "reliability", ST_F32, n, NULL);
	f->weight = arrays_in_place(&in, "weight", ST_F32, n, NULL);
	f->labels = is_labels ? arrays_in_place(&in, "labels", ST_I32, n, NULL) : NULL;
	return -(in.bad || (!is_labels && read_features(f, e)) || check_numbers(f, e));
}

int features_open(struct features *f, const char *path, struct err *e)
{
	*f = (struct features){0};
	return -(safetensors_open(&f->file, path, e) || read_all(f, e));
}

void features_close(struct features *f)
{
	safetensors_close(&f->file);
	*f = (struct features){0};
}

void features_floats(const struct features *f, size_t first, size_t n, float *out)
{
	const uint16_t *half = f->values;

	n *= f->channels;
	first *= f->channels;
	if (!f->is_half)
		memcpy(out, (const float *)f->values + first, n * sizeof *out);
	else
		for (size_t i = 0; i < n; i++)
			out[i] = half_to_float(half[first + i]);
}

int features_write(const struct features *f, const char *path, const char *options, struct err *e)
{
	const int64_t n = (int64_t)f->gaussians, c = (int64_t)f->channels;
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.features", "1", "feature-lift", options, 0, e);
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", f->gaussians));
	arrays_out_text(&out, "scene", fingerprint_text(&f->scene));
	arrays_out_put(&out, f->labels
				     ? st_vector("labels", ST_I32, n, f->labels)
				     : st_matrix("features", f->is_half ? ST_F16 : ST_F32, n, c, f->values));
	arrays_out_put(&out, st_vector("reliability", ST_F32, n, f->reliability));
	arrays_out_put(&out, st_vector("weight", ST_F32, n, f->weight));
	return arrays_out_end(&out);
}
