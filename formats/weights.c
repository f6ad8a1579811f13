#include "formats/weights.h"

#include "base/mem.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION_READ = 1, MAX_SIDE = 65536 };

static int check_indptr(const struct weights *w, int64_t pixels, int64_t nnz, struct err *e)
{
	const char *path = w->file.path;

	if (w->indptr[0])
		return err_set(e, ERR_FORMAT, "%s: tensor 'indptr': begins with %lld, not 0", path,
			(long long)w->indptr[0]);
	for (int64_t p = 0; p < pixels; p++)
		if (w->indptr[p + 1] < w->indptr[p])
			return err_set(e, ERR_FORMAT, "%s: tensor 'indptr': falls after pixel %lld", path,
				(long long)p);
	if (w->indptr[pixels] != nnz)
		return err_set(e, ERR_FORMAT,
			"%s: tensor 'indptr': ends with %lld, but there are %lld weights", path,
			(long long)w->indptr[pixels], (long long)nnz);
	return 0;
}

static int check_values(const struct weights *w, int64_t pixels, int64_t nnz, struct err *e)
{
	const char *path = w->file.path;

	for (int64_t i = 0; i < nnz; i++)
		if (w->index[i] < 0 || w->index[i] >= w->gaussians)
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'index': entry %lld is %d, not in 0 to %lld", path, (long long)i,
				(int)w->index[i], (long long)w->gaussians - 1);
	for (int64_t i = 0; i < nnz; i++)
		if (!(w->weight[i] >= 0 && w->weight[i] <= 1))
			return err_set(e, ERR_FORMAT, "%s: tensor 'weight': entry %lld is %g, not in 0 to 1",
				path, (long long)i, (double)w->weight[i]);
	for (int64_t p = 0; p < pixels; p++)
		if (!(w->dropped[p] >= 0 && w->dropped[p] <= 1))
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'dropped': pixel %lld has %g, not in 0 to 1", path, (long long)p,
				(double)w->dropped[p]);
	return 0;
}

/* Half weights become floats of our own; float ones stay where they are. */
static int read_weight(struct weights *w, int64_t nnz, struct err *e)
{
	const struct st_tensor *t = safetensors_find(&w->file, "weight");

	if (!t || t->dtype != ST_F16) {
		t = safetensors_need(&w->file, "weight", ST_F32, 1, &nnz, e);
		w->weight = t ? t->data : NULL;
		return t ? 0 : -1;
	}
	if (!safetensors_need(&w->file, "weight", ST_F16, 1, &nnz, e))
		return -1;
	w->owned = mem_alloc((size_t)nnz, sizeof *w->owned, w->file.path, e);
	w->weight = w->owned;
	return w->owned ? safetensors_to_float(t, w->owned, (size_t)nnz, e) : -1;
}

static int read_all(struct weights *w, struct err *e)
{
	const struct safetensors *st = &w->file;
	const struct st_tensor *indptr, *index, *dropped;
	long long width = 0, height = 0, gaussians = 0;

	if (safetensors_need_format(st, "refer.weights", VERSION_READ, e) ||
		safetensors_meta_int(st, "width", 1, MAX_SIDE, &width, e) ||
		safetensors_meta_int(st, "height", 1, MAX_SIDE, &height, e) ||
		safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &gaussians, e))
		return -1;
	w->width = (int)width;
	w->height = (int)height;
	w->gaussians = gaussians;
	int64_t pixels = width * height, any = -1, ends = pixels + 1;
	if (!(indptr = safetensors_need(st, "indptr", ST_I64, 1, &ends, e)) ||
		!(index = safetensors_need(st, "index", ST_I32, 1, &any, e)) ||
		!(dropped = safetensors_need(st, "dropped", ST_F32, 1, &pixels, e)) ||
		read_weight(w, index->shape[0], e))
		return -1;
	w->indptr = indptr->data;
	w->index = index->data;
	w->dropped = dropped->data;
	return check_indptr(w, pixels, index->shape[0], e) || check_values(w, pixels, index->shape[0], e) ? -1
													  : 0;
}

int weights_open_file(struct weights *w, const char *path, struct err *e)
{
	*w = (struct weights){0};
	if (!safetensors_open(&w->file, path, e) && !read_all(w, e))
		return 0;
	weights_close(w);
	return -1;
}

int weights_open(struct weights *w, const char *dir, const char *view, struct err *e)
{
	char *path = file_join(dir, view, ".safetensors", e);

	*w = (struct weights){0};
	int bad = path ? weights_open_file(w, path, e) : -1;
	free(path);
	return bad;
}

void weights_close(struct weights *w)
{
	safetensors_close(&w->file);
	free(w->owned);
	*w = (struct weights){0};
}

int weights_write(const struct weights *w, const char *dir, const char *view, int is_half,
	const char *options, struct err *e)
{
	int64_t pixels = (int64_t)w->width * w->height, nnz = w->indptr[pixels];
	char *path = file_join(dir, view, ".safetensors", e), width[16], height[16], gaussians[24];
	uint16_t *half = is_half ? mem_alloc((size_t)nnz, sizeof *half, "half weights", e) : NULL;
	int bad = -1;

	if (!path || (is_half && !half))
		goto done;
	for (int64_t i = 0; is_half && i < nnz; i++)
		half[i] = st_float_to_half(w->weight[i]);
	snprintf(width, sizeof width, "%d", w->width);
	snprintf(height, sizeof height, "%d", w->height);
	snprintf(gaussians, sizeof gaussians, "%lld", (long long)w->gaussians);
	struct st_tensor tensors[] = {
		{.name = "indptr", .dtype = ST_I64, .dims = 1, .shape = {pixels + 1}, .data = w->indptr},
		{.name = "index", .dtype = ST_I32, .dims = 1, .shape = {nnz}, .data = w->index},
		{.name = "dropped", .dtype = ST_F32, .dims = 1, .shape = {pixels}, .data = w->dropped},
		{.name = "weight",
			.dtype = is_half ? ST_F16 : ST_F32,
			.dims = 1,
			.shape = {nnz},
			.data = is_half ? (const void *)half : w->weight},
	};
	struct st_meta meta[] = {{"format", "refer.weights"}, {"version", "1"}, {"tool", "gs-weigh"},
		{"options", options}, {"seed", "0"}, {"view", view}, {"width", width}, {"height", height},
		{"gaussians", gaussians}};
	bad = safetensors_write(
		path, tensors, sizeof tensors / sizeof *tensors, meta, sizeof meta / sizeof *meta, e);
done:
	free(path);
	free(half);
	return bad;
}
