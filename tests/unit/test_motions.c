/* Tracks of things whose way is known (places/track.h), and words of motion on them (places/motions.h):
 * whatever the scale, the place, the clock, the order of Gaussians, how many times are stored, what else is
 * there, and noise. */
#include "base/rng.h"
#include "geom/vector.h"
#include "places/motions.h"
#include "unit.h"

#include <math.h>

enum { N = 200, T = 40, O = 7 };

/* Where a cube of side 1 is, and its turn about the upright axis and about the first, at a part u of the
 * time. */
struct way {
	double at[3], turned, rolled;
};

static double softly(double u, double a, double b)
{
	const double x = fmin(fmax((u - a) / (b - a), 0), 1);

	return x * x * (3 - 2 * x);
}

/* 0 slides to the right from 0.25 to 0.5, 1 is lifted from 0.5 and put down until 0.9, 2 falls at 0.3, 3
 * spins from 0.6 on, 4 rolls away, all the time, 5 slides left, waits and goes on, and 6 rests. */
static struct way way_of(double u, int o)
{
	struct way w = {.at = {3 * o, 0, 0}};
	const double falls = fmin(fmax((u - 0.3) / 0.2, 0), 1);

	w.at[0] += o == 0 ? 2.5 * softly(u, 0.25, 0.5) : 0;
	w.at[2] += o == 1 ? 2 * (softly(u, 0.5, 0.65) - softly(u, 0.75, 0.9)) : 0;
	w.at[2] += o == 2 ? -4 * falls * falls : 0;
	w.turned = o == 3 ? 5 * softly(u, 0.6, 0.9) : 0;
	w.at[1] += o == 4 ? 6 * u : 0;
	w.rolled = o == 4 ? -12 * u : 0;
	w.at[0] -= o == 5 ? softly(u, 0.1, 0.3) + softly(u, 0.6, 0.8) : 0;
	return w;
}

struct setup {
	double scale, shift[3], clock[2], jitter, yaw;
	int times, is_irregular, is_still, is_reversed, strays, objects;
};

static const struct setup plain = {.scale = 1, .clock = {0, 1}, .times = T, .objects = O};

static struct tracks t;
static double at[1024], cloud[N][3];
static struct splats splats;
static struct extent extents[O];

static double time_at(const struct setup *s, int i)
{
	const double u = s->times > 1 ? (double)i / (s->times - 1) : 0;

	return s->is_irregular ? u * (0.6 + 0.4 * u) : u;
}

/* The first `strays` Gaussians of each thing stay where they were first. */
static void place(const struct setup *s, int o, double u, struct rng *r)
{
	const struct way moved = way_of(s->is_still ? 0 : u, o), first = way_of(0, o);
	double off[3];

	for (int d = 0; d < 3; d++)
		off[d] = s->jitter * (rng_uniform(r) + rng_uniform(r) + rng_uniform(r) - 1.5) * 2;
	for (int i = 0; i < N; i++) {
		const struct way *w = i < s->strays ? &first : &moved;
		const double *p = cloud[i], c = cos(w->rolled), n = sin(w->rolled), k = cos(w->turned),
			     m = sin(w->turned);
		const double q[3] = {p[0], c * p[1] - n * p[2], n * p[1] + c * p[2]};
		const double v[3] = {w->at[0] + k * q[0] - m * q[1] + off[0],
			w->at[1] + m * q[0] + k * q[1] + off[1], w->at[2] + q[2] + off[2]};
		const double x[3] = {cos(s->yaw) * v[0] - sin(s->yaw) * v[1],
			sin(s->yaw) * v[0] + cos(s->yaw) * v[1], v[2]};
		for (int d = 0; d < 3; d++)
			splats.means[3 * (o * N + i) + d] = (float)(s->scale * x[d] + s->shift[d]);
	}
}

static void set_extents(const struct setup *s)
{
	for (int o = 0; o < O; o++) {
		struct extent *x = &extents[o];
		x->n = N;
		x->ids = x->ids ? x->ids : malloc(N * sizeof *x->ids);
		x->weight = x->weight ? x->weight : malloc(N * sizeof *x->weight);
		for (int d = 0; d < 3; d++)
			x->turned.half[d] = s->scale / 2;
		for (int i = 0; i < N; i++) {
			x->ids[i] = o * N + (s->is_reversed ? N - 1 - i : i);
			x->weight[i] = 1;
		}
	}
	for (size_t i = 0; i < splats.n; i++) {
		splats.opacities[i] = 1;
		splats.scales[3 * i] = splats.scales[3 * i + 1] = splats.scales[3 * i + 2] = 0.01F;
	}
}

static void make(const struct setup *s)
{
	const double up[3] = {0, 0, 1};
	struct rng r;
	struct err e;

	tracks_free(&t);
	rng_seed(&r, 3, 0);
	for (int i = 0; i < N * 3; i++) /* point for point across the middle */
		cloud[i / 3][i % 3] = i < N * 3 / 2 ? rng_uniform(&r) - 0.5 : -cloud[i / 3 - N / 2][i % 3];
	set_extents(s);
	for (int i = 0; i < s->times; i++) {
		const double u = time_at(s, i);
		at[i] = s->clock[0] + s->clock[1] * u;
		for (int o = 0; o < O; o++)
			place(s, o, u, &r);
		if ((!i && tracks_begin(&t, (size_t)s->objects, extents, &splats, at, (size_t)s->times, NULL,
				   up, &e)) ||
			tracks_put(&t, (size_t)i, &splats, &e))
			exit(1);
	}
	if (tracks_end(&t, &e))
		exit(1);
}

/* The object that a kind fits, -1: none, -2: several. */
static int who(enum motion_kind kind, const struct setup *s, double *from, double *to)
{
	const struct motions m = {
		&t, {{cos(s->yaw), sin(s->yaw), 0}, {-sin(s->yaw), cos(s->yaw), 0}, {0, 0, 1}}, {0}};
	struct motions_span in[O];
	double fits[O], as[O];
	int found = -1;

	for (size_t o = 0; o < t.n; o++) {
		in[o] = (struct motions_span){0, t.times - 1};
		as[o] = 1;
		fits[o] = motions_judge(&m, kind < MOTION_FASTEST ? kind : MOTION_MOVES, o, -1, &in[o]);
	}
	if (kind >= MOTION_FASTEST)
		motions_rank(&m, kind, as, in, fits);
	for (size_t o = 0; o < t.n; o++)
		if (fits[o] >= 0.5) {
			found = found == -1 ? (int)o : -2;
			*from = (t.t[in[o].a] - s->clock[0]) / s->clock[1];
			*to = (t.t[in[o].b] - s->clock[0]) / s->clock[1];
		}
	return found;
}

static void check_words(const char *name, const struct setup *s)
{
	static const struct {
		enum motion_kind kind;
		int who;
		double from, to;
	} expected[] = {{MOTION_STILL, 6, 0, 1}, {MOTION_RIGHT, 0, 0.25, 0.5}, {MOTION_LEFT, 5, 0.1, 0.8},
		{MOTION_RAISED, 1, 0.5, 0.65}, {MOTION_LOWERED, 1, 0.75, 0.9}, {MOTION_FALLS, 2, 0.3, 0.5},
		{MOTION_TURNS, 3, 0.6, 0.9}, {MOTION_ROLLS, 4, 0, 1}, {MOTION_AWAY, 4, 0, 1},
		{MOTION_TOWARDS, -1, 0, 0}, {MOTION_SLIDES, -2, 0, 0}, {MOTION_STOPS, -2, 0, 0},
		{MOTION_FARTHEST, 4, 0, 1}, {MOTION_FASTEST, 2, 0.3, 0.5}};
	double from = 0, to = 0;

	make(s);
	for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
		const enum motion_kind kind = expected[i].kind;
		const int want = expected[i].who, found = who(kind, s, &from, &to);
		if (want >= s->objects)
			continue;
		CHECK(found == want, "%s, %s: object %d", name, motion_kind_name(kind), found);
		CHECK(found < 0 || (fabs(from - expected[i].from) < 0.06 && fabs(to - expected[i].to) < 0.06),
			"%s, %s: from %g to %g", name, motion_kind_name(kind), from, to);
	}
}

static void test_words(void)
{
	struct setup s = plain;

	check_words("plain", &s);
	s.scale = 1e-4;
	check_words("small", &s);
	s = (struct setup){.scale = 1,
		.shift = {4000, -9000, 0},
		.clock = {1e6, 25},
		.yaw = 2,
		.times = T,
		.objects = O};
	check_words("far off and turned, by another clock", &s);
	s = plain;
	s.is_irregular = 1;
	check_words("irregular times", &s);
	s = plain;
	s.jitter = 0.01;
	check_words("jitter", &s);
	s = plain;
	s.times = 2 * T;
	check_words("twice the times", &s);
	s.times = 20 * T;
	check_words("many times", &s);
	s = plain;
	s.strays = N / 4;
	check_words("a quarter of something else", &s);
	s = plain;
	s.objects = O - 1;
	check_words("nothing that rests", &s);
}

/* Position and turn against the way itself; and the same bytes in any order of Gaussians but for rounding. */
static void test_tracks(void)
{
	struct setup s = plain;

	for (s.is_reversed = 0; s.is_reversed < 2; s.is_reversed++) {
		make(&s);
		for (int o = 0; o < O; o++)
			for (int i = 0; i < T; i++) {
				const struct way w = way_of(time_at(&s, i), o), first = way_of(0, o);
				const struct track *k = &t.of[o];
				double off = 0;
				for (int d = 0; d < 3; d++)
					off = fmax(
						off, fabs(k->at[i][d] - k->at[0][d] - w.at[d] + first.at[d]));
				CHECK(off < 1e-3, "object %d, time %d: off by %g", o, i, off);
				CHECK(fabs(k->turn[i][0][0] - cos(w.turned)) < 1e-3 &&
						fabs(k->turn[i][2][2] - cos(w.rolled)) < 1e-3,
					"object %d, time %d: turned wrongly", o, i);
			}
	}
}

static size_t moving(void)
{
	size_t n = 0;

	for (size_t o = 0; o < t.n; o++)
		n += t.of[o].moves > 0;
	return n;
}

static void test_few(void)
{
	struct setup s = plain;

	s.times = 1;
	make(&s);
	CHECK(moving() == 0, "one time: %zu move", moving());
	s.times = 2;
	make(&s);
	CHECK(t.of[0].moves == 1 && t.of[2].moves == 1 && !t.of[6].moves, "two times");
	s = plain;
	s.is_still = 1;
	for (int k = 0; k < 5; k++) {
		s.jitter = 0.0025 * k;
		make(&s);
		CHECK(moving() == 0, "jitter of %g of the size: %zu move", s.jitter, moving());
	}
}

int main(void)
{
	struct err e;

	if (splats_alloc(&splats, N * O, 1, &e))
		return 1;
	test_words();
	test_tracks();
	test_few();
	for (int o = 0; o < O; o++)
		extent_free(&extents[o]);
	tracks_free(&t);
	splats_free(&splats);
	return unit_end();
}
