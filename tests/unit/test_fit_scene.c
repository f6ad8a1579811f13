/* What training makes of photographs that are not as they should be: exposed unlike, with pixels that do not
 * count, in another unit; and that it leaves out what a scene does not need. */
#include "unit.h"

#include "base/rng.h"
#include "fit/grow.h"
#include "render_compare.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT, VIEWS = 5, STEPS = 400 };

/* How the photographs are made: that of view v is gains[v] times what it shows; the lower left quarter is
 * noise; lengths are `unit` times as long. */
struct conditions {
	float gains[VIEWS];
	int is_noisy, is_ignored, is_exposed;
	double unit;
	size_t capacity;
};

static void scene_make(struct splats *s, struct photograph *p, const struct conditions *with)
{
	static float planes[3 * PIXELS];
	static uint8_t rgb[3 * PIXELS], mask[PIXELS];
	struct rng r;
	struct err e;

	rng_seed(&r, 3, 1);
	*s = random_splats(3, 150, 0.12, 0.5);
	for (size_t i = 0; i < s->n; i++)
		for (size_t k = 0; k < 3 * (size_t)s->sh_coefficients; k++)
			s->sh[i * 3 * (size_t)s->sh_coefficients + k] *= k < 3 ? 0.25f : 0;
	for (int v = 0; v < VIEWS; v++) {
		struct camera c = camera_at_origin(WIDTH, HEIGHT, 40);
		c.world_to_camera[0][3] = 0.08 * v;
		struct render_view *view = render_prepare(s, &c, &e);
		if (!view || render_colors(view, s, &c, (const float[3]){0}, planes, &e))
			abort();
		for (int i = 0; i < 3 * PIXELS; i++) {
			const int x = i / 3 % WIDTH, y = i / 3 / WIDTH,
				  is_noise = x < WIDTH / 2 && y >= HEIGHT / 2;
			mask[i / 3] = (uint8_t)is_noise;
			rgb[i] = with->is_noisy && is_noise && v < VIEWS - 1
					 ? (uint8_t)rng_below(&r, 256)
					 : (uint8_t)fminf(
						   255, 255 * 0.45f * with->gains[v] * planes[i] + 0.5f);
		}
		render_free(view);
		c.world_to_camera[0][3] *= with->unit;
		if (photograph_make(&p[v], &c, 1, rgb, HEIGHT, WIDTH, &e) ||
			((v < VIEWS - 1 ? with->is_ignored : with->is_noisy) &&
				photograph_ignore(&p[v], mask, HEIGHT, WIDTH, &e)))
			abort();
	}
	for (size_t i = 0; i < 3 * s->n; i++) {
		s->means[i] *= (float)with->unit;
		s->scales[i] *= (float)with->unit;
	}
}

/* PSNR of the last view, which is not learned from; *n gets how many Gaussians there are in the end. */
static double train(const struct conditions *with, size_t *n)
{
	struct photograph p[VIEWS];
	struct fit_gaussians g;
	struct photo_loss l = {0};
	struct splats s;
	struct fit f;
	struct err e;
	double spread, psnr, ssim;
	int is_due;

	scene_make(&s, p, with);
	const struct fit_options o = {.extent = with->unit, .size = FIT_SIZE * with->unit, .seed = 4};
	if (fit_gaussians_alloc(&g, with->capacity, 0, &e))
		abort();
	fit_gaussians_take(&g, &s);
	for (size_t i = 0; i < 3 * s.n; i++)
		g.at[FIT_VALUE][FIT_SH][i] = -0.8f;
	g.splats.near = 0.01 * with->unit;
	if (fit_open(&f, &g, &o, p, VIEWS - 1, 0, &e) || (with->is_exposed && fit_expose(&f, 0, &spread, &e)))
		abort();
	for (int i = 0; i < STEPS; i++) {
		const double progress = (double)i / STEPS;
		if (!f.state.is_pruned && progress >= FIT_PRUNED && fit_prune(&f, &e))
			abort();
		CHECK(!fit_evaluate(&f, progress, &is_due, &psnr, &ssim, &e) && !fit_step(&f, progress, &e),
			"step %d: %s", i, e.message);
	}
	exposures_free(&f.exposures); /* so that the view is judged as it is */
	if (fit_judge(&f, &p[VIEWS - 1], &l, &e))
		abort();
	*n = f.gaussians.n;
	fit_close(&f);
	for (int v = 0; v < VIEWS; v++)
		photograph_free(&p[v]);
	splats_free(&s);
	return fit_psnr(l.squares);
}

/* A view shows twice as large what a photograph of half its size did; what is not in the photograph stays. */
static void check_widened(void)
{
	static const uint8_t rgb[3 * PIXELS];
	const struct camera c = camera_at_origin(WIDTH, HEIGHT, 40);
	struct splats s = random_splats(3, 2, 0.12, 0.5);
	struct photograph p[2];
	struct err e;

	if (photograph_make(&p[0], &c, 0.5, rgb, HEIGHT, WIDTH, &e) ||
		photograph_make(&p[1], &c, 1, rgb, HEIGHT, WIDTH, &e))
		abort();
	memcpy(s.means, (const float[]){0, 0, 5, 0, 0, -5}, 6 * sizeof(float));
	memcpy(s.scales, (const float[]){0.1f, 0.01f, 1, 1, 1, 1}, 6 * sizeof(float));
	photographs_widen(&s, p, 1);
	for (int k = 0; k < 2; k++) {
		const double old = k ? 0.01 : 0.1, photograph = pow(old * 20 / 5, 2) + 0.3,
			     view = pow((double)s.scales[k] * 40 / 5, 2) + 0.3;
		CHECK(fabs(view / (4 * photograph) - 1) < 1e-6, "axis %d: %.4f px^2 of %.4f", k, view,
			4 * photograph);
	}
	CHECK(s.scales[3] == 1, "behind the camera: %g", s.scales[3]);
	const float before = s.scales[0];
	photographs_widen(&s, p, 2);
	CHECK(s.scales[0] == before, "one whole photograph tells all: %g, not %g", s.scales[0], before);
	photograph_free(&p[0]);
	photograph_free(&p[1]);
	splats_free(&s);
}

int main(void)
{
	check_widened();
	struct conditions with = {.gains = {1, 1, 1, 1, 1}, .unit = 1, .capacity = 150};
	size_t n, many;
	const double plain = train(&with, &n);

	with.unit = 1000;
	double psnr = train(&with, &n);
	CHECK(psnr > plain - 4, "in another unit: %.2f, not %.2f dB", psnr, plain);
	with.unit = 1;
	with.capacity = 1500;
	psnr = train(&with, &many);
	CHECK(many < 1000, "%zu of 1500 Gaussians are left for a scene of 150", many);
	CHECK(psnr > 45, "of many Gaussians few are left: %.2f dB", psnr);
	with.capacity = 150;

	memcpy(with.gains, (const float[]){0.5f, 2, 0.8f, 0.7f, 1}, sizeof with.gains);
	const double fog = train(&with, &n);
	with.is_exposed = 1;
	psnr = train(&with, &n);
	CHECK(fog < plain - 5, "exposures that nobody knows of cost nothing: %.2f beside %.2f dB", fog,
		plain);
	CHECK(psnr > 40, "exposures are learned: %.2f dB", psnr);

	with = (struct conditions){.gains = {1, 1, 1, 1, 1}, .unit = 1, .capacity = 150, .is_noisy = 1};
	const double noisy = train(&with, &n);
	with.is_ignored = 1;
	psnr = train(&with, &n);
	CHECK(psnr > noisy + 6, "ignored pixels still count: %.2f, not ignored %.2f dB", psnr, noisy);
	printf("plain %.2f, fog %.2f, noisy %.2f, ignored %.2f dB\n", plain, fog, noisy, psnr);
	return unit_end();
}
