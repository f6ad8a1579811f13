#include "formats/scene/weights.h"

#include "base/half.h"
#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "splat/weights_pack.h"

/* A zstd block of 4 bytes may repeat one 131,072 times. */
enum { VERSION_READ = 3, MAX_SIDE = 65536, LEVELS = 255, RATIO = 32768 };

static int check_indptr(const struct weights *w, int64_t pixels, int64_t nnz, struct err *e)
{
	const char *path = w->file.path;

	if (w->indptr[0])
		return err_file(e, path, "tensor 'indptr': begins with %lld, not 0", (long long)w->indptr[0]);
	for (int64_t p = 0; p < pixels; p++)
		if (w->indptr[p + 1] < w->indptr[p])
			return err_file(e, path, "tensor 'indptr': falls after pixel %lld", (long long)p);
	if (w->indptr[pixels] != nnz)
		return err_file(e, path, "tensor 'indptr': ends with %lld, but there are %lld weights",
			(long long)w->indptr[pixels], (long long)nnz);
	return 0;
}

/* 1 where every item, a whole number or a float's bits, is 0 to limit, which is below 2^31. There is no
 * branch in the loop, so that it runs as fast as memory. */
static int all_within(const void *data, int64_t n, uint32_t limit)
{
	const unsigned char *at = data;
	uint32_t outside = 0;

	for (int64_t i = 0; i < n; i++) {
		uint32_t item;
		memcpy(&item, at + 4 * i, 4);
		outside |= item | (limit - item);
	}
	return !(outside >> 31);
}

/* Floats from 0 to 1 have the bits of a whole number from 0 to that of 1; only -0 is another. */
static int64_t find_not_share(const float *x, int64_t n)
{
	const float one = 1;
	uint32_t limit;

	memcpy(&limit, &one, 4);
	if (all_within(x, n, limit))
		return -1;
	for (int64_t i = 0; i < n; i++)
		if (!(x[i] >= 0 && x[i] <= 1))
			return i;
	return -1;
}

static int check_values(const struct weights *w, int64_t pixels, int64_t nnz, struct err *e)
{
	const char *path = w->file.path;
	int64_t at;

	if (!all_within(w->index, nnz, (uint32_t)w->gaussians - 1))
		for (int64_t i = 0; i < nnz; i++)
			if (w->index[i] < 0 || w->index[i] >= w->gaussians)
				return err_file(e, path, "tensor 'index': entry %lld is %d, not in 0 to %lld",
					(long long)i, (int)w->index[i], (long long)w->gaussians - 1);
	if ((at = find_not_share(w->weight, nnz)) >= 0)
		return err_file(e, path, "tensor 'weight': entry %lld is %g, not in 0 to 1", (long long)at,
			(double)w->weight[at]);
	if ((at = find_not_share(w->dropped, pixels)) >= 0)
		return err_file(e, path, "tensor 'dropped': pixel %lld has %g, not in 0 to 1", (long long)at,
			(double)w->dropped[at]);
	return 0;
}

/* Float weights stay where they are; others become floats of our own. */
static int read_weight(struct weights *w, int64_t nnz, struct err *e)
{
	const struct st_tensor *t = safetensors_find(&w->file, "weight");

	if (t && t->dtype == ST_F16)
		w->precision = PRECISION_F16;
	if (t && t->dtype == ST_U8)
		w->precision = PRECISION_U8;
	t = safetensors_need(&w->file, "weight", precision_dtype(w->precision), 1, &nnz, e);
	if (!t)
		return -1;
	w->weight = t->data;
	if (w->precision == PRECISION_F32)
		return 0;
	w->weight = w->owned = mem_alloc((size_t)nnz, sizeof *w->owned, w->file.path, e);
	if (!w->owned)
		return -1;
	if (w->precision == PRECISION_F16)
		return safetensors_to_float(t, w->owned, (size_t)nnz, e);
	const uint8_t *levels = t->data;
	for (int64_t i = 0; i < nnz; i++)
		w->owned[i] = (float)levels[i] / LEVELS;
	return 0;
}

/* Packed weights as rows of pixels, or as tiles. */
static int unpack(struct weights *w, const struct weights_pack *pack, int as_tiles, struct err *e)
{
	if (!w->room)
		w->room = mem_zalloc(1, sizeof *w->room, w->file.path, e);
	if (!w->room || (as_tiles ? weights_unpack_tiles : weights_unpack)(
				pack, w->width, w->height, w->gaussians, w->file.path, w->room, e))
		return -1;
	if (as_tiles) {
		w->tiles = &w->room->tiles;
		return 0;
	}
	w->indptr = w->room->indptr;
	w->index = w->room->index;
	w->weight = w->room->weight;
	return 0;
}

/* Packed weights become arrays of our own. */
static int read_packed(struct weights *w, struct arrays_in *in, int64_t pixels, int as_tiles)
{
	const int64_t *sizes = arrays_in_place(in, "sizes", ST_I64, WEIGHTS_STREAMS, NULL);
	const uint8_t *dropped = arrays_in_place(in, "dropped", ST_U8, pixels, NULL);
	const char *version = safetensors_meta(in->st, "version");
	struct weights_pack pack = {0};

	if (!in->bad && strcmp(version, "3"))
		return err_file(in->e, w->file.path,
			"refer.weights, packed, version %s is older than this program reads (3)", version);
	for (int s = 0; s < WEIGHTS_STREAMS && !in->bad; s++) {
		const void *data = arrays_in_place(in, weights_stream_name[s], ST_U8, -1, &pack.packed[s]);
		if (data && (sizes[s] < 0 || sizes[s] / RATIO > (int64_t)pack.packed[s]))
			in->bad =
				err_file(in->e, w->file.path, "tensor 'sizes': %lld bytes cannot be in '%s'",
					(long long)sizes[s], weights_stream_name[s]);
		pack.bytes[s] = (size_t)sizes[s];
		pack.data[s] = (uint8_t *)(size_t)data;
	}
	w->precision = PRECISION_U8;
	w->is_packed = 1;
	w->dropped = w->owned_dropped =
		in->bad ? NULL : mem_alloc((size_t)pixels, sizeof *w->owned_dropped, w->file.path, in->e);
	if (!w->owned_dropped || unpack(w, &pack, as_tiles, in->e))
		return -1;
	for (int64_t p = 0; p < pixels; p++)
		w->owned_dropped[p] = (float)dropped[p] / LEVELS;
	return 0;
}

static int read_all(struct weights *w, int as_tiles, struct err *e)
{
	const struct safetensors *st = &w->file;
	struct arrays_in in;
	long long width = 0, height = 0;
	size_t nnz;

	arrays_in_begin(&in, st, "refer.weights", VERSION_READ, e);
	in.bad = in.bad || safetensors_meta_int(st, "width", 1, MAX_SIDE, &width, e) ||
		 safetensors_meta_int(st, "height", 1, MAX_SIDE, &height, e);
	w->width = (int)width;
	w->height = (int)height;
	w->gaussians = (int64_t)arrays_in_count(&in, "gaussians");
	in.bad = in.bad || fingerprint_read(&w->scene, st, "scene", e) ||
		 fingerprint_read(&w->camera, st, "camera", e);
	const int64_t pixels = width * height;
	if (safetensors_find(st, "maps"))
		return read_packed(w, &in, pixels, as_tiles);
	w->indptr = arrays_in_place(&in, "indptr", ST_I64, pixels + 1, NULL);
	w->index = arrays_in_place(&in, "index", ST_I32, -1, &nnz);
	w->dropped = arrays_in_place(&in, "dropped", ST_F32, pixels, NULL);
	return -(in.bad || read_weight(w, (int64_t)nnz, e) || check_indptr(w, pixels, (int64_t)nnz, e) ||
		 check_values(w, pixels, (int64_t)nnz, e));
}

static int open_file(
	struct weights *w, struct weights_room *room, const char *path, int as_tiles, struct err *e)
{
	*w = (struct weights){.room = room, .is_lent = room != NULL};
	if (!safetensors_open(&w->file, path, e) && !read_all(w, as_tiles, e))
		return 0;
	weights_close(w);
	return -1;
}

int weights_open_file(struct weights *w, const char *path, struct err *e)
{
	return open_file(w, NULL, path, 0, e);
}

/* That they are of this scene, and of this camera at the size that they have. */
static int check_origin(const struct weights *w, const struct scene *scene, size_t view, struct err *e)
{
	const struct camera sized = camera_resize(&scene->cameras.views[view], w->width, w->height);
	const struct fingerprint camera = fingerprint_camera(&sized);
	const char *path = w->file.path;

	if (scene_check(scene, path, (size_t)w->gaussians, &w->scene, e))
		return -1;
	SCOPED char *cameras = file_join(scene->path, "cameras.json", "", e);
	return !cameras || fingerprint_check("camera", path, &w->camera, cameras, &camera, e) ? -1 : 0;
}

int weights_open_in(struct weights *w, struct weights_room *room, enum weights_form form, const char *dir,
	const struct scene *scene, size_t view, struct err *e)
{
	SCOPED char *path = file_join(dir, scene->cameras.views[view].name, ".safetensors", e);

	*w = (struct weights){0};
	int bad = path ? open_file(w, room, path, form == WEIGHTS_TILES, e) : -1;
	if (!bad && (bad = check_origin(w, scene, view, e)))
		weights_close(w);
	return bad;
}

int weights_open(struct weights *w, const char *dir, const struct scene *scene, size_t view, struct err *e)
{
	return weights_open_in(w, NULL, WEIGHTS_ROWS, dir, scene, view, e);
}

void weights_close(struct weights *w)
{
	safetensors_close(&w->file);
	free(w->owned);
	if (w->room && !w->is_lent) {
		weights_room_free(w->room);
		free(w->room);
	}
	free(w->owned_dropped);
	*w = (struct weights){0};
}

struct view_weights weights_view(const struct weights *w)
{
	return (struct view_weights){
		(size_t)w->width * (size_t)w->height, (size_t)w->gaussians, w->indptr, w->index, w->weight};
}

struct view_matrix weights_matrix(const struct weights *w)
{
	return (struct view_matrix){w->height, w->width, (size_t)w->gaussians, weights_view(w), w->tiles};
}

int weights_mark(const char *dir, const struct cameras *cameras, char *there, size_t *missing, struct err *e)
{
	size_t training = 0;

	*missing = 0;
	for (size_t v = 0; v < cameras->n; v++) {
		there[v] = 0;
		if (cameras->views[v].split != SPLIT_TRAIN)
			continue;
		training++;
		SCOPED char *path = file_join(dir, cameras->views[v].name, ".safetensors", e);
		if (!path)
			return -1;
		there[v] = (char)file_exists(path);
		*missing += !there[v];
	}
	/* Where none has, the folder is another one than was meant. */
	return training && *missing == training
		       ? err_set(e, ERR_SYSTEM, "%s: has no weights of a training view", dir)
		       : 0;
}

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
	SCOPED char *path = file_join(dir, view, ".safetensors", e);
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
	return arrays_out_end(&out);
}
