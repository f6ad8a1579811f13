#include "cmd/train/fitting_input.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/import/import.h"
#include "cmd/import/photographs.h"
#include "cmd/import/warping.h"
#include "fit/start.h"
#include "formats/cameras/camerafile.h"
#include "formats/cameras/colmap.h"
#include "formats/images/png.h"
#include "formats/splats/anysplats.h"
#include "geom/lens.h"
#include "splat/near.h"

#include <math.h>
#include <zlib.h>

/* Each eighth photograph, but not many more than 16, is held out where there are so many that its neighbours
 * show what it does. */
enum { RANDOM_POINTS = 20000, HELD_OUT_FROM = 40, HELD_OUT_EVERY = 8, HELD_OUT_MOST = 16 };
enum part { LEARNED, HELD_OUT, TESTED, PARTS };

static int read_cameras(struct fitting_input *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	const struct import_options files = {.splats = "-", .cameras = o->cameras, .images = o->images};
	size_t missing;

	f->path = import_find_cameras(&files, e);
	if (!f->path || camerafile_read(&f->cameras, f->path, e) ||
		import_compare_models(f->path, f->cameras.n, f->to, e) ||
		import_split(&f->cameras, o->test_views, e))
		return -1;
	cameras_undistort(&f->cameras);
	if (photographs_find(&f->cameras, o->images, ".", &missing, e))
		return -1;
	if (missing == f->cameras.n)
		return err_set(e, ERR_FORMAT,
			"%s: no photograph for any of the %zu views of %s, such as '%s'", o->images, missing,
			file_name(f->path), f->cameras.views[0].name);
	if (missing)
		report_warn(
			f->to, "%s: no photograph for %zu of %zu views", o->images, missing, f->cameras.n);
	return 0;
}

/* A picture may have another size than its camera, but not another shape. */
static int check_shape(const struct camera *c, const char *path, int height, int width, struct err *e)
{
	if (fabs((double)c->width * height / width - c->height) <= 1 + 0.005 * c->height)
		return 0;
	return err_set(e, ERR_FORMAT, "%s: %dx%d, which is not the shape of its camera, %dx%d", path, width,
		height, c->width, c->height);
}

static int read_photograph(
	struct fitting_input *f, const struct camera *c, struct photograph *p, struct err *e)
{
	SCOPED uint8_t *rgb = NULL;
	int height, width;

	return -(warping_read_photograph(c, ".", 0, &rgb, &height, &width, e) ||
		 check_shape(c, c->image, height, width, e) ||
		 photograph_make(p, c, f->options->scale, rgb, height, width, e));
}

/* The pixels of a view that do not count, where there is a mask of it. */
static int read_ignored(
	const struct fitting_input *f, const struct camera *c, struct photograph *p, struct err *e)
{
	SCOPED uint8_t *mask = NULL;
	int height, width;

	if (!f->options->ignore)
		return 0;
	SCOPED char *path = file_join(f->options->ignore, c->name, ".png", e);
	if (!path || !file_exists(path))
		return path ? 0 : -1;
	return -(png_read_mask(path, &mask, &height, &width, e) || check_shape(c, path, height, width, e) ||
		 photograph_ignore(p, mask, height, width, e));
}

/* part (cameras.n): what each photograph is for; PARTS: there is none. */
static void assign(const struct fitting_input *f, uint8_t *part)
{
	size_t all = 0, at = 0;

	for (size_t i = 0; i < f->cameras.n; i++) {
		const struct camera *c = &f->cameras.views[i];
		part[i] = !c->image ? PARTS : c->split == SPLIT_TEST ? TESTED : LEARNED;
		all += part[i] == LEARNED;
	}
	const size_t every = all > HELD_OUT_EVERY * HELD_OUT_MOST ? all / HELD_OUT_MOST : HELD_OUT_EVERY;
	for (size_t i = 0; i < f->cameras.n && all >= HELD_OUT_FROM; i++)
		if (part[i] == LEARNED && ++at % every == 0)
			part[i] = HELD_OUT;
}

static int read_photographs(struct fitting_input *f, struct err *e)
{
	const size_t n = f->cameras.n;
	uint8_t *part = mem_alloc(n, 1, "photographs", e);
	size_t number[PARTS] = {0}, done = 0;
	int bad = 0;

	f->photographs = mem_zalloc(n, sizeof *f->photographs, "photographs", e);
	f->seen = mem_alloc(n, sizeof *f->seen, "photographs", e);
	if (part && f->photographs && f->seen)
		assign(f, part);
	else
		bad = -1;
	report_start(f->to, "photographs", (double)n);
	for (int k = 0; k < PARTS; k++)
		for (size_t i = 0; i < n && !bad; i++) {
			const struct camera *c = &f->cameras.views[i];
			if (part[i] != k)
				continue;
			f->seen[done] = c;
			bad = read_photograph(f, c, &f->photographs[done], e) ||
			      read_ignored(f, c, &f->photographs[done], e);
			number[k]++;
			report_step(f->to, (double)++done, NULL);
		}
	report_end(f->to);
	free(part);
	f->held_out = number[HELD_OUT];
	f->learned = number[LEARNED] + f->held_out;
	f->tested = number[TESTED];
	if (!bad && !f->learned)
		bad = err_set(e, ERR_FORMAT, "%s: every view with a photograph is kept for testing",
			file_name(f->path));
	return bad;
}

/* Where there are none, points are drawn around the cameras. */
static int make_points(struct fitting_input *f, struct colmap_points *p, struct err *e)
{
	struct rng rng;

	rng_seed(&rng, (uint64_t)f->options->seed, 1);
	p->n = RANDOM_POINTS;
	p->places = mem_alloc(p->n, 3 * sizeof *p->places, "points", e);
	p->colors = mem_alloc(p->n, 3, "points", e);
	if (!p->places || !p->colors)
		return -1;
	start_points(f->seen, f->learned, p->places, p->colors, p->n, &rng);
	report_warn(f->to, "%s: no points to begin with: %zu are taken at random", file_name(f->path), p->n);
	return 0;
}

/* Points are moved to the offset in double. */
static int start_from_points(struct fitting_input *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	SCOPED_BY(colmap_points_free) struct colmap_points p = {0};
	SCOPED float *places = NULL;
	int bad = (o->points || file_is_dir(f->path)) &&
		  colmap_points_read(&p, o->points ? o->points : f->path, e);
	bad = bad || (!p.n && make_points(f, &p, e)) || gaussian_offset(f->offset, p.places, p.n, e) ||
	      fit_gaussians_alloc(&f->gaussians, o->gaussians ? (size_t)o->gaussians : start_number(p.n),
		      (int)o->degree, e) ||
	      !(places = mem_alloc(p.n, 3 * sizeof *places, "points", e));
	if (!bad) {
		for (size_t i = 0; i < 3 * p.n; i++)
			places[i] = (float)(p.places[i] - f->offset[i % 3]);
		cameras_shift(&f->cameras, f->offset);
		f->extent = start_extent(f->seen, f->learned, places, p.n);
		f->size = start_size(f->seen, f->learned, places, p.n);
		bad = start_at_points(&f->gaussians, places, p.colors, p.n, e);
	}
	return bad ? -1 : 0;
}

static int start_from_scene(struct fitting_input *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	SCOPED_BY(splats_free) struct splats s = {0};
	int bad = anysplats_read(&s, f->offset, NULL, o->init, e);

	bad = bad || fit_gaussians_alloc(&f->gaussians,
			     s.n > (size_t)o->gaussians ? s.n : (size_t)o->gaussians, (int)o->degree, e);
	if (!bad) {
		cameras_shift(&f->cameras, f->offset);
		f->extent = start_extent(f->seen, f->learned, s.means, s.n);
		f->size = start_size(f->seen, f->learned, s.means, s.n);
		fit_gaussians_take(&f->gaussians, &s);
	}
	return bad ? -1 : 0;
}

/* The cameras were moved after the photographs were read. */
static void move_photographs(struct fitting_input *f)
{
	for (size_t i = 0; i < f->learned + f->tested; i++)
		for (int k = 0; k < FIT_LEVELS; k++) {
			struct cameras one = {1, &f->photographs[i].camera[k]};
			cameras_shift(&one, f->offset);
		}
}

static void add(uint32_t *sum, const void *data, size_t bytes)
{
	*sum = (uint32_t)crc32_z(*sum, data, bytes);
}

static void make_checksum(struct fitting_input *f)
{
	f->checksum = 0;
	for (size_t i = 0; i < f->learned + f->tested; i++) {
		const struct photograph *p = &f->photographs[i];
		const struct camera *c = &p->camera[0];
		const size_t pixels = (size_t)c->width * (size_t)c->height;
		add(&f->checksum, &c->fx, 4 * sizeof c->fx);
		add(&f->checksum, c->world_to_camera, sizeof c->world_to_camera);
		add(&f->checksum, p->rgb[0], 3 * pixels);
		if (p->ignored[0])
			add(&f->checksum, p->ignored[0], pixels);
	}
	for (int p = 0; p < fit_parts(f->gaussians.degree); p++)
		add(&f->checksum, f->gaussians.at[FIT_VALUE][p],
			f->gaussians.n * fit_width[p] * sizeof(float));
}

int fitting_input_read(struct fitting_input *f, struct err *e)
{
	if (read_cameras(f, e) || read_photographs(f, e) ||
		(f->options->init ? start_from_scene(f, e) : start_from_points(f, e)))
		return -1;
	move_photographs(f);
	make_checksum(f);
	fit_gaussians_activate(&f->gaussians);
	return near_find(&f->gaussians.splats, &f->cameras, e);
}

const char *fitting_input_start(const struct fitting_input *f)
{
	const struct fitting_options *o = f->options;

	return file_name(o->init ? o->init : o->points ? o->points : f->path);
}

void fitting_input_free(struct fitting_input *f)
{
	fit_gaussians_free(&f->gaussians);
	for (size_t i = 0; f->photographs && i < f->cameras.n; i++)
		photograph_free(&f->photographs[i]);
	cameras_free(&f->cameras);
	mem_free_all(f->photographs, f->seen, f->path);
}
