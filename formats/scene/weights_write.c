/* Writing of weights, as they are or packed. */
#include "base/half.h"
#include "formats/scene/weights.h"
#include "splat/weights_pack.h"

#include <stdlib.h>

enum { LEVELS = 255 };

static uint8_t level(float weight)
{
	return (uint8_t)(weight * LEVELS + 0.5f);
}

static void put_plain(struct arrays_out *out, const struct weights *w, int64_t pixels)
{
	const int64_t nnz = w->indptr[pixels];
	const enum st_dtype dtype = precision_dtype(w->precision);
	void *own = w->precision == PRECISION_F32 ? NULL
						  : arrays_out_memory(out, (size_t)nnz, st_dtype_size(dtype));

	for (int64_t i = 0; i < nnz && own; i++)
		if (w->precision == PRECISION_F16)
			((uint16_t *)own)[i] = half_of_float(w->weight[i]);
		else
			((uint8_t *)own)[i] = level(w->weight[i]);
	arrays_out_put(out, st_vector("indptr", ST_I64, pixels + 1, w->indptr));
	arrays_out_put(out, st_vector("index", ST_I32, nnz, w->index));
	arrays_out_put(out, st_vector("dropped", ST_F32, pixels, w->dropped));
	arrays_out_put(out, st_vector("weight", dtype, nnz, own ? own : w->weight));
}

static void put_packed(struct arrays_out *out, const struct weights *w, int64_t pixels)
{
	uint8_t *dropped = arrays_out_memory(out, (size_t)pixels, 1);
	int64_t *sizes = arrays_out_memory(out, WEIGHTS_STREAMS, sizeof *sizes);

	if (!dropped || !sizes)
		return;
	for (int64_t p = 0; p < pixels; p++)
		dropped[p] = level(w->dropped[p]);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		sizes[s] = (int64_t)w->pack->bytes[s];
	arrays_out_put(out, st_vector("sizes", ST_I64, WEIGHTS_STREAMS, sizes));
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		arrays_out_put(out, st_vector(weights_stream_name[s], ST_U8, (int64_t)w->pack->packed[s],
					    w->pack->data[s]));
	arrays_out_put(out, st_vector("dropped", ST_U8, pixels, dropped));
}

int weights_write(
	const struct weights *w, const char *dir, const char *view, const char *options, struct err *e)
{
	char *path = file_join(dir, view, ".safetensors", e);
	struct arrays_out out;

	if (!path)
		return -1;
	arrays_out_begin(&out, path, "refer.weights", w->pack ? "3" : "1", "gs-weigh", options, 0, e);
	arrays_out_text(&out, "view", view);
	arrays_out_text(&out, "width", arrays_out_print(&out, "%d", w->width));
	arrays_out_text(&out, "height", arrays_out_print(&out, "%d", w->height));
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%lld", (long long)w->gaussians));
	arrays_out_text(&out, "scene", fingerprint_text(&w->scene));
	arrays_out_text(&out, "camera", fingerprint_text(&w->camera));
	(w->pack ? put_packed : put_plain)(&out, w, (int64_t)w->width * w->height);
	const int bad = arrays_out_end(&out);
	free(path);
	return bad;
}
