/* What made surfaces look like (places/object_surface.h). */
#include "places/object_surface.h"
#include "lang/finish.h"
#include "unit.h"

#include <math.h>

enum { N = 1500 };
enum paint { ONE, SHADED, STRIPED, SPOTTED, CAPPED, HALVED };
enum shape { BALL, CAN, PLATE };

static const double pi = 3.14159265358979323846;
static const double red[3] = {45, 55, 35}, white[3] = {90, 0, 2};
static const double upright[3] = {0, 0, 1};

static unsigned state;

static double random_share(void)
{
	state = state * 1664525u + 1013904223u;
	return (state >> 8) / (double)(1 << 24);
}

/* A point of a shape 2 wide, its middle at the origin. */
static void put(enum shape shape, double at[3])
{
	const double turn = 2 * pi * random_share(), z = 2 * random_share() - 1,
		     r = shape == BALL	  ? sqrt(1 - z * z)
			 : shape == PLATE ? sqrt(random_share())
					  : 1;

	at[0] = r * cos(turn);
	at[1] = r * sin(turn);
	at[2] = shape == PLATE ? 0.02 * z : z;
}

enum { SPOTS = 60 };
static double spots[SPOTS][3];

static void make_spots(enum shape shape)
{
	for (int i = 0; i < SPOTS; i++)
		put(shape, spots[i]);
}

static int is_in_spot(const double at[3])
{
	for (int i = 0; i < SPOTS; i++) {
		const double x = at[0] - spots[i][0], y = at[1] - spots[i][1], z = at[2] - spots[i][2];
		if (x * x + y * y + z * z < 0.15 * 0.15)
			return 1;
	}
	return 0;
}

/* Stripes go up a thing, and across a plate at an odd angle. */
static int is_white(enum paint paint, enum shape shape, const double at[3])
{
	const double way = shape == PLATE ? 0.9 * at[0] + 0.436 * at[1] : at[2];

	switch (paint) {
	case STRIPED:
		return fmod(way + 5, 0.5) > 0.3;
	case SPOTTED:
		return is_in_spot(at);
	case CAPPED:
		return at[2] > 0.75;
	case HALVED:
		return at[0] > 0;
	default:
		return 0;
	}
}

static void make(struct surface_point *p, enum shape shape, enum paint paint)
{
	state = 7;
	make_spots(shape);
	for (int i = 0; i < N; i++) {
		put(shape, p[i].at);
		const double *colour = is_white(paint, shape, p[i].at) ? white : red;
		const double light =
			(paint == ONE ? 1 : 1 + 0.25 * p[i].at[0]) * (1 + 0.04 * (random_share() - 0.5));
		for (int k = 0; k < 3; k++)
			p[i].lab[k] = light * colour[k];
		p[i].weight = 1 + random_share();
	}
}

static struct surface find(const struct surface_point *p, size_t n, const double up[3])
{
	struct surface s = {0};
	struct err e;

	CHECK(!surface_find(&s, p, n, up, &e), "found");
	CHECK(s.stripes >= 0 && s.spots >= 0 && s.stripes + s.spots <= 1, "%g and %g", s.stripes, s.spots);
	return s;
}

static struct surface look(enum shape shape, enum paint paint)
{
	static struct surface_point p[N];

	make(p, shape, paint);
	return find(p, N, upright);
}

static void shapes(void)
{
	static const char *const names[] = {"ball", "can", "plate"};

	for (enum shape shape = BALL; shape <= PLATE; shape++) {
		const struct surface one = look(shape, ONE), shaded = look(shape, SHADED),
				     striped = look(shape, STRIPED), spotted = look(shape, SPOTTED),
				     halved = look(shape, HALVED);
		CHECK(one.stripes + one.spots < 0.2, "a %s: %g %g", names[shape], one.stripes, one.spots);
		CHECK(shaded.stripes + shaded.spots < 0.2, "light and shade on a %s: %g %g", names[shape],
			shaded.stripes, shaded.spots);
		CHECK(striped.stripes > 0.6, "a striped %s: %g %g", names[shape], striped.stripes,
			striped.spots);
		CHECK(spotted.spots > 0.5, "a spotted %s: %g %g", names[shape], spotted.stripes,
			spotted.spots);
		CHECK(halved.stripes + halved.spots < 0.5, "two halves of a %s: %g %g", names[shape],
			halved.stripes, halved.spots);
		CHECK(surface_fits(&striped, FINISH_STRIPES) > 0.3 &&
				surface_fits(&striped, FINISH_PLAIN) < -0.5 &&
				surface_fits(&one, FINISH_PLAIN) > 0.5 &&
				surface_fits(&one, FINISH_STRIPES) < -0.5 &&
				surface_fits(&one, FINISH_SPOTS) < -0.5 && surface_fits(&one, -1) == 0,
			"words of a %s", names[shape]);
	}
	const struct surface capped = look(CAN, CAPPED);
	CHECK(capped.stripes + capped.spots < 0.3, "a cap: %g %g", capped.stripes, capped.spots);
}

static int is_near(const struct surface *a, const struct surface *b)
{
	return fabs(a->stripes - b->stripes) < 1e-6 && fabs(a->spots - b->spots) < 1e-6;
}

/* Nothing depends on the order of the Gaussians, on what their weights are measured in, nor on where the
 * scene's origin is and how long its unit. */
static void invariances(void)
{
	static struct surface_point p[N], q[N];

	for (enum paint paint = STRIPED; paint <= SPOTTED; paint++) {
		make(p, CAN, paint);
		const struct surface before = find(p, N, upright);
		for (int i = 0; i < N; i++) {
			q[i] = p[N - 1 - i];
			q[i].weight *= 37;
		}
		const struct surface after = find(q, N, upright);
		CHECK(is_near(&before, &after), "another order: %g %g, %g %g", before.stripes, before.spots,
			after.stripes, after.spots);
		memcpy(q, p, sizeof q);
		for (int i = 0; i < N; i++)
			for (int k = 0; k < 3; k++)
				q[i].at[k] = 1000 * (p[i].at[k] + 5 * k);
		const struct surface far = find(q, N, upright);
		CHECK(is_near(&before, &far), "far away: %g %g, %g %g", before.stripes, before.spots,
			far.stripes, far.spots);
		for (int i = 0; i < N; i++)
			for (int k = 0; k < 3; k++)
				q[i].at[k] = p[i].at[(k + 1) % 3];
		const struct surface lying = find(q, N, (const double[3]){0, 1, 0});
		CHECK(fabs(before.stripes - lying.stripes) < 0.1, "another axis is up: %g, %g",
			before.stripes, lying.stripes);
	}
}

static void few(void)
{
	struct surface_point p[3] = {
		{{0, 0, 0}, {50, 0, 0}, 1}, {{0, 0, 0}, {50, 0, 0}, 1}, {{1, 0, 0}, {90, 0, 0}, 1}};

	for (size_t n = 0; n <= 3; n++) {
		const struct surface s = find(p, n, upright);
		for (int k = 0; k < FINISHES; k++)
			CHECK(fabs(surface_fits(&s, k)) < 0.1, "%zu points say nothing: %g", n,
				surface_fits(&s, k));
	}
}

static void gloss(void)
{
	struct surface s[3] = {{.view_dependence = 0.06}, {.view_dependence = 0.3}, {.view_dependence = 0}};

	for (int i = 0; i < 3; i++)
		surface_set_gloss(&s[i], 0.06, 0.3);
	CHECK(surface_fits(&s[1], FINISH_SHINY) == 1 && surface_fits(&s[0], FINISH_SHINY) == -1 &&
			surface_fits(&s[0], FINISH_DULL) == 1,
		"shiny beside the other");
	CHECK(surface_fits(&s[2], FINISH_SHINY) == 0, "without spherical harmonics");
	surface_set_gloss(&s[0], 0.06, 0.06);
	CHECK(surface_fits(&s[0], FINISH_SHINY) == 0, "all shine as much");
	surface_set_gloss(&s[0], 0.06, 0.07);
	CHECK(fabs(surface_fits(&s[0], FINISH_SHINY)) < 0.15, "or nearly");
}

int main(void)
{
	shapes();
	invariances();
	few();
	gloss();
	return unit_end();
}
