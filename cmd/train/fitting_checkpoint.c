#include "cmd/train/fitting_checkpoint.h"

#include "base/mem.h"
#include "formats/arrays/safetensors.h"

#define FORMAT "gs.checkpoint"
enum { STATE = sizeof(struct fit_state) / sizeof(int64_t) };

/* What a checkpoint has: the tensors' data are the fit's own. Returns how many there are. */
static size_t list(struct fit *f, struct st_tensor *t)
{
	float *const *values = f->gaussians.at[FIT_VALUE];
	const int64_t slab = f->gaussians.at[FIT_GRADIENT][0] - values[0],
		      capacity = (int64_t)f->gaussians.capacity, views = (int64_t)f->views;
	size_t n = 0;

	t[n++] = (struct st_tensor){"state", ST_I64, 1, {STATE}, &f->state, 0};
	t[n++] = (struct st_tensor){"order", ST_I32, 1, {views}, f->order, 0};
	t[n++] = (struct st_tensor){"values", ST_F32, 1, {slab}, values[0], 0};
	t[n++] = (struct st_tensor){"moments", ST_F32, 1, {2 * slab}, f->gaussians.at[FIT_MOMENT1][0], 0};
	t[n++] = (struct st_tensor){"weight", ST_F32, 1, {capacity}, f->weight, 0};
	if (f->exposures.n)
		t[n++] = (struct st_tensor){
			"exposures", ST_F32, 1, {3 * EXPOSURE_WIDTH * views}, f->exposures.values, 0};
	return n;
}

int fitting_checkpoint_write(struct fit *f, const char *path, const char *identity, struct err *e)
{
	const struct st_meta meta[] = {
		{"format", FORMAT}, {"version", "1"}, {"tool", "gs-train"}, {"identity", identity}};
	struct st_tensor tensors[6];

	f->state.gaussians = (int64_t)f->gaussians.n;
	return safetensors_write(path, tensors, list(f, tensors), meta, sizeof meta / sizeof *meta, e);
}

static int read_state(struct fit *f, const struct safetensors *st, const char *identity, struct err *e)
{
	struct st_tensor tensors[6];
	const size_t n = list(f, tensors);

	if (safetensors_need_format(st, FORMAT, 1, e))
		return -1;
	const char *own = safetensors_meta(st, "identity");
	if (!own || strcmp(own, identity))
		return err_set(e, ERR_FORMAT,
			"%s: is of another training (its options or inputs differ); remove it or train without --resume",
			st->path);
	for (size_t i = 0; i < n; i++) {
		const struct st_tensor *t =
			safetensors_need(st, tensors[i].name, tensors[i].dtype, 1, tensors[i].shape, e);
		if (!t)
			return -1;
		memcpy((void *)tensors[i].data, t->data, t->bytes);
	}
	int bad = f->state.gaussians < 1 || (size_t)f->state.gaussians > f->gaussians.capacity ||
		  f->state.iteration < 0;
	for (size_t i = 0; i < f->views; i++)
		bad |= f->order[i] >= f->views;
	f->gaussians.n = (size_t)f->state.gaussians;
	return bad || fit_check(f, e)
		       ? err_set(e, ERR_FORMAT, "%s: its numbers are not those of a training; remove it",
				 st->path)
		       : 0;
}

int fitting_checkpoint_read(struct fit *f, const char *path, const char *identity, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	return read_state(f, &st, identity, e);
}
