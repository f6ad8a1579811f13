#include "formats/scene/motion.h"

#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "formats/arrays/arrays_out.h"

#include <math.h>

/* Numbers of a Gaussian at a time, in the order in which they wait. */
enum { MEAN = 3, QUAT = 4, SCALE = 3, ALL = MEAN + QUAT + SCALE };

static int check_times(const struct motion *m, struct err *e)
{
	const char *path = m->file.path;

	if (!m->times)
		return err_file(e, path, "tensor 'times': there is none");
	for (size_t t = 0; t < m->times; t++)
		if (!isfinite(m->at[t]) || (t && !(m->at[t] > m->at[t - 1])))
			return err_file(
				e, path, "tensor 'times': item %zu does not rise, or is not finite", t);
	for (size_t k = 0; k < m->moved; k++)
		if (m->ids[k] < (k ? m->ids[k - 1] + 1 : 0) || (size_t)m->ids[k] >= m->gaussians)
			return err_file(e, path, "tensor 'ids': item %zu does not rise within 0 to %zu", k,
				m->gaussians - 1);
	return 0;
}

static int check_values(const struct motion *m, struct err *e)
{
	const size_t n = m->times * m->moved;

	for (size_t i = 0; i < n; i++) {
		const float *q = m->quats + QUAT * i;
		const double length =
			(double)fabsf(q[0]) + (double)fabsf(q[1]) + (double)fabsf(q[2]) + (double)fabsf(q[3]);
		if (!(length > 0) || !isfinite(length))
			return err_file(e, m->file.path,
				"tensor 'quats': Gaussian %d at time %.17g is zero or not finite",
				(int)m->ids[i % m->moved], m->at[i / m->moved]);
	}
	for (size_t i = 0; i < SCALE * n && m->scales; i++)
		if (!(m->scales[i] >= 0) || !isfinite(m->scales[i]))
			return err_file(
				e, m->file.path, "tensor 'scales': item %zu is negative or not finite", i);
	return safetensors_check_finite(&m->file, "means", m->means, MEAN * n, e);
}

static const float *need(const struct motion *m, const char *name, int64_t width, struct err *e)
{
	const int64_t shape[] = {(int64_t)m->times, (int64_t)m->moved, width};
	const struct st_tensor *t = safetensors_need(&m->file, name, ST_F32, 3, shape, e);

	return t ? t->data : NULL;
}

static int read_all(struct motion *m, struct err *e)
{
	const struct safetensors *st = &m->file;
	struct arrays_in in;

	arrays_in_begin(&in, st, "refer.motion", 1, e);
	m->gaussians = arrays_in_count(&in, "gaussians");
	in.bad = in.bad || fingerprint_read(&m->scene, st, "scene", e);
	m->at = arrays_in_place(&in, "times", ST_F64, -1, &m->times);
	m->ids = arrays_in_place(&in, "ids", ST_I32, -1, &m->moved);
	if (in.bad || check_times(m, e) || !(m->means = need(m, "means", MEAN, e)) ||
		!(m->quats = need(m, "quats", QUAT, e)) ||
		(safetensors_find(st, "scales") && !(m->scales = need(m, "scales", SCALE, e))))
		return -1;
	return check_values(m, e);
}

int motion_open(struct motion *m, const char *path, struct err *e)
{
	*m = (struct motion){0};
	return -(safetensors_open(&m->file, path, e) || read_all(m, e));
}

void motion_close(struct motion *m)
{
	safetensors_close(&m->file);
	*m = (struct motion){0};
}

int motion_differs(const float *a, const float *b, size_t n)
{
	for (size_t i = 0; i < n; i++)
		if (a[i] != b[i])
			return 1;
	return 0;
}

int motion_find(const struct motion *m, double t, size_t *frame, struct err *e)
{
	size_t low = 0, high = m->times - 1;

	*frame = 0;
	if (!(t >= m->at[low] && t <= m->at[high]))
		return err_file(e, m->file.path, "time %.17g is not within its times, %.17g to %.17g", t,
			m->at[low], m->at[high]);
	while (high - low > 1) {
		const size_t middle = low + (high - low) / 2;
		*(t < m->at[middle] ? &high : &low) = middle;
	}
	*frame = m->at[high] - t < t - m->at[low] ? high : low;
	return 0;
}

int motion_set(const struct motion *m, double t, struct splats *s, struct err *e)
{
	size_t frame;

	if (motion_find(m, t, &frame, e))
		return -1;
	for (size_t k = 0; k < m->moved; k++) {
		const size_t i = (size_t)m->ids[k], from = frame * m->moved + k;
		memcpy(s->means + MEAN * i, m->means + MEAN * from, MEAN * sizeof(float));
		memcpy(s->quats + QUAT * i, m->quats + QUAT * from, QUAT * sizeof(float));
		if (m->scales)
			memcpy(s->scales + SCALE * i, m->scales + SCALE * from, SCALE * sizeof(float));
	}
	return 0;
}

int motion_out_begin(
	struct motion_out *o, const char *path, const struct splats *first, size_t times, struct err *e)
{
	*o = (struct motion_out){.first = first,
		.times = times,
		.is_moved = mem_zalloc(first->n, 1, path, e),
		.row = mem_alloc(first->n, ALL * sizeof *o->row, path, e),
		.parts = mem_zalloc(times, sizeof *o->parts, path, e),
		.put = {.path = path},
		.gathered = {.path = path}};
	return o->is_moved && o->row && o->parts ? motion_out_put(o, 0, first, e) : -1;
}

int motion_out_put(struct motion_out *o, size_t frame, const struct splats *s, struct err *e)
{
	const struct splats *f = o->first;
	const size_t n = f->n;
	const struct scratch_piece pieces[] = {{s->means, MEAN * n * sizeof(float)},
		{s->quats, QUAT * n * sizeof(float)}, {s->scales, SCALE * n * sizeof(float)}};

	for (size_t i = 0; i < n && frame; i++) {
		const int resized = motion_differs(s->scales + SCALE * i, f->scales + SCALE * i, SCALE);
		o->has_scales |= resized;
		o->is_moved[i] |= resized || motion_differs(s->means + MEAN * i, f->means + MEAN * i, MEAN) ||
				  motion_differs(s->quats + QUAT * i, f->quats + QUAT * i, QUAT);
	}
	return scratch_put(&o->put, pieces, 3, &o->parts[frame], e);
}

/* The moved Gaussians' `width` numbers from the `skip`th of a Gaussian on, time after time. */
static int gather(struct motion_out *o, const int32_t *ids, size_t moved, size_t skip, size_t width,
	struct scratch_part *to, struct err *e)
{
	int bad = scratch_put(&o->gathered, NULL, 0, to, e);

	for (size_t t = 0; t < o->times && !bad; t++) {
		SCOPED_BY(file_unmap) struct file_map map = {0};
		bad = scratch_map(&o->put, &o->parts[t], &map, e);
		const float *from = bad ? NULL : (const float *)(const void *)map.data + skip * o->first->n;
		for (size_t k = 0; k < moved && !bad; k++)
			memcpy(o->row + width * k, from + width * (size_t)ids[k], width * sizeof *from);
		bad = bad || scratch_more(&o->gathered, o->row, moved * width * sizeof *from, to, e);
	}
	return bad;
}

static int write_all(const struct motion_out *o, const double *at, const int32_t *ids, size_t moved,
	const struct file_map maps[3], struct err *e)
{
	const int64_t t = (int64_t)o->times, m = (int64_t)moved;
	const struct fingerprint scene = fingerprint_scene(o->first);
	struct arrays_out out;

	arrays_out_begin(&out, o->put.path, "refer.motion", "1", "gs-import", "", 0, e);
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", o->first->n));
	arrays_out_text(&out, "scene", scene.hex);
	arrays_out_put(&out, st_vector("times", ST_F64, t, at));
	arrays_out_put(&out, st_vector("ids", ST_I32, m, ids));
	arrays_out_put(&out, (struct st_tensor){"means", ST_F32, 3, {t, m, MEAN}, maps[0].data, 0});
	arrays_out_put(&out, (struct st_tensor){"quats", ST_F32, 3, {t, m, QUAT}, maps[1].data, 0});
	if (o->has_scales)
		arrays_out_put(&out, (struct st_tensor){"scales", ST_F32, 3, {t, m, SCALE}, maps[2].data, 0});
	return arrays_out_end(&out);
}

int motion_out_end(struct motion_out *o, const double *at, size_t *moved, struct err *e)
{
	static const size_t skip[] = {0, MEAN, MEAN + QUAT}, width[] = {MEAN, QUAT, SCALE};
	SCOPED int32_t *ids = mem_alloc(o->first->n, sizeof *ids, o->put.path, e);
	struct file_map maps[3] = {{0}};
	int bad = !ids;

	*moved = 0;
	for (size_t i = 0; i < o->first->n && !bad; i++)
		if (o->is_moved[i])
			ids[(*moved)++] = (int32_t)i;
	for (int k = 0; k < 3 && !bad && *moved; k++) {
		struct scratch_part part;
		bad = gather(o, ids, *moved, skip[k], width[k], &part, e) ||
		      scratch_map(&o->gathered, &part, &maps[k], e);
	}
	bad = bad || write_all(o, at, ids, *moved, maps, e);
	for (int k = 0; k < 3; k++)
		file_unmap(&maps[k]);
	return bad ? -1 : 0;
}

void motion_out_free(struct motion_out *o)
{
	scratch_close(&o->put);
	scratch_close(&o->gathered);
	mem_free_all(o->is_moved, o->row, o->parts);
	*o = (struct motion_out){0};
}
