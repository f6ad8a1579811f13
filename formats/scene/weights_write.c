/* Writing of weights, as they are or packed. */
#include "base/half.h"
#include "base/mem.h"
#include "formats/scene/weights.h"
#include "splat/weights_pack.h"

#include <stdio.h>
#include <stdlib.h>

enum { LEVELS = 255 };

/* The weights as the file has them: its own, or a converted copy in *owned. */
static const void *convert(const struct weights *w, int64_t nnz, void **owned, struct err *e)
{
	if (w->precision == PRECISION_F32)
		return w->weight;
	*owned = mem_alloc((size_t)nnz, st_dtype_size(precision_dtype(w->precision)), "weights", e);
	if (*owned && w->precision == PRECISION_F16)
		for (int64_t i = 0; i < nnz; i++)
			((uint16_t *)*owned)[i] = half_of_float(w->weight[i]);
	else if (*owned)
		for (int64_t i = 0; i < nnz; i++)
			((uint8_t *)*owned)[i] = (uint8_t)(w->weight[i] * LEVELS + 0.5f);
	return *owned;
}

/* The file's tensors: the weights as they are, or packed. Data that are made are its own. */
struct written {
	struct st_tensor tensors[5];
	size_t n;
	int64_t sizes[WEIGHTS_STREAMS];
	void *converted;
	uint8_t *dropped;
};

static void put(struct written *t, const char *name, enum st_dtype dtype, int64_t length, const void *data)
{
	t->tensors[t->n++] = st_vector(name, dtype, length, data);
}

static int put_plain(struct written *t, const struct weights *w, int64_t pixels, struct err *e)
{
	const int64_t nnz = w->indptr[pixels];
	const void *data = convert(w, nnz, &t->converted, e);

	if (!data)
		return -1;
	put(t, "indptr", ST_I64, pixels + 1, w->indptr);
	put(t, "index", ST_I32, nnz, w->index);
	put(t, "dropped", ST_F32, pixels, w->dropped);
	put(t, "weight", precision_dtype(w->precision), nnz, data);
	return 0;
}

static int put_packed(struct written *t, const struct weights *w, int64_t pixels, struct err *e)
{
	t->dropped = mem_alloc((size_t)pixels, 1, "weights", e);
	if (!t->dropped)
		return -1;
	for (int64_t p = 0; p < pixels; p++)
		t->dropped[p] = (uint8_t)(w->dropped[p] * LEVELS + 0.5f);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		t->sizes[s] = (int64_t)w->pack->bytes[s];
	put(t, "sizes", ST_I64, WEIGHTS_STREAMS, t->sizes);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		put(t, weights_stream_name[s], ST_U8, (int64_t)w->pack->packed[s], w->pack->data[s]);
	put(t, "dropped", ST_U8, pixels, t->dropped);
	return 0;
}

int weights_write(
	const struct weights *w, const char *dir, const char *view, const char *options, struct err *e)
{
	const int64_t pixels = (int64_t)w->width * w->height;
	char *path = file_join(dir, view, ".safetensors", e), width[16], height[16], gaussians[24];
	struct written t = {0};
	int bad = !path || (w->pack ? put_packed : put_plain)(&t, w, pixels, e);

	snprintf(width, sizeof width, "%d", w->width);
	snprintf(height, sizeof height, "%d", w->height);
	snprintf(gaussians, sizeof gaussians, "%lld", (long long)w->gaussians);
	struct st_meta meta[] = {{"format", "refer.weights"}, {"version", w->pack ? "3" : "1"},
		{"tool", "gs-weigh"}, {"options", options}, {"seed", "0"}, {"view", view}, {"width", width},
		{"height", height}, {"gaussians", gaussians}, {"scene", fingerprint_text(&w->scene)},
		{"camera", fingerprint_text(&w->camera)}};
	bad = bad || safetensors_write(path, t.tensors, t.n, meta, sizeof meta / sizeof *meta, e);
	free(path);
	free(t.converted);
	free(t.dropped);
	return bad ? -1 : 0;
}
