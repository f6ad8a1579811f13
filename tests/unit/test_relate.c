/* Relations between objects, on a made-up table, and where lifted objects are. */
#include "ask/arrangement.h"
#include "ask/relate.h"
#include "unit.h"

#include <string.h>

enum { LEFT, RIGHT, FRONT, BACK, TRAY, CUP, TALL, OBJECTS };

static struct arranged objects[OBJECTS];
static struct arrangement table = {OBJECTS, objects, {0, -10, 5}, 4};

static void put(int o, double x, double y, double z, double width, double height)
{
	const double centre[3] = {x, y, z + height / 2}, half[3] = {width / 2, width / 2, height / 2};

	objects[o] = (struct arranged){.is_there = 1};
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

static double out[OBJECTS], key[OBJECTS], fit[OBJECTS];

static int winner(enum lang_relation relation, int first, int second)
{
	double anchors[2 * OBJECTS] = {0};
	int best = 0;

	if (first >= 0)
		anchors[first] = 1;
	if (second >= 0)
		anchors[OBJECTS + second] = 1;
	relate(&table, relation, anchors, (first >= 0) + (second >= 0), fit, key, out);
	for (int o = 0; o < OBJECTS; o++) {
		CHECK(out[o] >= 0 && out[o] <= 1, "%s of %d is %g", lang_relation_name(relation), o, out[o]);
		best = out[o] > out[best] ? o : best;
	}
	return best;
}

static void relations(void)
{
	static const struct {
		enum lang_relation relation;
		int first, second, expected;
	} cases[] = {
		{LANG_LEFT, CUP, -1, LEFT},
		{LANG_RIGHT, TRAY, -1, RIGHT},
		{LANG_FRONT, CUP, -1, FRONT},
		{LANG_BEHIND, TRAY, -1, BACK},
		{LANG_ON, TRAY, -1, CUP},
		{LANG_UNDER, CUP, -1, TRAY},
		{LANG_NEAR, TALL, -1, BACK},
		{LANG_NEAREST, RIGHT, -1, TALL},
		{LANG_FARTHEST, FRONT, -1, BACK},
		{LANG_BETWEEN, FRONT, BACK, CUP},
		{LANG_LEFTMOST, -1, -1, LEFT},
		{LANG_RIGHTMOST, -1, -1, RIGHT},
		{LANG_NEAREST_US, -1, -1, FRONT},
		{LANG_FARTHEST_US, -1, -1, BACK},
		{LANG_LEFT_SIDE, -1, -1, LEFT},
		{LANG_RIGHT_SIDE, -1, -1, RIGHT},
		{LANG_FRONT_SIDE, -1, -1, FRONT},
		{LANG_BACK_SIDE, -1, -1, BACK},
		{LANG_LARGEST, -1, -1, TALL},
		{LANG_SMALLEST, -1, -1, TRAY},
		{LANG_TALLEST, -1, -1, TALL},
		{LANG_HIGHEST, -1, -1, TALL},
		{LANG_LOWEST, -1, -1, TRAY},
	};

	lay_table();
	for (int o = 0; o < OBJECTS; o++)
		fit[o] = 1;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		int got = winner(cases[i].relation, cases[i].first, cases[i].second);
		/* the tray is as much between two things as what stands on it */
		CHECK(got == cases[i].expected || (cases[i].expected == CUP && got == TRAY && out[CUP] > 0.8),
			"%s: %d, expected %d", lang_relation_name(cases[i].relation), got, cases[i].expected);
	}
	CHECK(winner(LANG_FRONT, TALL, -1) != TALL && out[TALL] == 0, "nothing is its own anchor");
	winner(LANG_LEFT, TRAY, -1);
	CHECK(out[CUP] < 0.01, "what stands on a thing is not left of it: %g", out[CUP]);
}

/* What compares, compares with those that fit the words. */
static void comparisons(void)
{
	memset(fit, 0, sizeof fit);
	fit[FRONT] = fit[BACK] = fit[CUP] = 1;
	winner(LANG_MIDDLE_ONE, -1, -1);
	CHECK(out[CUP] > 0.9 && out[FRONT] < 0.6 && out[BACK] < 0.6, "the middle one: %g, %g, %g", out[CUP],
		out[FRONT], out[BACK]);
	winner(LANG_LARGEST, -1, -1);
	CHECK(out[BACK] > 0.5 && out[FRONT] < 0.5, "the largest of three: %g, %g", out[BACK], out[FRONT]);
	fit[LEFT] = 0;
	winner(LANG_LEFTMOST, -1, -1);
	CHECK(out[CUP] > out[FRONT], "leftmost of those that fit");
}

/* The middle of likelihoods: half of each anchor. */
static void uncertain_anchors(void)
{
	double anchors[OBJECTS] = {0}, one[OBJECTS], two[OBJECTS];

	anchors[CUP] = 1;
	relate(&table, LANG_LEFT, anchors, 1, fit, key, one);
	anchors[CUP] = 0;
	anchors[TALL] = 1;
	relate(&table, LANG_LEFT, anchors, 1, fit, key, two);
	anchors[CUP] = anchors[TALL] = 0.5;
	relate(&table, LANG_LEFT, anchors, 1, fit, key, out);
	for (int o = 0; o < OBJECTS; o++)
		CHECK(fabs(out[o] - (one[o] + two[o]) / 2) < 1e-12, "object %d", o);
}

static void nobody_there(void)
{
	objects[LEFT].is_there = 0;
	for (int o = 0; o < OBJECTS; o++)
		fit[o] = 1;
	CHECK(winner(LANG_LEFTMOST, -1, -1) != LEFT && out[LEFT] == 0, "what is not there");
	for (int o = 0; o < OBJECTS; o++)
		objects[o].is_there = 0;
	for (int r = 0; r < LANG_RELATIONS; r++) {
		winner((enum lang_relation)r, r <= LANG_BETWEEN ? CUP : -1, r == LANG_BETWEEN ? TALL : -1);
		for (int o = 0; o < OBJECTS; o++)
			CHECK(out[o] == 0, "%s", lang_relation_name((enum lang_relation)r));
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
	struct splats s = {N, 1, means, scales, quats, opacities, sh};
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
	CHECK(a.eye[1] < -9 && fabs(a.eye[0]) < 0.2, "the eye is at %g, %g", a.eye[0], a.eye[1]);
	CHECK(fabs(a.spacing - 6) < 0.2, "spacing %g", a.spacing);
	CHECK(a.objects[0].lab[1] > 50 && a.objects[1].lab[2] < -50, "red and blue");
	CHECK(arrangement_alike(&a, 0, 0) == 0 && arrangement_alike(&a, 0, 1) < -50, "alike: %g",
		arrangement_alike(&a, 0, 1));
	CHECK(arrangement_alike(&a, 0, 1) == arrangement_alike(&a, 1, 0), "alike both ways");
	CHECK(arrangement_alike(&a, 0, 2) == -INFINITY, "like nothing");
	arrangement_free(&a);
	cameras.n = 0;
	if (CHECK(!arrangement_make(&a, &l, &s, &cameras, &e), "%s", e.message))
		CHECK(isfinite(a.eye[0]) && isfinite(a.objects[0].centre[2]), "without cameras");
	arrangement_free(&a);
}

int main(void)
{
	relations();
	comparisons();
	uncertain_anchors();
	nobody_there();
	arrangement();
	return unit_end();
}
