/* The rasteriser's hard cases (design section 5): blend weights against tests/unit/render_twin.h, at every
 * instruction set that the machine has. */
#include "stability.h"

#include "tests/unit/render_compare.h"

#include "base/rng.h"
#include "splat/render.h"

#include <math.h>

/* As many pixels as make a comparison quick, whatever the view's size. */
enum { LOOKED_AT = 4000 };

/* The worst weight of all levels. A list that differs, though no cut is within rounding, is no rounding
 * error: NaN. */
static void view_row(const char *name, const struct splats *s, const struct camera *c, const char *does)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	const size_t stride = pixels > LOOKED_AT ? pixels / LOOKED_AT | 1 : 1;
	double worst = 0, weights = 0;
	long looked = 0, cuts = 0;

	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++) {
		const struct render_report r = render_compare(s, c, level, stride);
		worst = fmax(worst, fmax(r.weight, r.sum));
		if (!r.pixels || r.cut_margin >= 1e-4)
			worst = NAN;
		looked = r.pixels;
		weights = r.nnz;
		cuts = r.cuts > cuts ? r.cuts : cuts;
	}
	const char *of_cuts = cuts ? compared(", of %ld pixels but for one Gaussian at a cut", cuts) : "";
	row(name, compared("%.0f weights, %ld pixels%s", weights, looked, of_cuts), worst, 1e-5, does);
}

static void scales_case(void)
{
	struct camera c = camera_at_origin(40, 24, 30);
	struct splats s = odd_scale_splats();

	view_row("scales of 0 and of 1e30", &s, &c, "blends");
	splats_free(&s);
	s = random_splats(11, 400, 1, 0.1);
	for (size_t i = 0; i < 3 * s.n; i++)
		s.scales[i] = (float)exp(i / 3 % 2 ? -30 : 10);
	view_row("scales e^-30 and e^10", &s, &c,
		"blends: the small ones at the low-pass's size, the large ones everywhere");
	splats_free(&s);
}

/* The scene at `far` from the origin, `size` large, with the camera there. */
static void coordinates_case(const char *name, float far, float size, const char *does)
{
	struct camera c = camera_at_origin(40, 40, 30);
	struct splats s = random_splats(5, 400, 0.3, 0.5);

	for (size_t i = 0; i < 3 * s.n; i++) {
		s.means[i] = s.means[i] * size + far;
		s.scales[i] *= size > 1 ? 1 : size;
	}
	for (int k = 0; k < 3; k++)
		c.world_to_camera[k][3] = -(double)far;
	if (size < 1) /* all in front of the near plane, at the origin */
		c.world_to_camera[2][3] = 1;
	view_row(name, &s, &c, does);
	splats_free(&s);
}

static void depth_cases(int is_quick)
{
	struct camera c = camera_at_origin(8, 8, 8);
	struct splats s = make_splats(300);

	for (size_t i = 0; i < s.n; i++)
		set_splat(&s, i, (double[3]){0, 0, 1 + (double)(i * 7 % 3)}, (double[3]){9, 9, 9}, 0.01);
	view_row("depth ties", &s, &c, "the lower index is in front");
	splats_free(&s);
	s = close_splats(&c);
	view_row("depths that differ in the last bits", &s, &c, "sorts exactly");
	splats_free(&s);
	c = camera_at_origin(5, 5, 5);
	s = layer_splats(10000);
	view_row("10,000 layers", &s, &c, "a pixel ends where less than 1e-4 is left");
	splats_free(&s);
	if (is_quick)
		return;
	c = camera_at_origin(1, 1, 5);
	s = layer_splats(1000000);
	view_row("a million Gaussians in a pixel", &s, &c, "a pixel ends where less than 1e-4 is left");
	for (size_t i = 0; i < s.n; i++)
		s.opacities[i] = 1 / 254.9f;
	view_row("the same at the least opacity", &s, &c, "a pixel ends where less than 1e-4 is left");
	splats_free(&s);
}

static void plane_case(void)
{
	static const double depths[] = {-5, -1e-3, 0, 1e-30, 0.1, 0.2, 0.2000001, 0.25, 1};
	const size_t n = sizeof depths / sizeof depths[0];
	struct camera c = camera_at_origin(33, 33, 30);
	struct splats s = make_splats(n);

	for (size_t i = 0; i < n; i++)
		set_splat(
			&s, i, (double[3]){0.01 * (double)i, 0, depths[i]}, (double[3]){0.5, 0.01, 0.5}, 0.3);
	view_row("Gaussians on and behind the camera plane", &s, &c, "leaves out z <= 0.2");
	splats_free(&s);
}

static void few_cases(void)
{
	struct camera c = camera_at_origin(21, 13, 20);
	struct splats s = make_splats(4), none = make_splats(0);

	set_splat(&s, 0, (double[3]){0, 0, 1}, (double[3]){1, 1, 1}, 0);
	set_splat(&s, 1, (double[3]){0, 0, 2}, (double[3]){1, 1, 1}, 1);
	set_splat(&s, 2, (double[3]){0, 0, 3}, (double[3]){1, 1, 1}, 1 / 256.0);
	set_splat(&s, 3, (double[3]){0, 0, 4}, (double[3]){1e3, 1e3, 1e3}, 1);
	view_row("opacity 0 and 1", &s, &c, "cuts a at 0.99, skips a below 1/255");
	s.n = 1;
	s.opacities[0] = 0.8f;
	view_row("one Gaussian", &s, &c, "blends");
	s.means[2] = -1;
	view_row("a view that sees nothing", &s, &c, "an empty image");
	view_row("no Gaussian", &none, &c, "an empty image");
	splats_free(&s);
	splats_free(&none);
}

static void size_cases(int is_quick)
{
	struct splats s = random_splats(9, 60, 0.03, 0.5);
	struct camera c = camera_at_origin(1, 1, 1);

	view_row("a view of 1x1", &s, &c, "blends");
	c = camera_at_origin(8192, 8192, 8000);
	if (!is_quick)
		view_row("a view of 8192x8192", &s, &c, "blends");
	splats_free(&s);
}

void splat_cases(int is_quick)
{
	struct camera c = camera_at_origin(67, 45, 40);
	struct splats s = random_splats(1, 1500, 0.05, 1);

	view_row("an ordinary scene", &s, &c, "blends");
	splats_free(&s);
	c = camera_at_origin(50, 50, 40);
	s = needle_splats();
	view_row("needles of aspect 1e6", &s, &c, "blends");
	splats_free(&s);
	scales_case();
	s = random_splats(4, 200, 0.1, 1);
	for (size_t i = 0; i < 4 * s.n; i++)
		s.quats[i] *= i / 4 % 2 ? 1e-17f : 1e17f;
	view_row("quaternions of length 1e-17 and 1e17", &s, &c, "normalises them");
	splats_free(&s);
	plane_case();
	coordinates_case("coordinates near 1e6", 1e6f, 4, "blends; `gs-import` recentres such scenes");
	coordinates_case("coordinates near 1e-6", 0, 1e-6f, "blends");
	depth_cases(is_quick);
	few_cases();
	size_cases(is_quick);
}
