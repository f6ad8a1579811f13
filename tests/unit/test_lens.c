/* Lenses against formulae written out for each model as COLMAP's documentation has them
 * (src/colmap/sensor/models.h), against what COLMAP 3.8 computes, and against themselves. */
#include "unit.h"

#include "geom/lens.h"
#include "mask/mask.h"

#include <stdint.h>

struct row {
	const char *name;
	int width, height;
	double parameters[16];
	int pinhole[2]; /* size that `colmap image_undistorter` 3.8 gives the pinhole; 0 where it does not
			   know the model */
	double centre[2];
};

/* The first ten are of the file that tests/format/lens.bats gives to COLMAP where it is installed. */
static const struct row rows[] = {
	{"SIMPLE_RADIAL", 160, 120, {150, 80, 60, -0.15}, {166, 122}, {83, 61}},
	{"RADIAL", 160, 120, {150, 81, 58, 0.1, -0.03}, {153, 114}, {77.45625, 55.1}},
	{"OPENCV", 160, 120, {150, 152, 79, 61, -0.2, 0.05, 0.003, -0.002}, {167, 123}, {82.45625, 62.525}},
	{"OPENCV_FISHEYE", 160, 120, {110, 112, 80, 60, 0.05, -0.02, 0.004, -0.001}, {188, 129}, {94, 64.5}},
	{"FULL_OPENCV", 160, 120, {150, 151, 80, 60, 0.3, 0.1, 0.002, -0.001, 0.02, 0.4, 0.05, 0.01},
		{162, 120}, {81, 60}},
	{"FOV", 160, 120, {120, 121, 80, 60, 0.8}, {166, 118}, {83, 59}},
	{"SIMPLE_RADIAL_FISHEYE", 160, 120, {110, 80, 60, 0.05}, {187, 129}, {93.5, 64.5}},
	{"RADIAL_FISHEYE", 160, 120, {110, 80, 60, 0.05, -0.01}, {187, 130}, {93.5, 65}},
	{"THIN_PRISM_FISHEYE", 160, 120,
		{110, 111, 80, 60, 0.05, -0.02, 0.001, 0.002, 0.003, -0.001, 0.001, 0.002}, {188, 130},
		{94, 65}},
	{"SIMPLE_RADIAL", 160, 120, {150, 80, 60, 0.2}, {147, 110}, {73.5, 55}},
	{"RAD_TAN_THIN_PRISM_FISHEYE", 160, 120,
		{110, 111, 80, 60, 0.05, -0.02, 0.004, -0.001, 0.0002, 0.0001, 0.001, 0.002, 0.001, -0.0005,
			0.0015, 0.0003},
		{0}, {0}},
	{"SIMPLE_DIVISION", 160, 120, {150, 80, 60, -0.2}, {0}, {0}},
	{"DIVISION", 160, 120, {150, 152, 80, 60, 0.1}, {0}, {0}},
	{"SIMPLE_FISHEYE", 160, 120, {110, 80, 60}, {0}, {0}},
	{"FISHEYE", 160, 120, {110, 112, 79, 61}, {0}, {0}},
	{"EUCM", 160, 120, {110, 112, 79, 61, 0.6, 1.1}, {0}, {0}},
};
enum { ROWS = sizeof rows / sizeof *rows };

static struct lens make(const struct row *r)
{
	struct lens l = {
		.model = lens_model_named(r->name, strlen(r->name)), .width = r->width, .height = r->height};

	memcpy(l.parameters, r->parameters, sizeof l.parameters);
	return l;
}

static int is(const struct row *r, const char *name)
{
	return !strcmp(r->name, name);
}

/* The twin: x, y of the ray (u, v, 1) in pixels, each model by itself. */
static void twin(const struct row *row, double u, double v, double *x, double *y)
{
	const double *p = row->parameters, r = hypot(u, v), theta = atan(r), r2 = r * r, r4 = r2 * r2,
		     r6 = r4 * r2;
	const double t2 = theta * theta, t4 = t2 * t2, t6 = t4 * t2, t8 = t4 * t4;
	const double a = r > 0 ? u * theta / r : u, b = r > 0 ? v * theta / r : v; /* fisheye */

	if (is(row, "SIMPLE_RADIAL")) {
		*x = p[0] * u * (1 + p[3] * r2) + p[1];
		*y = p[0] * v * (1 + p[3] * r2) + p[2];
	} else if (is(row, "RADIAL")) {
		*x = p[0] * u * (1 + p[3] * r2 + p[4] * r4) + p[1];
		*y = p[0] * v * (1 + p[3] * r2 + p[4] * r4) + p[2];
	} else if (is(row, "OPENCV")) {
		*x = p[0] * (u * (1 + p[4] * r2 + p[5] * r4) + 2 * p[6] * u * v + p[7] * (r2 + 2 * u * u)) +
		     p[2];
		*y = p[1] * (v * (1 + p[4] * r2 + p[5] * r4) + 2 * p[7] * u * v + p[6] * (r2 + 2 * v * v)) +
		     p[3];
	} else if (is(row, "OPENCV_FISHEYE")) {
		const double d = 1 + p[4] * t2 + p[5] * t4 + p[6] * t6 + p[7] * t8;
		*x = p[0] * a * d + p[2];
		*y = p[1] * b * d + p[3];
	} else if (is(row, "FULL_OPENCV")) {
		const double d =
			(1 + p[4] * r2 + p[5] * r4 + p[8] * r6) / (1 + p[9] * r2 + p[10] * r4 + p[11] * r6);
		*x = p[0] * (u * d + 2 * p[6] * u * v + p[7] * (r2 + 2 * u * u)) + p[2];
		*y = p[1] * (v * d + 2 * p[7] * u * v + p[6] * (r2 + 2 * v * v)) + p[3];
	} else if (is(row, "FOV")) {
		const double d = r > 0 ? atan(2 * r * tan(p[4] / 2)) / p[4] / r : 2 * tan(p[4] / 2) / p[4];
		*x = p[0] * u * d + p[2];
		*y = p[1] * v * d + p[3];
	} else if (is(row, "SIMPLE_RADIAL_FISHEYE")) {
		*x = p[0] * a * (1 + p[3] * t2) + p[1];
		*y = p[0] * b * (1 + p[3] * t2) + p[2];
	} else if (is(row, "RADIAL_FISHEYE")) {
		*x = p[0] * a * (1 + p[3] * t2 + p[4] * t4) + p[1];
		*y = p[0] * b * (1 + p[3] * t2 + p[4] * t4) + p[2];
	} else if (is(row, "THIN_PRISM_FISHEYE")) {
		const double d = 1 + p[4] * t2 + p[5] * t4 + p[8] * t6 + p[9] * t8;
		*x = p[0] * (a * d + 2 * p[6] * a * b + p[7] * (t2 + 2 * a * a) + p[10] * t2) + p[2];
		*y = p[1] * (b * d + 2 * p[7] * a * b + p[6] * (t2 + 2 * b * b) + p[11] * t2) + p[3];
	} else if (is(row, "RAD_TAN_THIN_PRISM_FISHEYE")) {
		const double d =
			1 + p[4] * t2 + p[5] * t4 + p[6] * t6 + p[7] * t8 + p[8] * t8 * t2 + p[9] * t8 * t4;
		const double m = a * d, n = b * d, q = m * m + n * n;
		*x = p[0] * (m + p[10] * (2 * m * m + q) + 2 * p[11] * m * n + p[12] * q + p[13] * q * q) +
		     p[2];
		*y = p[1] * (n + p[11] * (2 * n * n + q) + 2 * p[10] * m * n + p[14] * q + p[15] * q * q) +
		     p[3];
	} else if (is(row, "SIMPLE_DIVISION") || is(row, "DIVISION")) {
		/* the root of rho k d^2 - d + rho = 0 that is rho where k is 0 */
		const int two = is(row, "DIVISION");
		const double k = p[3 + two], d = r > 0 ? (1 - sqrt(1 - 4 * k * r2)) / (2 * k * r2) : 1;
		*x = p[0] * u * d + p[1 + two];
		*y = p[two] * v * d + p[2 + two];
	} else if (is(row, "SIMPLE_FISHEYE") || is(row, "FISHEYE")) {
		const int two = is(row, "FISHEYE");
		*x = p[0] * a + p[1 + two];
		*y = p[two] * b + p[2 + two];
	} else {
		const double depth = p[4] * sqrt(p[5] * r2 + 1) + (1 - p[4]);
		*x = p[0] * u / depth + p[2];
		*y = p[1] * v / depth + p[3];
	}
}

/* Rays up to 40 degrees off the axis: the formula, and back. */
static void formulae(void)
{
	for (int i = 0; i < ROWS; i++) {
		const struct lens l = make(&rows[i]);
		double worst = 0, back = 0;
		for (int k = 0; k < 400; k++) {
			const double angle = 0.7 * (k / 400.0), turn = 2.4 * k;
			const double ray[2] = {tan(angle) * cos(turn), tan(angle) * sin(turn)};
			double pixel[2], x, y, again[2];
			twin(&rows[i], ray[0], ray[1], &x, &y);
			if (!CHECK(!lens_project(&l, ray, pixel), "%s: no pixel of a ray at %g", rows[i].name,
				    angle) ||
				!CHECK(!lens_unproject(&l, pixel, again), "%s: no ray of a pixel",
					rows[i].name))
				break;
			worst = fmax(worst, hypot(pixel[0] - x, pixel[1] - y));
			back = fmax(back, hypot(again[0] - ray[0], again[1] - ray[1]));
		}
		CHECK(worst < 1e-10, "%s: off by %g pixels", rows[i].name, worst);
		CHECK(back < 1e-9, "%s: comes back off by %g", rows[i].name, back);
	}
}

/* Every pixel of the photograph, corners included: to a ray and back. */
static void round_trip(void)
{
	for (int i = 0; i < ROWS; i++) {
		const struct lens l = make(&rows[i]);
		double worst = 0;
		for (int y = 0; y < l.height; y++)
			for (int x = 0; x < l.width; x++) {
				const double pixel[2] = {x + 0.5, y + 0.5};
				double ray[2], again[2];
				if (lens_unproject(&l, pixel, ray) || lens_project(&l, ray, again))
					worst = INFINITY;
				else
					worst = fmax(worst, hypot(again[0] - pixel[0], again[1] - pixel[1]));
			}
		CHECK(worst < 1e-9, "%s: a pixel comes back off by %g", rows[i].name, worst);
	}
}

static void pinholes(void)
{
	for (int i = 0; i < ROWS; i++) {
		const struct lens l = make(&rows[i]);
		struct camera c = {0};
		lens_pinhole(&l, &c);
		CHECK(!rows[i].pinhole[0] ||
				(c.width == rows[i].pinhole[0] && c.height == rows[i].pinhole[1] &&
					fabs(c.cx - rows[i].centre[0]) < 1e-9 &&
					fabs(c.cy - rows[i].centre[1]) < 1e-9),
			"%s: %dx%d, centre %g %g", rows[i].name, c.width, c.height, c.cx, c.cy);
		CHECK(c.fx == l.parameters[0] && c.fy == l.parameters[lens_model_focals(l.model) - 1],
			"%s: focal lengths", rows[i].name);
	}
}

/* A disc of the pinhole's world: 1 where the ray meets it. */
static int disc(double u, double v)
{
	return hypot(u - 0.15, v + 0.05) < 0.22;
}

/* A mask drawn in the photograph, by the twin's formula inverted by search, is in the view what is drawn
 * there; and so back. */
static void masks(void)
{
	for (int i = 0; i < ROWS; i++) {
		struct row large = rows[i];
		const int focals = lens_model_focals(lens_model_named(large.name, strlen(large.name)));
		large.width *= 4;
		large.height *= 4;
		for (int k = 0; k < focals + 2; k++)
			large.parameters[k] *= 4;
		const struct lens l = make(&large);
		struct camera c = {0};
		lens_pinhole(&l, &c);
		const size_t pixels = (size_t)c.width * (size_t)c.height,
			     all = (size_t)l.width * (size_t)l.height;
		int32_t *map = malloc((pixels > all ? pixels : all) * sizeof *map);
		uint8_t *photograph = calloc(all, 1), *view = calloc(pixels, 1);
		/* The photograph's pixels are covered densely by rays through the disc, each where the twin
		 * has it. */
		for (int y = 0; y < 1200; y++)
			for (int x = 0; x < 1200; x++) {
				const double u = -0.1 + x / 2400.0, v = -0.3 + y / 2400.0;
				double px, py;
				twin(&large, u, v, &px, &py);
				if (disc(u, v) && px >= 0 && px < l.width && py >= 0 && py < l.height)
					photograph[(size_t)py * (size_t)l.width + (size_t)px] = 1;
			}
		size_t both = 0, either = 0;
		lens_map(&l, &c, 0, l.height, l.width, map);
		for (size_t p = 0; p < pixels; p++) {
			const int drawn = disc(((double)(p % (size_t)c.width) + 0.5 - c.cx) / c.fx,
				((double)(p / (size_t)c.width) + 0.5 - c.cy) / c.fy);
			view[p] = map[p] >= 0 && photograph[map[p]];
			both += drawn && view[p];
			either += drawn || view[p];
		}
		CHECK((double)both / (double)either > 0.97, "%s: IoU %g in the view", rows[i].name,
			(double)both / (double)either);
		both = either = 0;
		lens_map(&l, &c, 1, c.height, c.width, map);
		for (size_t p = 0; p < all; p++) {
			const int now = map[p] >= 0 && view[map[p]];
			both += now && photograph[p];
			either += map[p] >= 0 && (now || photograph[p]);
		}
		CHECK((double)both / (double)either > 0.97, "%s: IoU %g in the photograph", rows[i].name,
			(double)both / (double)either);
		free(map);
		free(photograph);
		free(view);
	}
}

static void edges(void)
{
	struct lens l = {.model = lens_model_named("SIMPLE_RADIAL", 13),
		.width = 100,
		.height = 100,
		.parameters = {100, 50, 50, -1}};
	double out[2];

	/* r - r^3 grows as far as 0.577, to 0.385: no ray is seen beyond, and no pixel shows one */
	CHECK(!lens_project(&l, (double[]){0.57, 0}, out), "the last ray");
	CHECK(lens_project(&l, (double[]){0.6, 0}, out), "a ray behind the fold has a pixel");
	CHECK(lens_project(&l, (double[]){1.2, 0}, out), "a ray on the other side has a pixel");
	CHECK(!lens_unproject(&l, (double[]){50 + 38.4, 50}, out) && fabs(out[0] - 0.55440037) < 1e-8, "%g",
		out[0]);
	CHECK(lens_unproject(&l, (double[]){50 + 39, 50}, out), "a pixel that shows nothing has a ray");
	CHECK(!lens_unproject(&l, (double[]){50, 50}, out) && out[0] == 0 && out[1] == 0, "the axis");
	/* no more than half a turn */
	l = (struct lens){.model = lens_model_named("SIMPLE_FISHEYE", 14),
		.width = 400,
		.height = 400,
		.parameters = {100, 200, 200}};
	CHECK(!lens_unproject(&l, (double[]){200 + 157, 200}, out), "just in front");
	CHECK(lens_unproject(&l, (double[]){200 + 158, 200}, out), "a ray behind the camera");
	struct camera c = {0};
	lens_pinhole(&l, &c);
	CHECK(c.width == 800 && c.height == 800 && c.cx == 400, "a whole fisheye: %dx%d", c.width, c.height);
	/* zeros are pinholes, but for fisheyes */
	l = (struct lens){.model = lens_model_named("OPENCV", 6), .parameters = {1, 1}};
	CHECK(!lens_is_distorted(&l), "zeros distort");
	l.model = lens_model_named("OPENCV_FISHEYE", 14);
	CHECK(lens_is_distorted(&l), "a fisheye does not distort");
	l.model = lens_model_named("EUCM", 4);
	l.parameters[5] = 1;
	CHECK(!lens_is_distorted(&l), "EUCM of alpha 0 distorts");
	CHECK(!lens_model_numbered(17) && lens_model_numbered(0) == lens_model_named("SIMPLE_PINHOLE", 14) &&
			!lens_model_named("PINHOL", 6) && !lens_model_named("", 0),
		"models");
}

int main(void)
{
	formulae();
	round_trip();
	pinholes();
	masks();
	edges();
	return unit_end();
}
