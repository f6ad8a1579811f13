/* Relations between objects, on a made-up table, and where lifted objects are. */
#include "places/arrangement.h"
#include "places/relate.h"
#include "lang/wordnet.h"
#include "unit.h"

#include <string.h>

enum { LEFT, RIGHT, FRONT, BACK, TRAY, CUP, TALL, OBJECTS };

static struct arranged objects[OBJECTS];
static struct arrangement table = {
	.n = OBJECTS, .objects = objects, .viewer = {.is_there = 1, .centre = {0, -10, 5}}, .spacing = 4};

static void put(int o, double x, double y, double z, double width, double height)
{
	const double centre[3] = {x, y, z + height / 2}, half[3] = {width / 2, width / 2, height / 2};

	objects[o] = (struct arranged){.is_there = 1, .in_sight = 1, .side = x};
	for (int k = 0; k < 3; k++) {
		objects[o].centre[k] = centre[k];
		objects[o].low[k] = centre[k] - half[k];
		objects[o].high[k] = centre[k] + half[k];
	}
}

/* A cup on a tray in the middle, things around it. */
static void lay_table(void)
{
	put(LEFT, -4, 0, 0, 1, 1);
	put(RIGHT, 4, 0.2, 0, 1, 1);
	put(FRONT, 0.2, -3.5, 0, 1, 1);
	put(BACK, 0.2, 4, 0, 1.2, 1);
	put(TRAY, 0, 0, 0, 2, 0.1);
	put(CUP, 0, 0, 0.1, 0.8, 1.1);
	put(TALL, 2, 3, 0, 1, 3);
}

static double out[OBJECTS], key[3 * OBJECTS], fit[OBJECTS];

enum { NONE = -1, VIEWER = OBJECTS };

/* The relation to at most two anchors; out has all. */
static int winner(enum parse_relation kind, enum parse_degree degree, int first, int second)
{
	double p[2][OBJECTS + 1] = {{0}};
	const struct relate_anchor anchors[] = {{.p = p[0]}, {.p = p[1]}};
	const struct relation r = {kind, degree, RELATE_NARROW, 0, (first >= 0) + (second >= 0), anchors};
	int best = 0;

	if (first >= 0)
		p[0][first] = 1;
	if (second >= 0)
		p[1][second] = 1;
	relate(&table, &r, fit, key, out);
	for (int o = 0; o < OBJECTS; o++) {
		CHECK(out[o] >= 0 && out[o] <= 1, "%s of %d is %g", parse_relation_name(kind), o, out[o]);
		best = out[o] > out[best] ? o : best;
	}
	return best;
}

static void relations(void)
{
	static const struct {
		enum parse_relation kind;
		enum parse_degree degree;
		int first, second, expected;
	} cases[] = {
		{PARSE_LEFT, PARSE_PLAIN, CUP, NONE, LEFT},
		{PARSE_RIGHT, PARSE_PLAIN, TRAY, NONE, RIGHT},
		{PARSE_FRONT, PARSE_PLAIN, CUP, NONE, FRONT},
		{PARSE_BEHIND, PARSE_PLAIN, TRAY, NONE, BACK},
		{PARSE_ON, PARSE_PLAIN, TRAY, NONE, CUP},
		{PARSE_SUPPORTS, PARSE_PLAIN, CUP, NONE, TRAY},
		{PARSE_BELOW, PARSE_PLAIN, CUP, NONE, TRAY},
		{PARSE_NEAR, PARSE_PLAIN, TALL, NONE, BACK},
		{PARSE_NEAR, PARSE_MOST, RIGHT, NONE, TALL},
		{PARSE_FAR, PARSE_MOST, FRONT, NONE, BACK},
		{PARSE_BETWEEN, PARSE_PLAIN, FRONT, BACK, CUP},
		{PARSE_BETWEEN, PARSE_PLAIN, VIEWER, TRAY, FRONT},
		{PARSE_LEFT, PARSE_MOST, NONE, NONE, LEFT},
		{PARSE_RIGHT, PARSE_MOST, NONE, NONE, RIGHT},
		{PARSE_NEAR, PARSE_MOST, VIEWER, NONE, FRONT},
		{PARSE_FAR, PARSE_MOST, VIEWER, NONE, BACK},
		{PARSE_FRONT, PARSE_MOST, NONE, NONE, FRONT},
		{PARSE_LEFT, PARSE_PLAIN, NONE, NONE, LEFT},
		{PARSE_RIGHT, PARSE_PLAIN, NONE, NONE, RIGHT},
		{PARSE_FRONT, PARSE_PLAIN, NONE, NONE, FRONT},
		{PARSE_BEHIND, PARSE_PLAIN, NONE, NONE, BACK},
		{PARSE_LARGER, PARSE_MOST, NONE, NONE, TALL},
		{PARSE_LARGER, PARSE_PLAIN, NONE, NONE, TALL},
		{PARSE_SMALLER, PARSE_MOST, NONE, NONE, TRAY},
		{PARSE_TALLER, PARSE_MOST, NONE, NONE, TALL},
		{PARSE_TALLER, PARSE_MORE, CUP, NONE, TALL},
		{PARSE_WIDER, PARSE_MORE, BACK, NONE, TRAY},
		{PARSE_ABOVE, PARSE_MOST, NONE, NONE, TALL},
		{PARSE_BELOW, PARSE_MOST, NONE, NONE, TRAY},
	};

	lay_table();
	for (int o = 0; o < OBJECTS; o++)
		fit[o] = 1;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		int got = winner(cases[i].kind, cases[i].degree, cases[i].first, cases[i].second);
		/* the tray is as much between two things as what stands on it */
		CHECK(got == cases[i].expected || (cases[i].expected == CUP && got == TRAY && out[CUP] > 0.8),
			"%s, degree %d: %d, expected %d", parse_relation_name(cases[i].kind), cases[i].degree,
			got, cases[i].expected);
	}
	CHECK(winner(PARSE_FRONT, PARSE_PLAIN, TALL, NONE) != TALL && out[TALL] == 0,
		"nothing is its own anchor");
	winner(PARSE_LEFT, PARSE_PLAIN, TRAY, NONE);
	CHECK(out[CUP] < 0.01, "what stands on a thing is not left of it: %g", out[CUP]);
	winner(PARSE_TALLER, PARSE_PLAIN, LEFT, NONE);
	CHECK(out[RIGHT] > 0.99 && out[FRONT] > 0.99 && out[LEFT] == 0,
		"as tall as the left one: %g %g, itself %g", out[RIGHT], out[FRONT], out[LEFT]);
	CHECK(out[CUP] < 0.9 && out[CUP] > out[TRAY] && out[TALL] < 0.05 && out[TRAY] < 0.05,
		"and not as much: %g %g %g", out[CUP], out[TALL], out[TRAY]);
	winner(PARSE_SMALLER, PARSE_PLAIN, LEFT, NONE);
	CHECK(out[RIGHT] > 0.99 && out[TRAY] < 0.6, "as small as: %g %g", out[RIGHT], out[TRAY]);
	winner(PARSE_TALLER, PARSE_MORE, CUP, NONE);
	CHECK(out[LEFT] < 0.1 && out[TALL] > 0.9, "taller than the cup: %g, %g", out[LEFT], out[TALL]);
}

/* What compares, compares with those that fit the words. */
static void comparisons(void)
{
	memset(fit, 0, sizeof fit);
	fit[FRONT] = fit[BACK] = fit[CUP] = 1;
	winner(PARSE_MIDDLE, PARSE_PLAIN, NONE, NONE);
	CHECK(out[CUP] > 0.9 && out[FRONT] < 0.6 && out[BACK] < 0.6, "the middle one: %g, %g, %g", out[CUP],
		out[FRONT], out[BACK]);
	winner(PARSE_LARGER, PARSE_MOST, NONE, NONE);
	CHECK(out[BACK] > 0.5 && out[FRONT] < 0.5, "the largest of three: %g, %g", out[BACK], out[FRONT]);
	winner(PARSE_LEFT, PARSE_MOST, NONE, NONE);
	CHECK(out[CUP] > out[FRONT], "leftmost of those that fit");
}

/* The k-th from one end is the last but k - 1 from the other; each place among those that fit is somebody's.
 */
static void ranks(void)
{
	double back[OBJECTS];

	memset(fit, 0, sizeof fit);
	fit[LEFT] = fit[CUP] = fit[TALL] = fit[RIGHT] = 1;
	static const int order[] = {LEFT, CUP, TALL, RIGHT};
	for (int k = 1; k <= 4; k++) {
		relate_rank(&table, PARSE_LEFT, k, fit, key, out);
		CHECK(out[order[k - 1]] > 0.9, "number %d from the left: %g", k, out[order[k - 1]]);
		relate_rank(&table, PARSE_RIGHT, 5 - k, fit, key, back);
		CHECK(fabs(back[order[k - 1]] - out[order[k - 1]]) < 1e-6, "number %d from the right", 5 - k);
	}
	relate_rank(&table, PARSE_LEFT, -1, fit, key, out);
	CHECK(out[RIGHT] > 0.9, "the last from the left: %g", out[RIGHT]);
	relate_rank(&table, PARSE_LEFT, 1000000, fit, key, out);
	CHECK(out[RIGHT] < 0.1, "there is no such number");
}

/* All that fit, rather than one of them: "taller than the cups", of which it may be one. */
static void every_anchor(void)
{
	double p[OBJECTS + 1] = {0};
	struct relate_anchor anchor = {.p = p, .is_every = 1};
	const struct relation r = {PARSE_TALLER, PARSE_MORE, RELATE_NARROW, 0, 1, &anchor};

	p[TALL] = p[LEFT] = 1;
	relate(&table, &r, fit, key, out);
	CHECK(out[BACK] < 0.1 && out[TALL] < 0.01, "taller than both: %g, %g", out[BACK], out[TALL]);
	anchor.is_other = 1;
	relate(&table, &r, fit, key, out);
	CHECK(out[TALL] > 0.9, "taller than the other: %g", out[TALL]);
}

static void nobody_there(void)
{
	objects[LEFT].is_there = 0;
	for (int o = 0; o < OBJECTS; o++)
		fit[o] = 1;
	CHECK(winner(PARSE_LEFT, PARSE_MOST, NONE, NONE) != LEFT && out[LEFT] == 0, "what is not there");
	for (int o = 0; o < OBJECTS; o++)
		objects[o].is_there = 0;
	for (int r = 0; r < PARSE_RELATIONS; r++)
		for (int d = PARSE_PLAIN; d <= PARSE_MOST; d++)
			for (int anchors = 0; anchors < 3; anchors++) {
				winner((enum parse_relation)r, (enum parse_degree)d, anchors > 0 ? CUP : NONE,
					anchors > 1 ? TALL : NONE);
				for (int o = 0; o < OBJECTS; o++)
					CHECK(out[o] == 0, "%s", parse_relation_name((enum parse_relation)r));
			}
}

/* A camera that looks along +y from a height, z up. */
static struct camera camera_at(double x)
{
	struct camera c = {.width = 100, .height = 100, .fx = 100, .fy = 100, .cx = 50, .cy = 50};
	double rotation[3][3] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};

	camera_set_centre(&c, rotation, (double[3]){x, -10, 1});
	c.split = SPLIT_TRAIN;
	return c;
}

/* Two objects: a red cloud on the left, a blue one on the right with a stray far away. */
static void arrangement(void)
{
	enum { EACH = 40, N = 2 * EACH };
	static float means[3 * N], scales[3 * N], quats[4 * N], opacities[N], sh[3 * N], share[N];
	static int32_t index[N];
	int64_t indptr[] = {0, EACH, N, N};
	struct splats s = {N, 1, SPLATS_NEAR, means, scales, quats, opacities, sh};
	struct lifted l = {.gaussians = N, .objects = 3, .indptr = indptr, .index = index, .share = share};
	struct camera views[] = {camera_at(-1), camera_at(1)};
	struct cameras cameras = {2, views};
	struct arrangement a;
	struct err e;

	for (int i = 0; i < N; i++) {
		const int is_second = i >= EACH, k = i % EACH;
		const double mean[3] = {(is_second ? 3 : -3) + 0.05 * (k % 5), 0.1 * (k / 5), 0.2 * (k % 8)};
		for (int d = 0; d < 3; d++) {
			means[3 * i + d] = (float)(i == N - 1 ? 50 : mean[d]);
			scales[3 * i + d] = 0.1f;
			sh[3 * i + d] = (d == (is_second ? 2 : 0)) ? 1.5f : -1.5f;
		}
		index[i] = i;
		share[i] = 1;
		opacities[i] = 0.9f;
	}
	if (!CHECK(!arrangement_make(&a, &l, &s, &cameras, &e), "%s", e.message))
		return;
	CHECK(a.n == 3 && a.objects[0].is_there && a.objects[1].is_there && !a.objects[2].is_there, "there");
	CHECK(a.objects[0].centre[0] < -2 && a.objects[1].centre[0] > 2, "left %g, right %g",
		a.objects[0].centre[0], a.objects[1].centre[0]);
	CHECK(a.objects[1].high[0] - a.objects[1].low[0] < 0.5, "a stray makes it %g wide",
		a.objects[1].high[0] - a.objects[1].low[0]);
	CHECK(a.viewer.centre[1] < -9 && fabs(a.viewer.centre[0]) < 0.2, "the eye is at %g, %g",
		a.viewer.centre[0], a.viewer.centre[1]);
	CHECK(fabs(a.spacing - 6) < 0.2, "spacing %g", a.spacing);
	CHECK(a.objects[0].lab[1] > 50 && a.objects[1].lab[2] < -50, "red and blue");
	CHECK(a.objects[0].colours[colour_word("red")] > 0.5 &&
			a.objects[0].colours[colour_word("blue")] < 0.01,
		"red is called %g red", a.objects[0].colours[colour_word("red")]);
	/* from behind, left is right; and back again */
	const struct viewpoint behind = {.kind = VIEWPOINT_POINT, .point = {0, 30, 1}},
			       usual = {.kind = VIEWPOINT_USUAL};
	const double left = a.objects[0].centre[0];
	arrangement_look(&a, &behind);
	CHECK(a.objects[0].centre[0] > 2 && a.objects[1].centre[0] < -2, "from behind: %g, %g",
		a.objects[0].centre[0], a.objects[1].centre[0]);
	arrangement_look(&a, &usual);
	CHECK(a.objects[0].centre[0] == left, "the usual viewpoint again");
	/* a picture that has only the right one in it */
	struct camera narrow = camera_at(3);
	narrow.fx = narrow.fy = 400;
	const struct viewpoint picture = {.kind = VIEWPOINT_CAMERA, .camera = &narrow};
	arrangement_look(&a, &picture);
	CHECK(!a.objects[0].in_sight && a.objects[1].in_sight, "what a picture shows");
	arrangement_free(&a);
	cameras.n = 0;
	if (CHECK(!arrangement_make(&a, &l, &s, &cameras, &e), "%s", e.message))
		CHECK(isfinite(a.viewer.centre[0]) && isfinite(a.objects[0].centre[2]), "without cameras");
	arrangement_free(&a);
}

int main(void)
{
	relations();
	comparisons();
	ranks();
	every_anchor();
	nobody_there();
	arrangement();
	return unit_end();
}
