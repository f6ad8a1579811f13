#include "fit/fit.h"

#include "base/mem.h"
#include "fit/grow.h"
#include "fit/project_back.h"
#include "nn/adam.h"

#include <math.h>

/* 3DGS's rates, those of positions per extent and falling from the first to the second. */
#define RATE_MEAN 1.6e-4
#define RATE_MEAN_END 1.6e-6
#define RATE_EXPOSURE 0.01
#define RATE_EXPOSURE_END 0.001
static const double rates[FIT_PARTS] = {0, 0.005, 0.001, 0.05, 0.0025, 0.0025 / 20, 0.0025 / 20, 0.0025 / 20};

/* Small weights on opacities and scales, each a mean over all. 3DGS-MCMC has 0.01 for both; in short
 * trainings less on opacities is better: 32.4 in place of 31.9 dB on a desk after 1,000 steps. */
#define WEIGHT_OPACITY 0.003f
#define WEIGHT_SCALE 0.01f

/* Progress at which the images become half and full size, and each degree of the harmonics begins. */
static const double level_ends[FIT_LEVELS - 1] = {0.35, 0.1}, degree_begins[3] = {0.1, 0.2, 0.3};

/* Gaussians are moved and added from the first of these on, so often, until the last; by GROWN there are all.
 */
#define GROW_BEGIN 0.02
#define GROW_STEP 0.005
#define GROWN 0.5
#define GROW_END 0.85

int fit_open(struct fit *f, struct fit_gaussians *g, const struct fit_options *o,
	const struct photograph *photographs, size_t views, size_t held_out, struct err *e)
{
	*f = (struct fit){.options = *o,
		.gaussians = *g,
		.photographs = photographs,
		.views = views,
		.held_out = held_out,
		.state = {.first = (int64_t)g->n, .most = (int64_t)g->capacity}};
	*g = (struct fit_gaussians){0};
	f->order = mem_alloc(views, sizeof *f->order, "views", e);
	f->seen = mem_alloc(f->gaussians.capacity, 1, "views", e);
	f->dead = mem_alloc(f->gaussians.capacity, 1, "Gaussians", e);
	f->colors = mem_alloc(f->gaussians.capacity, 3 * sizeof *f->colors, "colours", e);
	f->sums = mem_zalloc(f->gaussians.capacity, BACK_SUMS * sizeof *f->sums, "gradients", e);
	f->weight = mem_zalloc(f->gaussians.capacity, sizeof *f->weight, "gradients", e);
	if (!f->order || !f->seen || !f->colors || !f->sums || !f->weight || !f->dead)
		return -1;
	rng_seed(&f->state.rng, o->seed, 0);
	for (size_t i = 0; i < views; i++)
		f->order[i] = (uint32_t)i;
	fit_gaussians_activate(&f->gaussians);
	f->view = render_prepare(&f->gaussians.splats, &photographs[0].camera[FIT_LEVELS - 1], e);
	return f->view ? 0 : -1;
}

void fit_close(struct fit *f)
{
	fit_gaussians_free(&f->gaussians);
	render_free(f->view);
	back_free(&f->back);
	photo_loss_free(&f->room);
	exposures_free(&f->exposures);
	mem_free_all(f->order, f->seen, f->colors, f->sums, f->weight, f->dead, f->image);
	*f = (struct fit){0};
}

/* How many are learned from. */
static size_t learned(const struct fit *f)
{
	return f->views - (f->state.is_pruned ? 0 : f->held_out);
}

double fit_psnr(double squares)
{
	return -10 * log10(fmax(squares, 1e-12));
}

/* Renders the photograph's view into f->image. */
static int render(struct fit *f, const struct camera *c, int degree, struct err *e)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height;

	if (mem_room((void **)&f->image, &f->image_room, 9 * pixels, sizeof *f->image, "image", e) ||
		render_again(f->view, &f->gaussians.splats, c, e))
		return -1;
	fit_seen(f->view, f->seen);
	fit_colors(&f->gaussians, f->seen, c, degree, f->colors);
	render_packed(f->view, f->colors, 3, f->image, NULL);
	return 0;
}

/* What the photograph shows of f->image, where that is not the same: as it was exposed, and what is ignored
 * as it is in the photograph. */
static const float *show(struct fit *f, const struct photograph *p, int level, const float *exposure)
{
	const size_t pixels = (size_t)p->camera[level].width * (size_t)p->camera[level].height;
	float *shown = f->image + 6 * pixels;

	if (!exposure && !p->ignored[level])
		return f->image;
	if (exposure)
		exposure_apply(exposure, f->image, shown, pixels);
	else
		memcpy(shown, f->image, 3 * pixels * sizeof *shown);
	for (size_t i = 0; p->ignored[level] && i < pixels; i++)
		for (size_t k = 0; p->ignored[level][i] && k < 3; k++)
			shown[k * pixels + i] = (float)p->rgb[level][3 * i + k] * (1.0f / 255);
	return shown;
}

/* The loss, as a mean over the pixels that count. */
static int lose(struct fit *f, const struct photograph *p, int level, const float *shown, float *gradient,
	struct photo_loss *l, struct err *e)
{
	const struct camera *c = &p->camera[level];
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	const uint8_t *ignored = p->ignored[level];
	size_t counted = ignored ? 0 : pixels;

	if (photo_loss(l, shown, p->rgb[level], c->height, c->width, gradient, &f->room, e))
		return -1;
	for (size_t i = 0; ignored && i < pixels; i++) {
		counted += !ignored[i];
		for (size_t k = 0; gradient && ignored[i] && k < 3; k++)
			gradient[k * pixels + i] = 0;
	}
	const double share = counted ? (double)pixels / (double)counted : 0;
	l->l1 *= share;
	l->squares *= share;
	l->ssim = counted ? 1 - (1 - l->ssim) * share : 1;
	l->total *= share;
	return 0;
}

int fit_judge(struct fit *f, const struct photograph *p, struct photo_loss *l, struct err *e)
{
	const size_t pixels = (size_t)p->camera[0].width * (size_t)p->camera[0].height;
	const int is_own = p >= f->photographs && p < f->photographs + f->views;
	float nearest[EXPOSURE_WIDTH],
		*exposure = f->exposures.n && is_own
				    ? f->exposures.values + (size_t)(p - f->photographs) * EXPOSURE_WIDTH
				    : nearest;

	fit_gaussians_activate(&f->gaussians);
	if (render(f, &p->camera[0], f->gaussians.degree, e))
		return -1;
	/* with what is nearest a view that is held out begins when it is learned from */
	if (f->exposures.n && !(is_own && p < f->photographs + learned(f)))
		exposure_nearest(exposure, f->image, p->rgb[0], pixels);
	exposure = f->exposures.n ? exposure : NULL;
	return lose(f, p, 0, show(f, p, 0, exposure), NULL, l, e);
}

int fit_expose(struct fit *f, double least, double *spread, struct err *e)
{
	if (exposures_alloc(&f->exposures, f->views, e))
		return -1;
	*spread = exposures_guess(&f->exposures, &f->gaussians, f->photographs);
	if (*spread < least)
		exposures_free(&f->exposures);
	return 0;
}

/* The image's gradient, and from it the slab's; weights are noted. */
static int back(
	struct fit *f, const struct photograph *p, int level, int degree, double progress, struct err *e)
{
	const size_t which = (size_t)(p - f->photographs);
	const struct camera *c = &p->camera[level];
	struct fit_gaussians *g = &f->gaussians;
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	float *gradient = f->image + 3 * pixels;

	const float *exposure = f->exposures.n ? f->exposures.values + which * EXPOSURE_WIDTH : NULL;
	if (lose(f, p, level, show(f, p, level, exposure), gradient, &f->last, e))
		return -1;
	if (exposure)
		exposures_step(&f->exposures, which, f->image, gradient, pixels,
			RATE_EXPOSURE * pow(RATE_EXPOSURE_END / RATE_EXPOSURE, progress),
			f->state.iteration / (long)f->views + 1);
	if (back_view(f->view, f->colors, f->image, gradient, f->sums, &f->back, e))
		return -1;
	fit_project_back(g, f->view, f->seen, c, degree, f->colors, f->sums);
	const float weight = WEIGHT_SCALE * (float)(FIT_SIZE / f->options.size);
	const float area = (float)(1 << 2 * level); /* pixels of full size */
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < g->n; i++) {
		const float o = g->splats.opacities[i];
		f->weight[i] += area * f->sums[i * BACK_SUMS + BACK_WEIGHT];
		g->at[FIT_GRADIENT][FIT_LOGIT][i] += WEIGHT_OPACITY * o * (1 - o) / (float)g->n;
		for (size_t k = 3 * i; k < 3 * i + 3; k++)
			g->at[FIT_GRADIENT][FIT_SCALE][k] += weight * g->splats.scales[k] / (3 * (float)g->n);
	}
	return 0;
}

static void step_parameters(struct fit *f, double mean_rate, int degree)
{
	struct fit_gaussians *g = &f->gaussians;

	for (int p = 0; p < fit_parts(degree); p++)
		adam_step(g->at[FIT_VALUE][p], g->at[FIT_GRADIENT][p], g->at[FIT_MOMENT1][p],
			g->at[FIT_MOMENT2][p], g->n * fit_width[p], p == FIT_MEAN ? mean_rate : rates[p], 0.9,
			0.999, 1e-15, f->state.iteration + 1);
}

int fit_check(const struct fit *f, struct err *e)
{
	return fit_gaussians_are_finite(&f->gaussians)
		       ? 0
		       : err_set(e, ERR_CHECK,
				 "training diverged: after step %lld the Gaussians are not finite numbers",
				 (long long)f->state.iteration);
}

/* From time to time dead Gaussians are moved and others added, evenly in the logarithm of their number. */
static int grow_now(struct fit *f, double progress, struct err *e)
{
	struct fit_gaussians *g = &f->gaussians;
	const double share = (progress - GROW_BEGIN) / (GROWN - GROW_BEGIN);

	if (progress < GROW_BEGIN || progress > GROW_END || f->state.is_pruned ||
		progress < f->state.grown + GROW_STEP)
		return 0;
	f->state.grown = progress;
	if (fit_check(f, e))
		return -1;
	const double first = (double)f->state.first, most = (double)f->state.most;
	const double wanted = fmin(first * pow((double)g->capacity / first, fmin(share, 1)), most);
	fit_gaussians_activate(g);
	/* what no view has shown since all were looked at is as good as dead */
	const size_t n = g->n;
	const int all_seen = f->state.iteration - f->state.weighed >= (long)f->views;
	for (size_t i = 0; i < n; i++)
		f->dead[i] = g->splats.opacities[i] <= GROW_DEAD || (all_seen && f->weight[i] < FIT_SHOWN);
	if (grow(g, f->dead, (size_t)wanted, &f->state.rng, e))
		return -1;
	for (size_t i = 0; i < g->n; i++)
		f->weight[i] = all_seen ? 0 : i >= n || f->dead[i] ? FIT_SHOWN : f->weight[i];
	f->state.weighed = all_seen ? f->state.iteration : f->state.weighed;
	return 0;
}

int fit_step(struct fit *f, double progress, struct err *e)
{
	const size_t views = learned(f), turn = (size_t)f->state.iteration % views;
	const double mean_rate = f->options.extent * RATE_MEAN * pow(RATE_MEAN_END / RATE_MEAN, progress);
	int level = FIT_LEVELS - 1, degree = 0;

	while (level && progress >= level_ends[level - 1])
		level--;
	while (degree < f->gaussians.degree && progress >= degree_begins[degree])
		degree++;
	if (!turn)
		rng_shuffle(&f->state.rng, f->order, (uint32_t)views);
	const struct photograph *p = &f->photographs[f->order[turn]];
	fit_gaussians_activate(&f->gaussians);
	if (render(f, &p->camera[level], degree, e) || back(f, p, level, degree, progress, e))
		return -1;
	step_parameters(f, mean_rate, degree);
	if (progress < GROW_END)
		grow_noise(&f->gaussians, mean_rate, f->options.size, f->options.seed, f->state.iteration);
	f->state.iteration++;
	f->state.loss += f->last.total;
	f->state.squares += f->last.squares;
	return grow_now(f, progress, e);
}

int fit_shown(struct fit *f, int level, char *kept, float *worth, struct err *e)
{
	const struct fit_gaussians *g = &f->gaussians;

	memset(kept, 0, g->n);
	for (size_t k = 0; worth && k < g->n; k++)
		worth[k] = 0;
	fit_gaussians_activate(&f->gaussians);
	for (size_t i = 0; i < f->views; i++) {
		const struct camera *c = &f->photographs[i].camera[level];
		const size_t pixels = (size_t)c->width * (size_t)c->height;
		if (render(f, c, 0, e))
			return -1;
		memset(f->image, 0, 6 * pixels * sizeof *f->image);
		if (back_view(f->view, f->colors, f->image, f->image + 3 * pixels, f->sums, &f->back, e))
			return -1;
		for (size_t k = 0; k < g->n; k++) {
			const float own = f->sums[k * BACK_SUMS + BACK_WEIGHT];
			kept[k] |= own >= FIT_SHOWN;
			if (worth)
				worth[k] += own;
		}
	}
	return 0;
}
