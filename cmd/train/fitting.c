#include "cmd/train/fitting.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/import/import.h"
#include "cmd/import/warping.h"
#include "fit/fit.h"
#include "fit/start.h"
#include "formats/splats/anysplats.h"
#include "formats/cameras/camerafile.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/colmap_points.h"
#include "formats/splats/ply.h"
#include "formats/records/trainlog.h"
#include "geom/lens.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { RANDOM_POINTS = 20000, NOTE_EVERY = 100 };

struct fitting {
	const struct fitting_options *options;
	const struct report *to;
	char *path; /* of the cameras */
	struct cameras cameras;
	double offset[3];
	struct photograph *photographs; /* (cameras.n) first those to learn from, then those to test with */
	size_t learned, tested;
	const struct camera **seen; /* (learned) */
	struct fit_gaussians gaussians;
	double extent;
	struct fit fit;
	struct trainlog log;
	char note[64];
};

static double seconds(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int read_cameras(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	const struct import_options files = {.splats = "-", .cameras = o->cameras, .images = o->images};
	size_t missing;

	f->path = import_find_cameras(&files, e);
	if (!f->path || camerafile_read(&f->cameras, f->path, e) ||
		import_split(&f->cameras, o->test_views, e))
		return -1;
	cameras_undistort(&f->cameras);
	if (camerafile_images(&f->cameras, o->images, ".", &missing, e))
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

/* A photograph may have another size than its camera, but not another shape. */
static int read_photograph(struct fitting *f, const struct camera *c, struct photograph *p, struct err *e)
{
	uint8_t *rgb = NULL;
	int height, width;

	if (warping_read_photograph(c, ".", 0, &rgb, &height, &width, e))
		return -1;
	int bad = fabs((double)c->width * height / width - c->height) > 1 + 0.005 * c->height
			  ? err_set(e, ERR_FORMAT, "%s: %dx%d, which is not the shape of its camera, %dx%d",
				    c->image, width, height, c->width, c->height)
			  : photograph_make(p, c, f->options->scale, rgb, height, width, e);
	free(rgb);
	return bad ? -1 : 0;
}

static int read_photographs(struct fitting *f, struct err *e)
{
	const size_t n = f->cameras.n;
	int bad = 0;

	f->photographs = mem_zalloc(n, sizeof *f->photographs, "photographs", e);
	f->seen = mem_alloc(n, sizeof *f->seen, "photographs", e);
	if (!f->photographs || !f->seen)
		return -1;
	report_start(f->to, "photographs", (double)n);
	for (int split = SPLIT_TRAIN; split <= SPLIT_TEST; split++)
		for (size_t i = 0; i < n && !bad; i++) {
			const struct camera *c = &f->cameras.views[i];
			if (!c->image || (int)c->split != split)
				continue;
			if (split == SPLIT_TRAIN)
				f->seen[f->learned] = c;
			bad = read_photograph(f, c, &f->photographs[f->learned + f->tested], e);
			*(split == SPLIT_TRAIN ? &f->learned : &f->tested) += 1;
			report_step(f->to, (double)(f->learned + f->tested), NULL);
		}
	report_end(f->to);
	if (!bad && !f->learned)
		bad = err_set(e, ERR_FORMAT, "%s: every view with a photograph is kept for testing",
			file_name(f->path));
	return bad;
}

/* Where there are none, points are drawn around the cameras. */
static int make_points(struct fitting *f, struct colmap_points *p, struct rng *rng, struct err *e)
{
	p->n = RANDOM_POINTS;
	p->places = mem_alloc(p->n, 3 * sizeof *p->places, "points", e);
	p->colors = mem_alloc(p->n, 3, "points", e);
	if (!p->places || !p->colors)
		return -1;
	start_points(f->seen, f->learned, p->places, p->colors, p->n, rng);
	report_warn(f->to, "%s: no points to begin with: %zu are taken at random", file_name(f->path), p->n);
	return 0;
}

/* Points are moved to the offset in double. */
static int start_from_points(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	struct colmap_points p = {0};
	float *places = NULL;
	struct rng rng;

	rng_seed(&rng, (uint64_t)o->seed, 1);
	int bad = (o->points || file_is_dir(f->path)) &&
		  colmap_points_read(&p, o->points ? o->points : f->path, e);
	bad = bad || (!p.n && make_points(f, &p, &rng, e)) || gaussian_offset(f->offset, p.places, p.n, e) ||
	      fit_gaussians_alloc(&f->gaussians, o->gaussians ? (size_t)o->gaussians : start_number(p.n),
		      (int)o->degree, e) ||
	      !(places = mem_alloc(p.n, 3 * sizeof *places, "points", e));
	if (!bad) {
		for (size_t i = 0; i < 3 * p.n; i++)
			places[i] = (float)(p.places[i] - f->offset[i % 3]);
		cameras_shift(&f->cameras, f->offset);
		f->extent = start_extent(f->seen, f->learned, places, p.n);
		bad = start_at_points(&f->gaussians, places, p.colors, p.n, &rng, e);
	}
	free(places);
	colmap_points_free(&p);
	return bad ? -1 : 0;
}

static int start_from_scene(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	struct splats s = {0};
	int bad = anysplats_read(&s, f->offset, NULL, o->init, e);

	bad = bad || fit_gaussians_alloc(&f->gaussians,
			     s.n > (size_t)o->gaussians ? s.n : (size_t)o->gaussians, (int)o->degree, e);
	if (!bad) {
		cameras_shift(&f->cameras, f->offset);
		f->extent = start_extent(f->seen, f->learned, s.means, s.n);
		fit_gaussians_take(&f->gaussians, &s);
	}
	splats_free(&s);
	return bad ? -1 : 0;
}

/* The cameras were moved after the photographs were read. */
static void move_photographs(struct fitting *f)
{
	for (size_t i = 0; i < f->learned + f->tested; i++)
		for (int k = 0; k < FIT_LEVELS; k++) {
			struct cameras one = {1, &f->photographs[i].camera[k]};
			cameras_shift(&one, f->offset);
		}
}

/* Mean loss and PSNR of the test views. */
static int judge(struct fitting *f, double *psnr, double *ssim, struct err *e)
{
	*psnr = *ssim = 0;
	for (size_t i = 0; i < f->tested; i++) {
		struct photo_loss l;
		if (fit_judge(&f->fit, &f->photographs[f->learned + i], &l, e))
			return -1;
		*psnr += fit_psnr(l.squares) / (double)f->tested;
		*ssim += l.ssim / (double)f->tested;
		report_note(f->to, 2, "%s: PSNR %.2f dB, SSIM %.4f",
			f->photographs[f->learned + i].camera[0].name, fit_psnr(l.squares), l.ssim);
	}
	return 0;
}

static int take_steps(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	const double begin = seconds(), all = o->minutes > 0 ? 60 * o->minutes : (double)o->iterations;
	double done = 0, loss = 0, squares = 0;
	int bad = 0;

	report_start(f->to, o->minutes > 0 ? "seconds" : "steps", all);
	while (done < all && !bad) {
		struct fit *fit = &f->fit;
		bad = fit_step(fit, done / all, e);
		loss += fit->last.total / NOTE_EVERY;
		squares += fit->last.squares / NOTE_EVERY;
		if (!bad && fit->iteration % NOTE_EVERY == 0) {
			snprintf(f->note, sizeof f->note, "%zu Gaussians, PSNR %.2f", fit->gaussians.n,
				fit_psnr(squares));
			bad = trainlog_put_fit(
				&f->log, fit->iteration, fit->gaussians.n, loss, fit_psnr(squares), e);
			loss = squares = 0;
		}
		done = o->minutes > 0 ? seconds() - begin : (double)fit->iteration;
		report_step(f->to, done, *f->note ? f->note : NULL);
	}
	report_end(f->to);
	return bad;
}

/* Training on photographs that show nothing would end in nothing. */
static int check_start(struct fitting *f, struct err *e)
{
	const size_t n = f->fit.gaussians.n;
	char *kept = mem_alloc(n, 1, "Gaussians", e);
	int bad = !kept || fit_shown(&f->fit, FIT_LEVELS - 1, kept, e);

	if (!bad && !memchr(kept, 1, n))
		bad = err_set(e, ERR_FORMAT,
			"%s: no photograph shows any of the %zu %s to begin with: they must be in the cameras' frame, before a camera, and farther from it than 0.2",
			file_name(f->options->init     ? f->options->init
				  : f->options->points ? f->options->points
						       : f->path),
			n, f->options->init ? "Gaussians" : "points");
	free(kept);
	return bad ? -1 : 0;
}

static int finish(struct fitting *f, struct err *e)
{
	const size_t n = f->fit.gaussians.n;
	char *kept = mem_alloc(n, 1, "Gaussians", e);
	struct splats s = {0};
	double psnr, ssim;
	int bad = !kept || fit_check(&f->fit, e) || judge(f, &psnr, &ssim, e) ||
		  fit_shown(&f->fit, 0, kept, e) || fit_gaussians_give(&f->fit.gaussians, kept, &s, e) ||
		  ply_write(&s, f->offset, f->options->output, e);

	if (!bad)
		report_note(f->to, 1, "%ld steps, %zu Gaussians, of which %zu are shown and written",
			f->fit.iteration, n, s.n);
	if (!bad && f->tested)
		report_note(f->to, 1, "%zu test views: PSNR %.2f dB, SSIM %.4f", f->tested, psnr, ssim);
	splats_free(&s);
	free(kept);
	return bad ? -1 : 0;
}

static int run(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	struct file_out claim;

	if (read_cameras(f, e) || read_photographs(f, e) ||
		(o->init ? start_from_scene(f, e) : start_from_points(f, e)))
		return -1;
	move_photographs(f);
	const struct fit_options options = {f->extent, (uint64_t)o->seed};
	report_note(f->to, 1,
		"%zu photographs to learn from, %zu to test with, %zu Gaussians to begin with, extent %.4g",
		f->learned, f->tested, f->gaussians.n, f->extent);
	int bad = file_out_claim(&claim, o->output, e);
	bad = bad || trainlog_open(&f->log, o->log, 0, e) ||
	      fit_open(&f->fit, &f->gaussians, &options, f->photographs, f->learned, e) ||
	      check_start(f, e) || take_steps(f, e) || finish(f, e);
	file_out_abort(&claim);
	return bad ? -1 : 0;
}

int fit_scene(const struct fitting_options *o, const struct report *to, struct err *e)
{
	struct fitting f = {.options = o, .to = to};
	struct err late;
	int bad = run(&f, e);

	if (trainlog_close(&f.log, &late) && !bad) {
		*e = late;
		bad = -1;
	}
	fit_close(&f.fit);
	fit_gaussians_free(&f.gaussians);
	for (size_t i = 0; f.photographs && i < f.cameras.n; i++)
		photograph_free(&f.photographs[i]);
	free(f.photographs);
	free(f.seen);
	cameras_free(&f.cameras);
	free(f.path);
	return bad;
}
