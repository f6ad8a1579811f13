#include "cmd/train/fitting.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/train/fitting_input.h"
#include "fit/grow.h"
#include "formats/arrays/safetensors.h"
#include "formats/images/png.h"
#include "formats/records/trainlog.h"
#include "formats/splats/ply.h"

#include <math.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

/* The state of an unfinished gs-train, from which it goes on to the same bytes: formats/scene/checkpoint.md.
 */
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

/* Writes it whole. identity: the options, and the checksum of the inputs. */
static int checkpoint_write(struct fit *f, const char *path, const char *identity, struct err *e)
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

/* Fills a fit that has been opened on the same input. ERR_FORMAT where the file is of another training. */
static int checkpoint_read(struct fit *f, const char *path, const char *identity, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	return read_state(f, &st, identity, e);
}

/* Photographs whose gains are this far apart were not exposed alike: those of one exposure have up to 0.1. */
#define EXPOSURE_LEAST 0.15

/* No loss of an image between black and white beside a photograph is above 1.2. */
#define LOSS_MOST 10

struct fitting {
	const struct fitting_options *options;
	const struct report *to;
	struct fitting_input in;
	struct fit fit;
	struct trainlog log;
	float *good; /* the parameters at the last evaluation */
	size_t good_n;
	long good_step;
	double begin; /* when the training would have begun, had it not been cut off */
	int is_own;   /* the checkpoint is of this training */
	char identity[256], note[64];
};

static double seconds(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Notes what to go back to where the training diverges. */
static void keep(struct fitting *f)
{
	const struct fit_gaussians *g = &f->fit.gaussians;

	memcpy(f->good, g->slab, (size_t)(g->at[FIT_GRADIENT][0] - g->slab) * sizeof *f->good);
	f->good_n = g->n;
	f->good_step = (long)f->fit.state.iteration;
}

static int draw_preview(struct fitting *f, struct err *e)
{
	const struct photograph *p = f->in.photographs + (f->in.tested ? f->in.learned : 0);
	const struct camera *c = &p->camera[0];
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	struct photo_loss l;
	char name[32];

	if (!f->options->preview)
		return 0;
	if (fit_judge(&f->fit, p, &l, e))
		return -1;
	snprintf(name, sizeof name, "%08ld", (long)f->fit.state.iteration);
	SCOPED uint8_t *rgb = mem_alloc(pixels, 3, "picture", e);
	SCOPED char *path = file_join(f->options->preview, name, ".png", e);
	for (size_t i = 0; rgb && i < 3 * pixels; i++)
		rgb[i] = (uint8_t)(255 * fminf(fmaxf(f->fit.image[i % 3 * pixels + i / 3], 0), 1) + 0.5f);
	return !rgb || !path || png_write(path, rgb, c->height, c->width, 3, e) ? -1 : 0;
}

/* What is due after a step, at the progress that it was taken at, besides what records it. */
static int look(struct fitting *f, double progress, struct err *e)
{
	struct fit *fit = &f->fit;
	const size_t most = (size_t)fit->state.most, n = fit->gaussians.n;
	double psnr, ssim;
	int is_due;

	if (!(fit->last.total < LOSS_MOST))
		return err_set(e, ERR_CHECK, "training diverged: the loss of step %ld is %.3g",
			(long)fit->state.iteration, fit->last.total);
	if (!fit->state.is_pruned && progress >= FIT_PRUNED) {
		if (fit_check(fit, e) || fit_prune(fit, e))
			return -1;
		report_note(f->to, 1, "step %ld: %zu of %zu Gaussians add nothing and are left out",
			(long)fit->state.iteration, n - fit->gaussians.n, n);
	}
	if (fit_evaluate(fit, progress, &is_due, &psnr, &ssim, e))
		return -1;
	if (!is_due)
		return 0;
	if (fit_check(fit, e))
		return -1;
	keep(f);
	report_note(f->to, 2, "step %ld: %zu Gaussians, %s PSNR %.2f dB, SSIM %.4f",
		(long)fit->state.iteration, fit->gaussians.n, f->in.held_out ? "held-out" : "training", psnr,
		ssim);
	if ((size_t)fit->state.most < most && !fit->state.is_pruned)
		report_note(f->to, 1, "step %ld: more than %zu Gaussians gain nothing",
			(long)fit->state.iteration, fit->gaussians.n);
	return -(trainlog_put_judged(&f->log, (long)fit->state.iteration, fit->gaussians.n, psnr, ssim, e) ||
		 draw_preview(f, e));
}

/* What is due after a step: a line of the log, a checkpoint. */
static int record(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	struct fit_state *s = &f->fit.state;
	const long done = (long)s->iteration;

	if (done % TRAINLOG_EVERY == 0) {
		const double psnr = fit_psnr(s->squares / TRAINLOG_EVERY);
		snprintf(f->note, sizeof f->note, "%zu Gaussians, PSNR %.2f", f->fit.gaussians.n, psnr);
		if (trainlog_put_fit(&f->log, done, f->fit.gaussians.n, s->loss / TRAINLOG_EVERY, psnr, e))
			return -1;
		s->loss = s->squares = 0;
	}
	if (!o->checkpoint || done % o->checkpoint || fit_check(&f->fit, e))
		return o->checkpoint && done % o->checkpoint == 0 ? -1 : 0;
	s->spent = seconds() - f->begin;
	const int bad = checkpoint_write(&f->fit, o->checkpoint_path, f->identity, e);
	f->is_own |= !bad;
	return bad;
}

static int take_steps(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	const int is_timed = o->minutes > 0;
	const double all = is_timed ? 60 * o->minutes : (double)o->iterations;
	const struct fit_state *s = &f->fit.state;
	double done = is_timed ? s->spent : (double)s->iteration;
	int bad = 0;

	f->begin = seconds() - s->spent;
	report_start(f->to, is_timed ? "seconds" : "steps", all);
	while (done < all && !bad) {
		bad = fit_step(&f->fit, done / all, e) || look(f, done / all, e) || record(f, e);
		done = is_timed ? seconds() - f->begin : (double)s->iteration;
		report_step(f->to, done, *f->note ? f->note : NULL);
	}
	report_end(f->to);
	return bad ? -1 : fit_check(&f->fit, e);
}

/* Training on photographs that show nothing would end in nothing. */
static int check_start(struct fitting *f, struct err *e)
{
	const size_t n = f->fit.gaussians.n;
	SCOPED char *kept = mem_alloc(n, 1, "Gaussians", e);
	int bad = !kept || fit_shown(&f->fit, FIT_LEVELS - 1, kept, NULL, e);

	if (!bad && !memchr(kept, 1, n))
		bad = err_set(e, ERR_FORMAT,
			"%s: no photograph shows any of the %zu %s to begin with: they must be in the cameras' frame, before a camera, and farther from it than its near plane, which is at %.3g here",
			fitting_input_start(&f->in), n, f->options->init ? "Gaussians" : "points",
			f->fit.gaussians.splats.near);
	return bad ? -1 : 0;
}

static int finish(struct fitting *f, struct err *e)
{
	const size_t n = f->fit.gaussians.n;
	const struct photograph *tested = f->in.photographs + f->in.learned;
	SCOPED char *kept = mem_alloc(n, 1, "Gaussians", e);
	SCOPED_BY(splats_free) struct splats s = {0};
	double psnr, ssim;
	int bad = !kept || fit_judge_all(&f->fit, tested, f->in.tested, &psnr, &ssim, e) ||
		  fit_shown(&f->fit, 0, kept, NULL, e) || fit_gaussians_give(&f->fit.gaussians, kept, &s, e);

	if (!bad && f->fit.state.iteration)
		photographs_widen(&s, f->in.photographs, f->in.learned);
	bad = bad || ply_write(&s, f->in.offset, f->options->output, e);
	if (!bad)
		report_note(f->to, 1, "%ld steps, %zu Gaussians, of which %zu are shown and written",
			(long)f->fit.state.iteration, n, s.n);
	for (size_t i = 0; i < f->in.tested && !bad; i++) {
		struct photo_loss l;
		bad = fit_judge(&f->fit, &tested[i], &l, e);
		report_note(f->to, 2, "%s: PSNR %.2f dB, SSIM %.4f", tested[i].camera[0].name,
			fit_psnr(l.squares), l.ssim);
	}
	if (!bad && f->in.tested)
		report_note(f->to, 1, "%zu test views: PSNR %.2f dB, SSIM %.4f", f->in.tested, psnr, ssim);
	return bad ? -1 : 0;
}

/* Writes what was good at the last evaluation. Always -1. */
static int fall_back(struct fitting *f, struct err *e)
{
	struct fit_gaussians *g = &f->fit.gaussians;
	char why[128];

	snprintf(why, sizeof why, "%.127s", e->message);
	memcpy(g->slab, f->good, (size_t)(g->at[FIT_GRADIENT][0] - g->slab) * sizeof *f->good);
	g->n = f->good_n;
	f->fit.state.iteration = f->good_step;
	fit_gaussians_activate(g);
	return finish(f, e)
		       ? -1
		       : err_set(e, ERR_FORMAT,
				 "%s: %s; the file has the scene of step %ld; try a lower --degree, fewer --gaussians, or points in place of --init",
				 file_name(f->options->output), why, f->good_step);
}

int fitting_resumes(const char *checkpoint, int is_wanted, int is_replaced, const struct report *to)
{
	if (!checkpoint || !file_exists(checkpoint))
		return 0;
	if (!is_wanted && is_replaced)
		report_warn(to,
			"%s: is of an earlier training and will be replaced; --resume would go on from it",
			checkpoint);
	return is_wanted;
}

/* Goes on from a checkpoint where that is wanted. */
static int resume(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;

	snprintf(f->identity, sizeof f->identity,
		"--iterations %lld --minutes %g --gaussians %zu --degree %lld --seed %lld --exposure %s, inputs %08x",
		o->iterations, o->minutes, f->fit.gaussians.capacity, o->degree, o->seed, o->exposure,
		(unsigned)f->in.checksum);
	if (!fitting_resumes(o->checkpoint_path, o->is_resumed, o->checkpoint > 0, f->to))
		return 0;
	if (checkpoint_read(&f->fit, o->checkpoint_path, f->identity, e))
		return -1;
	f->is_own = 1;
	report_note(f->to, 1, "going on after step %ld", (long)f->fit.state.iteration);
	return 0;
}

static int expose(struct fitting *f, struct err *e)
{
	const char *when = f->options->exposure;
	double spread;

	if (!strcmp(when, "never") || f->in.learned < 2)
		return 0;
	if (fit_expose(&f->fit, strcmp(when, "auto") ? 0 : EXPOSURE_LEAST, &spread, e))
		return -1;
	report_note(f->to, 1, "exposures are %.0f%% apart%s", 100 * spread,
		f->fit.exposures.n ? ", and learned" : "");
	return 0;
}

static int run(struct fitting *f, struct err *e)
{
	const struct fitting_options *o = f->options;
	struct fitting_input *in = &f->in;
	SCOPED_BY(file_out_abort) struct file_out claim = {0};

	if (fitting_input_read(in, e))
		return -1;
	const struct fit_options options = {in->extent, in->size, (uint64_t)o->seed};
	report_note(f->to, 1,
		"%zu photographs to learn from, %zu to test with, %zu Gaussians to begin with, extent %.4g, size %.4g",
		in->learned, in->tested, in->gaussians.n, in->extent, in->size);
	int bad = file_out_claim(&claim, o->output, e);
	bad = bad || (o->checkpoint_path && file_out_probe(o->checkpoint_path, e)) ||
	      (o->preview && file_make_dir(o->preview, e)) ||
	      fit_open(&f->fit, &in->gaussians, &options, in->photographs, in->learned, in->held_out, e) ||
	      check_start(f, e) || expose(f, e) || resume(f, e) ||
	      trainlog_open(&f->log, o->log, (long)f->fit.state.iteration, e);
	const struct fit_gaussians *g = &f->fit.gaussians;
	bad = bad || !(f->good = mem_alloc(
			       (size_t)(g->at[FIT_GRADIENT][0] - g->slab), sizeof *f->good, "Gaussians", e));
	if (!bad) {
		keep(f);
		bad = take_steps(f, e);
		bad = bad && e->code == ERR_CHECK ? fall_back(f, e) : bad || finish(f, e);
	}
	if (!bad && f->is_own)
		unlink(o->checkpoint_path);
	return bad ? -1 : 0;
}

int fit_scene(const struct fitting_options *o, const struct report *to, struct err *e)
{
	struct fitting f = {.options = o, .to = to, .in = {.options = o, .to = to}};
	struct err late;
	int bad = run(&f, e);

	if (trainlog_close(&f.log, &late) && !bad) {
		*e = late;
		bad = -1;
	}
	fit_close(&f.fit);
	free(f.good);
	fitting_input_free(&f.in);
	return bad;
}
