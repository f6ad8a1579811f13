#include "formats/scene/features.h"

#include "base/half.h"
#include "base/number.h"
#include "formats/arrays/arrays_in.h"
#include "nn/linear.h"

#include <math.h>
#include <string.h>

/* Version 2 is one with components, of which at most so many are expanded at a time. */
enum { VERSION_READ = 2, EXPANDED = FEATURES_MAX_COMPONENTS };

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
	const size_t count = f->gaussians * (f->components ? f->components : f->channels);
	const uint16_t *half = f->values;
	const float *single = f->values;

	for (size_t i = 0; i < count; i++)
		if (f->is_half ? (half[i] & 0x7c00) == 0x7c00 : !isfinite(single[i]))
			return err_file(e, f->file.path, "tensor 'features': item %zu is not finite", i);
	return 0;
}

/* The features that were found are components of others. */
static int read_components(struct features *f, struct err *e)
{
	const int64_t shape[] = {(int64_t)f->channels, -1};
	const struct st_tensor *basis = safetensors_need(&f->file, "basis", ST_F32, 2, shape, e);

	if (!basis)
		return -1;
	if (f->channels > FEATURES_MAX_COMPONENTS)
		return err_file(e, f->file.path, "tensor 'features': %zu components, not 1 to %d",
			f->channels, FEATURES_MAX_COMPONENTS);
	if (basis->shape[1] < (int64_t)f->channels || basis->shape[1] > FEATURES_MAX_CHANNELS)
		return err_file(e, f->file.path, "tensor 'basis': %lld channels, not %zu to %d",
			(long long)basis->shape[1], f->channels, FEATURES_MAX_CHANNELS);
	f->components = f->channels;
	f->channels = (size_t)basis->shape[1];
	f->basis = basis->data;
	struct arrays_in in = {&f->file, e, 0};
	f->mean = arrays_in_place(&in, "mean", ST_F32, basis->shape[1], NULL);
	return -(in.bad ||
		 safetensors_check_finite(&f->file, "basis", f->basis, f->components * f->channels, e) ||
		 safetensors_check_finite(&f->file, "mean", f->mean, f->channels, e));
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
	return -(check_finite(f, e) || (safetensors_find(&f->file, "basis") && read_components(f, e)));
}

static int read_all(struct features *f, struct err *e)
{
	const struct safetensors *st = &f->file;
	const int is_labels = safetensors_find(st, "labels") != NULL;
	struct arrays_in in;

	arrays_in_begin(&in, st, "refer.features", VERSION_READ, e);
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

/* out (n): numbers of the file from one on. */
static void stored_floats(const struct features *f, size_t from, size_t n, float *out)
{
	const uint16_t *half = f->values;

	if (!f->is_half)
		memcpy(out, (const float *)f->values + from, n * sizeof *out);
	else
		for (size_t i = 0; i < n; i++)
			out[i] = half_to_float(half[from + i]);
}

/* out (n,C): the features that the components of Gaussians from `first` on stand for. */
static void expand(const struct features *f, size_t first, size_t n, float *out)
{
	const struct linear_matrix basis = {f->basis, f->channels, 1};
	float y[EXPANDED];
	const size_t most = EXPANDED / f->components;

	for (size_t from = 0; from < n; from += most) {
		const size_t rows = n - from < most ? n - from : most;
		stored_floats(f, (first + from) * f->components, rows * f->components, y);
		linear_product(out + from * f->channels, f->channels, f->mean, 0,
			(struct linear_matrix){y, f->components, 1}, basis, rows, f->channels, f->components);
	}
	for (size_t i = 0; i < n; i++)
		if (!(f->weight[first + i] > 0))
			memset(out + i * f->channels, 0, f->channels * sizeof *out);
}

void features_floats(const struct features *f, size_t first, size_t n, float *out)
{
	if (f->components)
		expand(f, first, n, out);
	else
		stored_floats(f, first * f->channels, n * f->channels, out);
}

int features_write(const struct features *f, const char *path, const char *options, struct err *e)
{
	const int64_t n = (int64_t)f->gaussians, c = (int64_t)f->channels, k = (int64_t)f->components;
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.features", k ? "2" : "1", "feature-lift", options, 0, e);
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", f->gaussians));
	arrays_out_text(&out, "scene", fingerprint_text(&f->scene));
	arrays_out_put(&out,
		f->labels ? st_vector("labels", ST_I32, n, f->labels)
			  : st_matrix("features", f->is_half ? ST_F16 : ST_F32, n, k ? k : c, f->values));
	arrays_out_put(&out, st_vector("reliability", ST_F32, n, f->reliability));
	arrays_out_put(&out, st_vector("weight", ST_F32, n, f->weight));
	if (k) {
		char error[NUMBER_SIZE];
		arrays_out_text(&out, "error", arrays_out_print(&out, "%s", number_text(error, f->error)));
		arrays_out_put(&out, st_matrix("basis", ST_F32, k, c, f->basis));
		arrays_out_put(&out, st_vector("mean", ST_F32, c, f->mean));
	}
	return arrays_out_end(&out);
}
