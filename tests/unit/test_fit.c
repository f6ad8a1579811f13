/* The gradients of training beside central differences of a plain forward pass in long double
 * (render_twin.h), in hard cases; the loss of images beside its definition; how Gaussians are split. */
#include "unit.h"

#include "base/rng.h"
#include "fit/back.h"
#include "fit/fit.h"
#include "fit/grow.h"
#include "fit/project_back.h"
#include "render_compare.h"
#include "splat/sh.h"
#include "splat/view.h"

#include <omp.h>

enum { WIDTH = 29, HEIGHT = 21, PIXELS = WIDTH * HEIGHT, MOST = 512 };

static const char *const level_names[CPU_LEVELS] = {"plain", "avx2", "avx512"};
static const char *const part_names[FIT_PARTS] = {
	"mean", "scale", "quat", "logit", "sh", "sh1", "sh2", "sh3"};

/* A scene with colours of degree 3, a camera, and a gradient for each pixel. */
struct problem {
	struct fit_gaussians g;
	struct splats s; /* the same with harmonics in one array */
	struct camera c;
	float gradient[3 * PIXELS];
};

static void problem_make(struct problem *p, const struct splats *from, const struct camera *c)
{
	struct err e;
	struct rng r;
	struct splats s;

	rng_seed(&r, 5, 2);
	p->c = *c;
	if (splats_alloc(&s, from->n, 16, &e) || fit_gaussians_alloc(&p->g, from->n, 3, &e))
		abort();
	memcpy(s.means, from->means, 3 * s.n * sizeof(float));
	memcpy(s.scales, from->scales, 3 * s.n * sizeof(float));
	memcpy(s.quats, from->quats, 4 * s.n * sizeof(float));
	memcpy(s.opacities, from->opacities, s.n * sizeof(float));
	for (size_t i = 0; i < 48 * s.n; i++)
		s.sh[i] = (float)((i % 48 < 3 ? 0.8 : 0.3) * rng_normal(&r));
	fit_gaussians_take(&p->g, &s);
	fit_gaussians_activate(&p->g);
	/* so that both have the same bits */
	memcpy(s.scales, p->g.splats.scales, 3 * s.n * sizeof(float));
	memcpy(s.opacities, p->g.splats.opacities, s.n * sizeof(float));
	p->s = s;
	for (int i = 0; i < 3 * PIXELS; i++)
		p->gradient[i] = (float)rng_normal(&r);
}

static void problem_free(struct problem *p)
{
	splats_free(&p->s);
	fit_gaussians_free(&p->g);
}

static void twin_color(const struct problem *p, size_t i, long double rgb[3])
{
	double centre[3], d[3], y[SH_MAX], length;

	camera_centre(&p->c, centre);
	for (size_t k = 0; k < 3; k++)
		d[k] = p->s.means[3 * i + k] - centre[k];
	length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
	for (int k = 0; k < 3; k++)
		d[k] /= length;
	sh_basis(d, 16, y);
	for (size_t n = 0; n < 3; n++) {
		rgb[n] = 0.5L;
		for (size_t k = 0; k < 16; k++)
			rgb[n] += (long double)y[k] * p->s.sh[48 * i + 3 * k + n];
		rgb[n] = fmaxl(0, rgb[n]);
	}
}

/* The sum over pixels of gradient times colour. With `mend`, pixels at which something is about to change
 * that has no slope get no gradient. */
static long double twin_loss(struct problem *p, int mend)
{
	static int32_t index[MOST];
	static double weight[MOST];
	static long double rgb[MOST][3];
	long double sum = 0;
	struct twin twin;

	twin_prepare(&twin, &p->s, &p->c);
	for (size_t i = 0; i < p->s.n; i++)
		twin_color(p, i, rgb[i]);
	for (int at = 0; at < PIXELS; at++) {
		struct twin_pixel pixel = {.index = index, .weight = weight};
		twin_blend(&twin, at % WIDTH, at / WIDTH, &pixel);
		for (int n = 0; n < 3; n++) {
			if (mend && pixel.margin < 0.03)
				p->gradient[n * PIXELS + at] = 0;
			for (size_t k = 0; k < pixel.n; k++)
				sum += p->gradient[n * PIXELS + at] * pixel.weight[k] *
				       rgb[pixel.index[k]][n];
		}
	}
	twin_free(&twin);
	return sum;
}

/* Where the twin has parameter k of a part, and the parameter's slope in what is there. */
static float *twin_place(struct problem *p, size_t i, int part, size_t k, double *slope)
{
	static const unsigned char begin[FIT_PARTS] = {0, 0, 0, 0, 0, 3, 12, 27};
	const double o = p->s.opacities[i];

	*slope = part == FIT_SCALE ? (double)p->s.scales[3 * i + k] : part == FIT_LOGIT ? o * (1 - o) : 1;
	return part == FIT_MEAN	   ? &p->s.means[3 * i + k]
	       : part == FIT_SCALE ? &p->s.scales[3 * i + k]
	       : part == FIT_QUAT  ? &p->s.quats[4 * i + k]
	       : part == FIT_LOGIT ? &p->s.opacities[i]
				   : &p->s.sh[48 * i + begin[part] + k];
}

static double difference(struct problem *p, float *at, double step)
{
	const float kept = *at, high = (float)(kept + step), low = (float)(kept - step);

	*at = high;
	const long double up = twin_loss(p, 0);
	*at = low;
	const long double down = twin_loss(p, 0);
	*at = kept;
	return (double)((up - down) / ((long double)high - low));
}

/* Richardson's extrapolation of two central differences. */
static double slope_of(struct problem *p, size_t i, int part, size_t k)
{
	const struct splats *s = &p->s;
	double slope, least = fmin(fmin(s->scales[3 * i], s->scales[3 * i + 1]), s->scales[3 * i + 2]);
	float *at = twin_place(p, i, part, k, &slope);
	const double most = fmax(fmax(s->scales[3 * i], s->scales[3 * i + 1]), s->scales[3 * i + 2]);
	const double step = part == FIT_MEAN	? 3e-3 * fmax(least, 0.01)
			    : part == FIT_SCALE ? 1e-3 * fmax(*at, 0.01)
			    : part == FIT_QUAT	? fmin(2e-3, 0.03 * fmax(least, 0.01) / most)
			    : part == FIT_LOGIT ? 3e-4 * fmin(*at, 1.0 - *at) + 1e-7
						: 2e-3;
	const double near = difference(p, at, step / 2), far = difference(p, at, step);
	return slope * (4 * near - far) / 3;
}

static void gradients(struct problem *p, enum cpu_level level)
{
	static float image[3 * PIXELS], colors[3 * MOST], sums[BACK_SUMS * MOST];
	static uint8_t seen[MOST];
	struct back_room room = {0};
	struct err e;
	struct render_view *v = render_prepare(&p->g.splats, &p->c, &e);

	if (!v)
		abort();
	v->level = level;
	fit_seen(v, seen);
	fit_colors(&p->g, seen, &p->c, 3, colors);
	render_packed(v, colors, 3, image, NULL);
	if (back_view(v, colors, image, p->gradient, sums, &room, &e))
		abort();
	fit_project_back(&p->g, v, seen, &p->c, 3, colors, sums);
	back_free(&room);
	render_free(v);
}

/* Harmonics are many and alike: some of them will do. */
static size_t stride_of(int part)
{
	return part < FIT_SH1 ? 1 : 5;
}

/* Every step-th Gaussian's gradients; the error is beside the part's largest. */
static void check(
	const char *what, const struct splats *s, const struct camera *c, size_t step, double tolerance)
{
	static struct problem p;
	static double slopes[MOST][FIT_PARTS][21];
	double most[FIT_PARTS] = {0};

	problem_make(&p, s, c);
	twin_loss(&p, 1);
	for (size_t i = 0; i < s->n; i += step)
		for (int part = 0; part < FIT_PARTS; part++)
			for (size_t k = 0; k < fit_width[part]; k += stride_of(part)) {
				slopes[i][part][k] = slope_of(&p, i, part, k);
				most[part] = fmax(most[part], fabs(slopes[i][part][k]));
			}
	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++) {
		double worst[FIT_PARTS] = {0};
		gradients(&p, level);
		for (size_t i = 0; i < s->n; i += step)
			for (int part = 0; part < FIT_PARTS; part++)
				for (size_t k = 0; k < fit_width[part]; k += stride_of(part))
					worst[part] = fmax(worst[part],
						fabs(slopes[i][part][k] -
							(double)p.g.at[FIT_GRADIENT][part]
								      [fit_width[part] * i + k]));
		for (int part = 0; part < FIT_PARTS; part++) {
			if (level == cpu_level())
				printf("%s: %s: %.1e of %.3g\n", what, part_names[part],
					worst[part] / most[part], most[part]);
			CHECK(worst[part] <= tolerance * most[part] + 1e-9, "%s, %s: %s is off by %g of %g",
				what, level_names[level], part_names[part], worst[part], most[part]);
		}
	}
	problem_free(&p);
}

static struct camera tilted(void)
{
	struct camera c = camera_at_origin(WIDTH, HEIGHT, 30);
	const double angle = 0.2;

	memcpy(c.world_to_camera[0], (double[4]){cos(angle), 0, sin(angle), 0.2},
		sizeof c.world_to_camera[0]);
	memcpy(c.world_to_camera[2], (double[4]){-sin(angle), 0, cos(angle), 0.5},
		sizeof c.world_to_camera[2]);
	c.fy = 25;
	c.cx = 16.3;
	return c;
}

static void random_scene(void)
{
	const struct camera c = tilted();
	struct splats s = random_splats(7, 60, 0.15, 0.6);

	check("random", &s, &c, 7, 1e-4);
	splats_free(&s);
}

/* Long or flat, at odd angles, near the border and beyond the limit of x/z; clear and opaque. */
static void hard_shapes(void)
{
	const struct camera c = tilted();
	static const double means[][3] = {{0, 0, 2}, {0.3, 0.2, 2}, {-1.9, 0.1, 2}, {2, -0.3, 2.2},
		{0.1, -0.2, 3}, {0.2, 0.3, 0.1}, {0, 0.1, 1.5}, {-0.4, -0.5, 4}, {0.5, 0.5, 60}, {0, 0, -1}};
	static const double scales[][3] = {{1e-3, 1e-3, 0.6}, {0.5, 0.4, 1e-4}, {0.4, 0.4, 0.4},
		{1.1, 0.3, 0.6}, {0.3, 0.2, 0.3}, {0.3, 0.3, 0.3}, {0.05, 0.2, 0.01}, {0.02, 0.9, 0.02},
		{9, 5, 7}, {0.1, 0.1, 0.1}};
	static const double opacities[] = {0.9, 0.8, 0.7, 0.6, 0.9999, 0.5, 0.006, 0.3, 0.95, 0.5};
	const size_t n = sizeof opacities / sizeof *opacities;
	struct splats s = make_splats(n);

	for (size_t i = 0; i < n; i++) {
		set_splat(&s, i, means[i], scales[i], opacities[i]);
		memcpy(s.quats + 4 * i, (float[4]){0.9f, 0.4f - 0.1f * (float)i, 1.3f, -0.7f},
			4 * sizeof(float));
	}
	for (size_t i = 0; i < n; i++) {
		char name[32];
		struct splats one = {.n = 1,
			.sh_coefficients = 1,
			.near = s.near,
			.means = s.means + 3 * i,
			.scales = s.scales + 3 * i,
			.quats = s.quats + 4 * i,
			.opacities = s.opacities + i,
			.sh = s.sh};
		snprintf(name, sizeof name, "shape %zu alone", i);
		check(name, &one, &c, 1, 2e-4);
	}
	check("shapes", &s, &c, 1, 2e-4);
	splats_free(&s);
}

/* Hundreds on every pixel. */
static void deep(void)
{
	const struct camera c = camera_at_origin(WIDTH, HEIGHT, 30);
	struct splats s = make_splats(400);
	struct rng r;

	rng_seed(&r, 8, 1);
	for (size_t i = 0; i < s.n; i++)
		set_splat(&s, i,
			(double[3]){rng_range(&r, -0.3, 0.3), rng_range(&r, -0.3, 0.3),
				2 + 0.02 * (double)(i * 7 % s.n)},
			(double[3]){0.9, 0.6, 0.8}, 0.02);
	check("layers", &s, &c, 133, 1e-4);
	splats_free(&s);
}

/* The definition: windows in two dimensions, in double. */
static double twin_photo_loss(const float *image, const uint8_t *photograph)
{
	double total = 0, window[11], sum = 0;

	for (int t = 0; t < 11; t++)
		sum += window[t] = exp(-(t - 5) * (t - 5) / 4.5);
	for (int n = 0; n < 3; n++)
		for (int at = 0; at < PIXELS; at++) {
			double m[5] = {0};
			for (int i = 0; i < 121; i++) {
				const int x = at % WIDTH + i % 11 - 5, y = at / WIDTH + i / 11 - 5;
				if (x < 0 || x >= WIDTH || y < 0 || y >= HEIGHT)
					continue;
				const double a = image[n * PIXELS + y * WIDTH + x],
					     b = photograph[3 * (y * WIDTH + x) + n] / 255.0;
				const double w = window[i % 11] * window[i / 11] / (sum * sum);
				const double products[5] = {a, b, a * a, b * b, a * b};
				for (int k = 0; k < 5; k++)
					m[k] += w * products[k];
			}
			const double ssim = (2 * m[0] * m[1] + 1e-4) * (2 * (m[4] - m[0] * m[1]) + 9e-4) /
					    (m[0] * m[0] + m[1] * m[1] + 1e-4) /
					    (m[2] - m[0] * m[0] + m[3] - m[1] * m[1] + 9e-4);
			total += 0.8 * fabs(image[n * PIXELS + at] - photograph[3 * at + n] / 255.0) +
				 0.2 * (1 - ssim);
		}
	return total / (3 * PIXELS);
}

static void loss_of_images(void)
{
	static float image[3 * PIXELS], gradient[3 * PIXELS];
	static uint8_t photograph[3 * PIXELS];
	struct photo_loss_room room = {0};
	struct photo_loss l;
	struct err e;
	struct rng r;
	double worst = 0, most = 0;

	rng_seed(&r, 9, 1);
	for (int i = 0; i < 3 * PIXELS; i++) {
		photograph[i] = (uint8_t)rng_below(&r, 256);
		image[i % 3 * PIXELS + i / 3] = (float)(photograph[i] / 255.0 + 0.2 * rng_normal(&r));
	}
	if (photo_loss(&l, image, photograph, HEIGHT, WIDTH, gradient, &room, &e))
		abort();
	CHECK(fabs(l.total - twin_photo_loss(image, photograph)) < 1e-6, "%.9g, not %.9g", l.total,
		twin_photo_loss(image, photograph));
	for (int i = 0; i < 3 * PIXELS; i += 37) {
		const float kept = image[i];
		image[i] = kept + 1e-3f;
		const double high = twin_photo_loss(image, photograph), up = image[i];
		image[i] = kept - 1e-3f;
		const double slope = (high - twin_photo_loss(image, photograph)) / (up - image[i]);
		image[i] = kept;
		worst = fmax(worst, fabs(slope - (double)gradient[i]));
		most = fmax(most, fabs(slope));
	}
	printf("image loss: gradient %.1e of %.3g\n", worst / most, most);
	CHECK(worst < 1e-3 * most, "the gradient is off by %g of %g", worst, most);
	photo_loss_free(&room);
}

/* Copies look like their original: the most and the sum of what they show. */
static void splitting(void)
{
	for (int copies = 1; copies <= 51; copies += 10)
		for (double o = 0.01; o < 1; o += 0.14) {
			double part, factor, a = 0, b = 0;
			grow_split(o, copies, &part, &factor);
			for (double s = 0; s < 8; s += 1e-3) {
				a += o * exp(-s * s);
				b += 1 - pow(1 - part * exp(-s * s / (factor * factor)), copies);
			}
			CHECK(fabs(1 - pow(1 - part, copies) - o) < 1e-9, "%d copies of %g: %g each", copies,
				o, part);
			CHECK(fabs(b / a - 1) < 2e-3, "%d copies of %g show %g of it", copies, o, b / a);
		}
}

/* A short training on pictures of known Gaussians: it learns, and threads change nothing. */
static void learns(void)
{
	static uint8_t rgb[3 * PIXELS];
	static float planes[3 * PIXELS];
	struct splats s = random_splats(3, 200, 0.15, 0.5);
	struct photograph photographs[4];
	struct fit_gaussians first[2];
	float *ends[2] = {NULL};
	struct photo_loss before = {0}, after = {0};
	struct err e;

	for (int v = 0; v < 4; v++) {
		struct camera c = camera_at_origin(WIDTH, HEIGHT, 30);
		c.world_to_camera[0][3] = 0.1 * v;
		struct render_view *view = render_prepare(&s, &c, &e);
		if (!view || render_colors(view, &s, &c, (const float[3]){0}, planes, &e))
			abort();
		for (int i = 0; i < 3 * PIXELS; i++)
			rgb[i] = (uint8_t)(255 * planes[i] + 0.5f);
		render_free(view);
		if (photograph_make(&photographs[v], &c, 1, rgb, HEIGHT, WIDTH, &e))
			abort();
	}
	for (int k = 0; k < 2; k++) {
		struct fit f;
		const struct fit_options o = {.extent = 1, .size = FIT_SIZE, .seed = 4};
		omp_set_num_threads(k ? 3 : 1);
		if (fit_gaussians_alloc(&first[k], 300, 1, &e))
			abort();
		fit_gaussians_take(&first[k], &s);
		for (size_t i = 0; i < 600; i++)
			first[k].at[FIT_VALUE][FIT_SH][i] = 0;
		if (fit_open(&f, &first[k], &o, photographs, 3, 0, &e) ||
			fit_judge(&f, &photographs[3], &before, &e))
			abort();
		for (int i = 0; i < 100; i++)
			CHECK(!fit_step(&f, i / 100.0, &e), "step %d: %s", i, e.message);
		if (fit_judge(&f, &photographs[3], &after, &e))
			abort();
		CHECK(f.gaussians.n == 300, "%zu Gaussians", f.gaussians.n);
		CHECK(after.total < 0.5 * before.total,
			"the loss of a view that was not learned from: %g, then %g", before.total,
			after.total);
		ends[k] = malloc(300 * 3 * sizeof(float));
		memcpy(ends[k], f.gaussians.splats.means, 300 * 3 * sizeof(float));
		f.gaussians.splats.means[7] = NAN;
		CHECK(fit_step(&f, 1, &e) == 0 && fit_check(&f, &e) == -1 && e.code == ERR_CHECK,
			"a number that is none is found");
		fit_close(&f);
	}
	CHECK(!memcmp(ends[0], ends[1], 300 * 3 * sizeof(float)), "1 and 3 threads differ");
	for (int v = 0; v < 4; v++)
		photograph_free(&photographs[v]);
	free(ends[0]);
	free(ends[1]);
	splats_free(&s);
}

int main(void)
{
	random_scene();
	hard_shapes();
	deep();
	loss_of_images();
	splitting();
	learns();
	return unit_end();
}
