#include "unit.h"

#include "base/cpu.h"
#include "formats/scene/scene.h"
#include "render_compare.h"
#include "splat/render.h"
#include "splat/sh.h"
#include "splat/view.h"

#include <omp.h>

static const char *const level_names[CPU_LEVELS] = {"plain", "avx2", "avx512"};

/* The agreement that is promised, at every level this machine has. Returns the weights seen. */
static double check_view(const char *what, const struct splats *s, const struct camera *c)
{
	double nnz = 0;

	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++) {
		struct render_report r = render_compare(s, c, level, 1);
		CHECK(r.pixels == (long)c->width * c->height, "%s: %ld pixels", what, r.pixels);
		CHECK(r.weight <= 1e-5, "%s, %s: a weight is off by %g", what, level_names[level], r.weight);
		CHECK(r.sum <= 1e-6, "%s, %s: weights and transmittance miss 1 by %g", what,
			level_names[level], r.sum);
		CHECK(r.cuts <= 1 + r.pixels / 500, "%s, %s: %ld of %ld pixels cut elsewhere", what,
			level_names[level], r.cuts, r.pixels);
		CHECK(r.cut_margin < 1e-4, "%s, %s: a cut %g away was missed", what, level_names[level],
			r.cut_margin);
		nnz = r.nnz;
	}
	return nnz;
}

static void random_scenes(void)
{
	struct camera c = camera_at_origin(67, 45, 40);
	struct splats s = random_splats(1, 1500, 0.05, 1);

	CHECK(check_view("random", &s, &c) > 10000, "there is something to see");
	c.cx = 11.3;
	c.cy = 52.8; /* below the image */
	CHECK(check_view("principal point off the centre", &s, &c) > 10000, "there is something to see");
	c.fy = 25;
	double angle = 0.3;
	memcpy(c.world_to_camera[0], (double[4]){cos(angle), 0, sin(angle), 0.4},
		sizeof c.world_to_camera[0]);
	memcpy(c.world_to_camera[2], (double[4]){-sin(angle), 0, cos(angle), 0.7},
		sizeof c.world_to_camera[2]);
	check_view("turned camera", &s, &c);
	splats_free(&s);
}

static void odd_sizes(void)
{
	struct splats s = random_splats(2, 300, 0.05, 0.7);
	static const int sizes[][2] = {{1, 1}, {16, 16}, {17, 1}, {1, 33}, {15, 31}};

	for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
		struct camera c = camera_at_origin(sizes[i][0], sizes[i][1], 20);
		CHECK(check_view("odd size", &s, &c) > 0, "%dx%d has weights", sizes[i][0], sizes[i][1]);
	}
	splats_free(&s);
}

static void needles(void)
{
	struct camera c = camera_at_origin(50, 50, 40);
	struct splats s = needle_splats();

	CHECK(check_view("needles", &s, &c) > 1000, "there is something to see");
	splats_free(&s);
}

static void zero_and_huge_scales(void)
{
	struct camera c = camera_at_origin(40, 24, 30);
	struct splats s = odd_scale_splats();
	struct err e;

	CHECK(check_view("zero and huge scales", &s, &c) > 2 * 960, "the huge ones cover all");
	/* beyond double: left out, not NaN */
	for (int k = 0; k < 3; k++)
		s.scales[k] = 3e38f;
	c.fx = c.fy = 1e250;
	struct render_view *v = render_prepare(&s, &c, &e);
	CHECK(v && v->visible < 5, "what exceeds double is left out");
	render_free(v);
	splats_free(&s);
}

static void unnormalised_quaternions(void)
{
	struct camera c = camera_at_origin(30, 30, 30);
	struct splats s = random_splats(4, 100, 0.1, 1);

	for (size_t i = 0; i < 4 * s.n; i++)
		s.quats[i] *= i / 4 % 2 ? 1e-17f : 1e17f;
	CHECK(check_view("quaternions of any length", &s, &c) > 100, "there is something to see");
	splats_free(&s);
}

static void camera_plane(void)
{
	struct camera c = camera_at_origin(33, 33, 30);
	static const double depths[] = {-5, -1e-3, 0, 1e-30, 0.1, 0.2, 0.2000001, 0.25, 1};
	size_t n = sizeof depths / sizeof depths[0];
	struct splats s = make_splats(n);
	struct err e;

	for (size_t i = 0; i < n; i++)
		set_splat(
			&s, i, (double[3]){0.01 * (double)i, 0, depths[i]}, (double[3]){0.5, 0.01, 0.5}, 0.3);
	CHECK(check_view("the camera plane", &s, &c) > 0, "there is something to see");
	struct render_view *v = render_prepare(&s, &c, &e);
	/* the float nearest to 0.2 is above it */
	CHECK(v && v->visible == 4, "z <= 0.2 is left out");
	render_free(v);
	splats_free(&s);
}

/* Means and camera near 1e6: the float means are a sixteenth apart, their projection is as good as they are.
 */
static void far_from_the_origin(void)
{
	struct camera c = camera_at_origin(40, 40, 30);
	struct splats s = random_splats(5, 400, 0.3, 0.5);

	for (size_t i = 0; i < s.n; i++)
		for (size_t k = 0; k < 3; k++)
			s.means[3 * i + k] = s.means[3 * i + k] * 4 + 1e6f;
	for (int k = 0; k < 3; k++)
		c.world_to_camera[k][3] = -1e6;
	CHECK(check_view("near 1e6", &s, &c) > 1000, "there is something to see");
	splats_free(&s);
}

static void ties_break_by_index(void)
{
	struct camera c = camera_at_origin(8, 8, 8);
	struct splats s = make_splats(300);
	struct render_weights w;
	struct err e;
	int rising = 1;

	/* three depths, in turn, each shared by a hundred */
	for (size_t i = 0; i < s.n; i++)
		set_splat(&s, i, (double[3]){0, 0, 1 + (double)(i * 7 % 3)}, (double[3]){9, 9, 9}, 0.01);
	check_view("depth ties", &s, &c);
	struct render_view *v = render_prepare(&s, &c, &e);
	if (CHECK(v && !render_weights(v, &w, &e), "renders")) {
		CHECK(w.indptr[1] > 200, "%lld layers", (long long)w.indptr[1]);
		for (int64_t k = 1; k < w.indptr[1]; k++) {
			int depth = w.index[k] * 7 % 3, before = w.index[k - 1] * 7 % 3;
			rising &= depth > before || (depth == before && w.index[k] > w.index[k - 1]);
		}
		CHECK(rising, "equal depths stand by index");
		render_weights_free(&w);
	}
	render_free(v);
	splats_free(&s);
}

static void close_depths(void)
{
	struct camera c = camera_at_origin(8, 8, 8);
	struct splats s = close_splats(&c);

	CHECK(check_view("close depths", &s, &c) > 0, "there is something to see");
	splats_free(&s);
}

static void ten_thousand_layers(void)
{
	struct camera c = camera_at_origin(5, 5, 5);
	struct splats s = layer_splats(10000);

	double nnz = check_view("10,000 layers", &s, &c);
	CHECK(nnz > 25 * 2000 && nnz < 25 * 2500, "%g weights: all pixels end before the last layer", nnz);
	splats_free(&s);
}

static void opacity_at_the_ends(void)
{
	struct camera c = camera_at_origin(20, 20, 20);
	struct splats s = make_splats(4);
	struct render_weights w;
	struct err e;

	set_splat(&s, 0, (double[3]){0, 0, 1}, (double[3]){1, 1, 1}, 0);
	set_splat(&s, 1, (double[3]){0, 0, 2}, (double[3]){1, 1, 1}, 1);
	set_splat(&s, 2, (double[3]){0, 0, 3}, (double[3]){1, 1, 1}, 1 / 256.0);
	set_splat(&s, 3, (double[3]){0, 0, 4}, (double[3]){1e3, 1e3, 1e3}, 1);
	check_view("opacity 0 and 1", &s, &c);
	struct render_view *v = render_prepare(&s, &c, &e);
	if (CHECK(v && !render_weights(v, &w, &e), "renders")) {
		int64_t p = w.indptr[10 * 20 + 10];
		CHECK(w.indptr[10 * 20 + 11] - p == 1 && w.index[p] == 1,
			"only the first opaque one is seen");
		CHECK(w.weight[p] == 0.99f, "a is cut at 0.99, not %g", (double)w.weight[p]);
		render_weights_free(&w);
	}
	render_free(v);
	splats_free(&s);
}

static void one_and_none(void)
{
	struct camera c = camera_at_origin(21, 13, 20);
	struct splats s = make_splats(1), none = make_splats(0);
	float value = 1, out[21 * 13], left[21 * 13];
	struct err e;

	set_splat(&s, 0, (double[3]){0.1, 0, 1}, (double[3]){0.1, 0.2, 0.1}, 0.8);
	CHECK(check_view("one Gaussian", &s, &c) > 10, "it is seen");
	CHECK(check_view("no Gaussian", &none, &c) == 0, "nothing is seen");
	s.means[2] = -1;
	CHECK(check_view("a view that sees nothing", &s, &c) == 0, "nothing is seen");
	struct render_view *v = render_prepare(&s, &c, &e);
	CHECK(v && !render_values(v, &value, 1, out, left, &e) && out[100] == 0 && left[100] == 1,
		"the image is empty");
	render_free(v);
	splats_free(&s);
	splats_free(&none);
}

/* render_values, at any number of channels, is the product of the weights with the values. */
static void values_are_the_product(void)
{
	enum { CHANNELS = 11 };
	struct camera c = camera_at_origin(50, 35, 30);
	struct splats s = random_splats(7, 800, 0.05, 0.8);
	size_t pixels = (size_t)c.width * (size_t)c.height;
	float *values = malloc(CHANNELS * s.n * sizeof *values),
	      *out = malloc(CHANNELS * pixels * sizeof *out);
	float *left = malloc(pixels * sizeof *left);
	struct render_weights w;
	struct err e;

	for (size_t i = 0; i < CHANNELS * s.n; i++)
		values[i] = (float)(i * 7 % 13) - 6;
	struct render_view *v = render_prepare(&s, &c, &e);
	for (enum cpu_level level = CPU_PLAIN; v && level <= cpu_level(); level++) {
		v->level = level;
		if (!CHECK(!render_weights(v, &w, &e), "renders"))
			break;
		for (int channels = 1; channels <= CHANNELS; channels += channels == 3 ? 8 : 1) {
			double worst = 0;
			int is_left_same = 1;
			if (!CHECK(!render_values(v, values, channels, out, left, &e), "renders"))
				break;
			for (size_t p = 0; p < pixels; p++) {
				is_left_same &= left[p] == w.transmittance[p];
				for (size_t k = 0; k < (size_t)channels; k++) {
					double sum = 0;
					for (int64_t i = w.indptr[p]; i < w.indptr[p + 1]; i++)
						sum += (double)w.weight[i] *
						       values[k * s.n + (size_t)w.index[i]];
					worst = fmax(worst, fabs(sum - out[k * pixels + p]));
				}
			}
			CHECK(worst < 1e-5, "%s, %d channels: off by %g", level_names[level], channels,
				worst);
			CHECK(is_left_same, "%s: transmittance is the same", level_names[level]);
		}
		render_weights_free(&w);
	}
	render_free(v);
	free(values);
	free(out);
	free(left);
	splats_free(&s);
}

/* AVX2 gives the bits of AVX-512, for values and for weights. */
static void fused_levels_are_equal(void)
{
	enum { CHANNELS = 3 };
	struct camera c = camera_at_origin(53, 37, 30);
	struct splats s = random_splats(11, 3000, 0.05, 0.8);
	const size_t pixels = (size_t)c.width * (size_t)c.height;
	float *values = malloc(CHANNELS * s.n * sizeof *values), *out[2], *left[2];
	struct render_weights w[2] = {{0}};
	struct err e;

	for (size_t i = 0; i < CHANNELS * s.n; i++)
		values[i] = (float)(i * 7 % 13) / 3;
	struct render_view *v = render_prepare(&s, &c, &e);
	for (int i = 0; i < 2; i++) {
		out[i] = calloc(CHANNELS * pixels, sizeof *out[i]);
		left[i] = calloc(pixels, sizeof *left[i]);
		v->level = i ? CPU_AVX512 : CPU_AVX2;
		CHECK(!render_values(v, values, CHANNELS, out[i], left[i], &e) &&
				!render_weights(v, &w[i], &e),
			"renders");
	}
	CHECK(!memcmp(out[0], out[1], CHANNELS * pixels * sizeof *out[0]), "values");
	CHECK(!memcmp(left[0], left[1], pixels * sizeof *left[0]), "transmittances");
	const int64_t n = w[0].indptr[pixels];
	CHECK(n > 1000 && n == w[1].indptr[pixels] &&
			!memcmp(w[0].weight, w[1].weight, (size_t)n * sizeof *w[0].weight),
		"weights");
	for (int i = 0; i < 2; i++) {
		free(out[i]);
		free(left[i]);
		render_weights_free(&w[i]);
	}
	render_free(v);
	free(values);
	splats_free(&s);
}

static void threads_do_not_matter(void)
{
	struct camera c = camera_at_origin(90, 70, 60);
	struct splats s = random_splats(8, 9000, 0.03, 0.8);
	size_t pixels = (size_t)c.width * (size_t)c.height;
	struct render_weights w[3];
	float *rgb[3], background[3] = {0, 0.5f, 1};
	struct err e;

	for (int i = 0; i < 3; i++) {
		omp_set_num_threads(i + 1);
		struct render_view *v = render_prepare(&s, &c, &e);
		rgb[i] = malloc(3 * pixels * sizeof(float));
		if (!v || render_weights(v, &w[i], &e) || render_colors(v, &s, &c, background, rgb[i], &e))
			abort();
		render_free(v);
	}
	for (int i = 1; i < 3; i++) {
		size_t nnz = (size_t)w[0].indptr[pixels];
		CHECK(!memcmp(w[0].indptr, w[i].indptr, (pixels + 1) * sizeof *w[0].indptr),
			"indptr, %d threads", i + 1);
		CHECK(!memcmp(w[0].index, w[i].index, nnz * sizeof *w[0].index), "index, %d threads", i + 1);
		CHECK(!memcmp(w[0].weight, w[i].weight, nnz * sizeof *w[0].weight), "weight, %d threads",
			i + 1);
		CHECK(!memcmp(rgb[0], rgb[i], 3 * pixels * sizeof(float)), "colours, %d threads", i + 1);
	}
	for (int i = 0; i < 3; i++) {
		render_weights_free(&w[i]);
		free(rgb[i]);
	}
	splats_free(&s);
}

/* One opaque Gaussian over a background, and the harmonics' signs: each first-order term against its axis. */
static void colors(void)
{
	struct camera c = camera_at_origin(9, 9, 9);
	struct splats s = make_splats(1);
	float rgb[9 * 9 * 3], background[3] = {1, 0, 0.25f}, color[3], sh[16 * 3] = {0};
	struct err e;

	set_splat(&s, 0, (double[3]){0, 0, 2}, (double[3]){0.2, 0.2, 0.2}, 1);
	struct render_view *v = render_prepare(&s, &c, &e);
	if (CHECK(v && !render_colors(v, &s, &c, background, rgb, &e), "renders"))
		for (int k = 0; k < 3; k++) {
			double want = 0.99 * (0.5 + 0.28209479177387814 * s.sh[k]) + 0.01 * background[k];
			double have = rgb[(4 * 9 + 4) * 3 + k];
			CHECK(fabs(have - want) < 1e-6, "channel %d is %g, not %g", k, have, want);
			CHECK(rgb[k] == background[k], "a corner shows the background");
		}
	render_free(v);
	splats_free(&s);
	sh[3 * 1] = sh[3 * 2 + 1] = sh[3 * 3 + 2] = 1;
	sh_color(sh, 4, (double[3]){0, 2, 0}, color);
	CHECK(fabs((double)color[0] - (0.5 - 0.4886025119)) < 1e-6 && color[1] == 0.5f, "y, negated");
	sh_color(sh, 4, (double[3]){0, 0, 2}, color);
	CHECK(fabs((double)color[1] - (0.5 + 0.4886025119)) < 1e-6, "z");
	sh_color(sh, 4, (double[3]){-3, 0, 0}, color);
	CHECK(fabs((double)color[2] - (0.5 + 0.4886025119)) < 1e-6, "x, negated");
}

/* The basis is orthonormal: the mean over the sphere of Y_a Y_b is 1/(4 pi) where a = b and else 0. */
static void harmonics_are_orthonormal(void)
{
	enum { RINGS = 40, STEPS = 80 };
	double product[16][16] = {{0}}, worst = 0;

	for (int i = 0; i < RINGS; i++)
		for (int j = 0; j < STEPS; j++) {
			/* midpoints in z and in angle: exact enough for polynomials of degree 6 */
			double z = -1 + 2 * (i + 0.5) / RINGS, turn = 2 * 3.14159265358979 * j / STEPS, y[16];
			double d[3] = {sqrt(1 - z * z) * cos(turn), sqrt(1 - z * z) * sin(turn), z};
			for (int k = 0; k < 16; k++) {
				float sh[48] = {0}, rgb[3];
				sh[3 * k] = 0.1f;
				sh_color(sh, 16, d, rgb);
				y[k] = ((double)rgb[0] - 0.5) / 0.1;
			}
			for (int a = 0; a < 16; a++)
				for (int b = 0; b < 16; b++)
					product[a][b] += y[a] * y[b] / (RINGS * STEPS) * 4 * 3.14159265358979;
		}
	for (int a = 0; a < 16; a++)
		for (int b = 0; b < 16; b++)
			worst = fmax(worst, fabs(product[a][b] - (a == b)));
	CHECK(worst < 0.01, "orthonormal but for %g", worst);
}

/* A trained scene, where one is at hand: REFER_SCENE=DIR, and REFER_STRIDE=n looks at every n-th pixel. */
static void trained_scene(void)
{
	const char *dir = getenv("REFER_SCENE"), *stride = getenv("REFER_STRIDE");
	struct scene scene;
	struct err e;

	if (!dir) {
		printf("skipped: comparison on a trained scene (set REFER_SCENE to a scene folder)\n");
		return;
	}
	if (!CHECK(!scene_read(&scene, dir, &e), "%s", e.message))
		return;
	for (int part = 3; part <= 6; part += 3) {
		const struct camera *full = &scene.cameras.views[scene.cameras.n / 3];
		int width, height;
		camera_scaled_size(full, 1.0 / part, &width, &height);
		struct camera c = camera_resize(full, width, height);
		struct render_report r =
			render_compare(&scene.splats, &c, cpu_level(), stride ? (size_t)atol(stride) : 37);
		printf("%s, 1/%d, %s: %ld pixels, %.1f weights each; largest weight error %.2g, |sum + T - 1| %.2g; %ld "
		       "pixels cut elsewhere, at most %.2g from a cut\n",
			full->name, part, level_names[cpu_level()], r.pixels, r.nnz / (double)r.pixels,
			r.weight, r.sum, r.cuts, r.cut_margin);
		CHECK(r.weight <= 1e-5, "a weight is off by %g", r.weight);
		CHECK(r.sum <= 1e-5, "weights and transmittance miss 1 by %g", r.sum);
		CHECK(r.cuts <= 1 + r.pixels / 500 && r.cut_margin < 1e-4, "%ld cuts, %g", r.cuts,
			r.cut_margin);
	}
	scene_free(&scene);
}

int main(void)
{
	random_scenes();
	odd_sizes();
	needles();
	zero_and_huge_scales();
	unnormalised_quaternions();
	camera_plane();
	far_from_the_origin();
	ties_break_by_index();
	close_depths();
	ten_thousand_layers();
	opacity_at_the_ends();
	one_and_none();
	values_are_the_product();
	if (cpu_level() >= CPU_AVX512)
		fused_levels_are_equal();
	threads_do_not_matter();
	colors();
	harmonics_are_orthonormal();
	trained_scene();
	return unit_end();
}
