#include "cmd/import/moving.h"

#include "base/each.h"
#include "base/file.h"
#include "base/mem.h"
#include "cmd/import/frames.h"

#include <math.h>
#include <stdio.h>

int moving_check_views(const struct moving *m, const struct cameras *c, const char *cameras, struct err *e)
{
	const char *path = file_name(cameras);

	for (size_t i = 0; i < c->n; i++) {
		const struct camera *v = &c->views[i];
		if (v->has_time != c->views[0].has_time)
			return err_file(e, path, "view '%s' has %s time, and view '%s' has %s", v->name,
				v->has_time ? "a" : "no", c->views[0].name, v->has_time ? "none" : "one");
		if (v->has_time && !(v->time >= m->times[0] && v->time <= m->times[m->n - 1]))
			return err_file(e, path,
				"view '%s': time %.17g is not within those of %s, %.17g to %.17g: --times says them",
				v->name, v->time, m->from, m->times[0], m->times[m->n - 1]);
	}
	return 0;
}

/* An array of so many numbers for each Gaussian at each time. */
static int open_array(struct moving *m, const char *name, size_t width, struct npy *a, struct err *e)
{
	SCOPED char *called = NULL;

	if (npz_array(&m->archive, name, "", a, &called, e))
		return -1;
	if (a->dims != 3 || a->shape[2] != width)
		return err_set(e, ERR_FORMAT, "%s: has not the shape [T,N,%zu]", called, width);
	if (m->means.data && (a->shape[0] != m->means.shape[0] || a->shape[1] != m->means.shape[1]))
		return err_set(e, ERR_FORMAT,
			"%s: is of %zu times and %zu Gaussians, the means of %zu and %zu", called,
			a->shape[0], a->shape[1], m->means.shape[0], m->means.shape[1]);
	for (size_t i = 0; i < a->count; i++)
		if (!isfinite((float)npy_value(a, i)))
			return err_set(e, ERR_FORMAT,
				"%s: Gaussian %zu at index %zu of the times is not finite", called,
				i / width % a->shape[1], i / width / a->shape[1]);
	return 0;
}

static int open_archive(struct moving *m, const char *path, struct err *e)
{
	static const char *const names[] = {"means", "displacements"};
	const char *name = NULL;

	m->from = path;
	if (npz_open(&m->archive, path, e) || !(name = npz_main(&m->archive, names, e)) ||
		open_array(m, name, 3, &m->means, e))
		return -1;
	m->is_displaced = name == names[1];
	m->n = m->means.shape[0];
	const int has_quats = npz_has(&m->archive, "quats", "", e);
	return has_quats < 0 || (has_quats && open_array(m, "quats", 4, &m->quats, e)) ? -1 : 0;
}

int moving_open(struct moving *m, const char *splats, const char *motion, const char *times, struct err *e)
{
	const int has_archive = motion != NULL;
	int has_times = 0;

	m->from = splats;
	if (has_archive ? open_archive(m, motion, e) : frames_list(splats, &m->paths, &m->n, e))
		return -1;
	if (!m->n)
		return err_file(e, m->from, "has no times");
	if (!(m->times = mem_alloc(m->n, sizeof *m->times, "times", e)) ||
		(has_archive && !times && (has_times = npz_has(&m->archive, "times", "", e)) < 0))
		return -1;
	if (!has_times)
		return frames_times(m->times, m->n, times, m->from, e);
	SCOPED char *called = NULL;
	SCOPED_BY(npy_close) struct npy a = {0};
	if (npz_array(&m->archive, "times", "", &a, &called, e))
		return -1;
	if (a.count != m->n)
		return err_set(
			e, ERR_FORMAT, "%s: has %zu times, and there are %zu frames", called, a.count, m->n);
	for (size_t t = 0; t < m->n; t++)
		m->times[t] = npy_value(&a, t);
	return frames_check_times(m->times, m->n, called, e);
}

/* Frame t of the archive, into splats that have all but its means and rotations. */
static int read_archive(
	const struct moving *m, const struct splats *base, size_t t, struct splats *to, struct err *e)
{
	const size_t n = base->n;

	for (size_t i = 0; i < 3 * n; i++) {
		const double x = npy_value(&m->means, 3 * n * t + i);
		to->means[i] = (float)(m->is_displaced ? (double)m->canonical[i] + x : x - m->offset[i % 3]);
	}
	if (!m->quats.data)
		return 0;
	npy_floats(&m->quats, 4 * n * t, 4 * n, to->quats);
	for (size_t i = 0; i < n; i++) {
		const float *q = to->quats + 4 * i;
		if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
			return err_file(e, m->from,
				"quats.npy: Gaussian %zu at index %zu of the times is zero", i, t);
	}
	return 0;
}

int moving_first(
	struct moving *m, struct scene *s, const struct rows_report *rows, const char *splats, struct err *e)
{
	memcpy(m->offset, s->offset, sizeof m->offset);
	if (rows->not_finite + rows->zero_quat)
		return err_file(e, file_name(splats), FRAMES_NOT_FINITE, rows->dropped[0]);
	if (m->paths)
		return 0;
	if (m->means.shape[1] != s->splats.n)
		return err_file(e, m->from, "has %zu Gaussians, %s has %zu", m->means.shape[1],
			file_name(splats), s->splats.n);
	if (!(m->canonical = mem_alloc(s->splats.n, 3 * sizeof *m->canonical, "means", e)))
		return -1;
	memcpy(m->canonical, s->splats.means, 3 * s->splats.n * sizeof *m->canonical);
	return read_archive(m, &s->splats, 0, &s->splats, e);
}

/* What the workers have in common. */
struct reading {
	const struct moving *m;
	const struct splats *base; /* of SPLATS, or of the first frame */
	struct ply_like like;	   /* that, with its file */
	struct splats *frames;	   /* of each worker: its own */
	int *worker;		   /* of each item */
	struct motion_out *out;
};

static int copy_base(struct splats *to, const struct splats *base, struct err *e)
{
	SCOPED char *all = mem_alloc(base->n, 1, "splats", e);

	if (!all)
		return -1;
	memset(all, 1, base->n);
	return splats_keep(to, base, all, e);
}

static int read_frame(void *context, int worker, size_t item, struct err *e)
{
	const struct reading *r = context;
	struct splats *to = &r->frames[worker];

	r->worker[item] = worker;
	if (r->m->paths) {
		splats_free(to);
		return frames_read(to, &r->like, r->m->offset, r->m->paths[0], r->m->paths[item + 1], e);
	}
	return (!to->n && copy_base(to, r->base, e)) || read_archive(r->m, r->base, item + 1, to, e) ? -1 : 0;
}

static int put_frame(void *context, size_t item, struct err *e)
{
	const struct reading *r = context;

	return motion_out_put(r->out, item + 1, &r->frames[r->worker[item]], e);
}

static int read_frames(struct reading *r, struct err *e)
{
	const size_t n = r->m->n - 1;
	const struct each by = {r, each_workers(n), read_frame, put_frame};
	SCOPED struct splats *frames = mem_zalloc((size_t)by.workers, sizeof *frames, "frames", e);
	SCOPED int *worker = mem_alloc(n, sizeof *worker, "frames", e);

	r->frames = frames;
	r->worker = worker;
	const int bad = !frames || !worker || each_run(&by, n, e);
	for (int k = 0; k < by.workers && frames; k++)
		splats_free(&frames[k]);
	return bad ? -1 : 0;
}

int moving_write(
	const struct moving *m, const struct scene *s, const char *folder, size_t *moved, struct err *e)
{
	SCOPED char *path = file_join(folder, "motion.safetensors", "", e);
	struct motion_out out = {0};
	struct reading r = {.m = m, .base = &s->splats, .like.splats = &s->splats, .out = &out};
	const int bad = !path || (m->paths && file_map(m->paths[0], &r.like.map, e)) ||
			motion_out_begin(&out, path, &s->splats, m->n, e) || read_frames(&r, e) ||
			motion_out_end(&out, m->times, moved, e);

	motion_out_free(&out);
	file_unmap(&r.like.map);
	return bad ? -1 : 0;
}

void moving_free(struct moving *m)
{
	if (m->paths)
		mem_free_strings(m->paths, m->n);
	npy_close(&m->means);
	npy_close(&m->quats);
	npz_close(&m->archive);
	mem_free_all(m->times, m->canonical);
	*m = (struct moving){0};
}
