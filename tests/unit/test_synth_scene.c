/* The named scenes: what stands on what, what hides what, Gaussians near their surfaces, and whole masks. */
#include "unit.h"

#include "base/mem.h"
#include "synth/presets.h"
#include "synth/cameras.h"
#include "synth/occlusion.h"
#include "synth/statistics.h"
#include "synth/synth_scene.h"

enum { SEEDS = UNIT_DRAWS(4, 1), H = 91, W = 123 };

static struct synth_options options(int number, uint64_t seed)
{
	const struct synth_preset *p = synth_preset(number);

	return (struct synth_options){.preset = p,
		.seed = synth_preset_seed(number, seed, 0),
		.objects = p->objects,
		.views = p->views,
		.width = W,
		.height = H,
		.gaussians = 12000};
}

static void presets_are_59_objects(void)
{
	int objects = 0;

	CHECK(!synth_preset(-1) && !synth_preset(SYNTH_PRESETS), "numbers out of range");
	for (int i = 1; i < SYNTH_PRESETS; i++) {
		const struct synth_preset *p = synth_preset(i);
		int training = p->views - p->test_views, shapes = 0;
		objects += p->objects;
		for (int k = 0; k < SYNTH_SHAPES; k++)
			shapes += p->shapes[k] > 0;
		CHECK(training >= 30 && training <= 60, "%s: %d training views", p->name, training);
		CHECK(p->test_views >= 6 && p->test_views <= 10, "%s: %d test views", p->name, p->test_views);
		CHECK(shapes >= 3, "%s: %d shapes", p->name, shapes);
		for (int k = 0; k < i; k++)
			CHECK(synth_preset_seed(i, 5, 0) != synth_preset_seed(k, 5, 0), "seeds of %d and %d",
				i, k);
	}
	CHECK(objects == 59, "%d objects", objects);
	CHECK(synth_preset_seed(0, 7, 0) == 7, "the plain table has the seed itself");
	CHECK(synth_preset_seed(0, 7, 1) != 7, "another attempt has another seed");
}

static double gap(const struct synth_object *a, const struct synth_object *b)
{
	return hypot(a->x - b->x, a->y - b->y) - a->radius - b->radius;
}

/* Every point of the load's foot lies over the flat top, which is at its height: checked here by points, not
 * by the rule that placed it. */
static int foot_is_over_top(const struct synth_object *load, const struct synth_object *support)
{
	double z, c = cos(support->yaw), s = sin(support->yaw);
	struct synth_area foot = synth_object_foot(load), top = synth_object_top(support, &z);
	int inside = fabs(support->z + z - load->z) < 1e-9;

	for (int i = 0; i < 64; i++) {
		double turn = 2 * 3.14159265358979 * i / 64, x = foot.x * cos(turn), y = foot.x * sin(turn);
		if (foot.y > 0) {
			x = (i & 1 ? 1 : -1) * foot.x;
			y = (i & 2 ? 1 : -1) * foot.y;
		}
		double wx = load->x + cos(load->yaw) * x - sin(load->yaw) * y - support->x;
		double wy = load->y + sin(load->yaw) * x + cos(load->yaw) * y - support->y;
		double u = fabs(c * wx + s * wy), v = fabs(c * wy - s * wx);
		inside &= top.y > 0 ? u <= top.x && v <= top.y : hypot(u, v) <= top.x;
	}
	return inside;
}

static void loads_rest_on_supports(void)
{
	struct synth_object o[SYNTH_MAX_OBJECTS];
	struct synth_table t;

	for (int number = 0; number < SYNTH_PRESETS; number++)
		for (uint64_t seed = 1; seed <= 4 * SEEDS; seed++) {
			const struct synth_preset *p = synth_preset(number);
			int n = p->objects, stacked = 0, bad = 0, alike = 0, touching = 0, off = 0;
			synth_arrange(o, n, &t, p, synth_preset_seed(number, seed, 0));
			for (int i = 0; i < n; i++) {
				int others = 0;
				off += fabs(o[i].x) + o[i].radius > t.half_width ||
				       fabs(o[i].y) + o[i].radius > t.half_depth;
				if (o[i].on >= 0) {
					const struct synth_object *support = &o[o[i].on];
					stacked++;
					bad += support->on >= 0 || !foot_is_over_top(&o[i], support);
				} else {
					bad += o[i].z != 0;
				}
				for (int j = 0; j < n; j++) {
					others += j != i && o[j].shape == o[i].shape &&
						  o[j].colour == o[i].colour;
					touching += j != i && o[i].on != j && o[j].on != i &&
						    gap(&o[i], &o[j]) < 0;
				}
				alike += others > 0;
				CHECK(others <= 2, "%s %d: %d more of the %s", p->name, (int)seed, others,
					o[i].name);
			}
			CHECK(!bad && !touching && !off, "%s %d: %d stand badly, %d touch, %d off the table",
				p->name, (int)seed, bad, touching, off);
			CHECK(stacked == (number ? (n + 2) / 6 : 0), "%s %d: %d stand on others", p->name,
				(int)seed, stacked);
			CHECK(alike == (n + 1) / 2, "%s %d: %d alike", p->name, (int)seed, alike);
		}
}

/* A rule that says yes to everything would not notice. */
static void what_does_not_rest(void)
{
	struct synth_object book = {.shape = SYNTH_BOOK, .size = SYNTH_BIG, .yaw = 0.4, .on = -1};
	struct synth_object mug = {.shape = SYNTH_MUG, .size = SYNTH_SMALL, .on = 0};
	double z;

	synth_object_measure(&book);
	synth_object_measure(&mug);
	synth_object_top(&book, &z);
	mug.z = z;
	CHECK(foot_is_over_top(&mug, &book), "in the middle of a book");
	mug.x = 0.5;
	CHECK(!foot_is_over_top(&mug, &book), "half beside it");
	mug.x = 0;
	mug.z = z + 0.01;
	CHECK(!foot_is_over_top(&mug, &book), "above it");
	mug.z = z;
	CHECK(!foot_is_over_top(&book, &mug), "on a mug");
}

/* A ball behind a box of its size, seen level and from above. */
static void sight_is_blocked(void)
{
	struct synth_object o[2] = {{.shape = SYNTH_BOX, .size = SYNTH_BIG, .y = -1, .on = -1},
		{.shape = SYNTH_BALL, .size = SYNTH_SMALL, .y = 0.5, .on = -1}};
	struct camera c = {.width = W, .height = H, .fx = W, .fy = W, .cx = W / 2.0, .cy = H / 2.0};
	struct synth_occlusion occlusion;
	struct err e = {0};
	int visible[2], whole[2];

	synth_object_measure(&o[0]);
	synth_object_measure(&o[1]);
	if (!CHECK(!synth_occlusion_make(&occlusion, o, 2, &e), "%s", e.message))
		return;
	synth_cameras_aim(&c, (double[3]){0, -5, 0.5}, (double[3]){0, 0, 0.4}, 0);
	synth_occlusion_look(&occlusion, &c, visible, whole);
	CHECK(whole[1] > 20 && visible[1] < whole[1] / 10, "level: %d of %d", visible[1], whole[1]);
	CHECK(visible[0] > 0.95 * whole[0], "the box in front: %d of %d", visible[0], whole[0]);
	synth_cameras_aim(&c, (double[3]){0, -1, 6}, (double[3]){0, 0, 0}, 0);
	synth_occlusion_look(&occlusion, &c, visible, whole);
	CHECK(whole[1] > 10 && visible[1] > 0.95 * whole[1], "from above: %d of %d", visible[1], whole[1]);
	synth_occlusion_free(&occlusion);
}

static void test_views_hide_things(void)
{
	for (int number = 1; number < SYNTH_PRESETS; number++)
		for (uint64_t seed = 1; seed <= SEEDS; seed++) {
			struct synth_options o = options(number, seed);
			struct synth_object objects[SYNTH_MAX_OBJECTS];
			int visible[SYNTH_MAX_OBJECTS], whole[SYNTH_MAX_OBJECTS],
				seen[SYNTH_MAX_OBJECTS] = {0};
			int hidden = 0, slivers = 0, pairs = 0, never = 0;
			struct synth_table t;
			struct synth_occlusion occlusion;
			struct cameras c;
			struct err e = {0};
			synth_arrange(objects, o.objects, &t, o.preset, o.seed);
			if (!CHECK(!synth_cameras_make(&c, &o, &t, &e) &&
					    !synth_cameras_hide(&c, &o, objects, &t, &e) &&
					    !synth_occlusion_make(&occlusion, objects, o.objects, &e),
				    "%s", e.message))
				return;
			for (size_t i = 0; i < c.n; i++) {
				if (c.views[i].split != SPLIT_TEST)
					continue;
				CHECK(camera_is_rigid(&c.views[i]), "view %zu is no camera", i);
				synth_occlusion_look(&occlusion, &c.views[i], visible, whole);
				for (int k = 0; k < o.objects; k++) {
					pairs++;
					hidden += 2 * visible[k] < whole[k];
					slivers += visible[k] < 0.15 * whole[k];
					seen[k] += visible[k] > 0.02 * whole[k];
				}
			}
			for (int k = 0; k < o.objects; k++)
				never += !seen[k];
			CHECK(hidden >= 0.15 * pairs && hidden <= 0.25 * pairs,
				"%s %d: %d of %d pairs less than half visible", o.preset->name, (int)seed,
				hidden, pairs);
			CHECK(slivers > 0 && slivers <= 0.1 * pairs, "%s %d: %d of %d pairs hardly visible",
				o.preset->name, (int)seed, slivers, pairs);
			CHECK(!never, "%s %d: no test view shows %d objects", o.preset->name, (int)seed,
				never);
			synth_occlusion_free(&occlusion);
			cameras_free(&c);
		}
}

/* A wall of boxes before a ball: no training camera sees it. */
static void hidden_training_objects_are_found(void)
{
	struct synth_options o = options(1, 1);
	struct synth_object objects[3] = {
		{.shape = SYNTH_BALL, .size = SYNTH_SMALL, .on = -1, .name = "red ball"},
		{.shape = SYNTH_BOX, .size = SYNTH_BIG, .on = -1},
		{.shape = SYNTH_BOX, .size = SYNTH_BIG, .x = 1.2, .on = -1}};
	struct synth_table t = {2, 1.5};
	struct cameras c;
	struct err e = {0};

	for (int i = 0; i < 3; i++)
		synth_object_measure(&objects[i]);
	objects[0].scale = 0.2; /* so small that it is inside the first box */
	if (!CHECK(!synth_cameras_make(&c, &o, &t, &e), "%s", e.message))
		return;
	CHECK(synth_cameras_check(&c, objects, 3, &e) && e.code == ERR_CHECK &&
			!strcmp(e.message, "the red ball is hidden in most training views"),
		"'%s'", e.message);
	objects[0].x = -1.2;
	objects[0].scale = 0.75;
	CHECK(!synth_cameras_check(&c, objects, 3, &e), "%s", e.message);
	cameras_free(&c);
}

static void spots_keep_their_margin(void)
{
	static const double margin = 0.05;

	for (int shape = 0; shape < SYNTH_SHAPES; shape++) {
		struct synth_surface s;
		int close = 0, crooked = 0;
		synth_object_surface(&s, (enum synth_shape)shape);
		for (int i = 0; i < 2000; i++) {
			struct synth_spot spot;
			synth_surface_spot(&s, (i + 0.5) / 2000, fmod(0.618033988749 * i, 1), margin, &spot);
			double dot = 0, length = 0;
			for (int k = 0; k < 3; k++) {
				dot += spot.along[k] * spot.normal[k];
				length += spot.along[k] * spot.along[k];
			}
			crooked += fabs(dot) > 1e-9 || fabs(length - 1) > 1e-9;
			/* Rims narrower than twice the margin have a middle. */
			close += spot.room[0] < 0.02 || spot.bend[0] <= 0 || spot.bend[1] < 0;
		}
		CHECK(!crooked, "shape %d: %d tangents are none", shape, crooked);
		CHECK(shape == SYNTH_PLATE || close < 200, "shape %d: %d of 2000 at an edge", shape, close);
	}
	struct synth_surface box = {0};
	synth_surface_box(&box, SYNTH_OWN, SYNTH_OWN, (double[3]){0}, 1, 1, 1);
	for (int i = 0; i < 500; i++) {
		struct synth_spot spot;
		synth_surface_spot(&box, (i + 0.5) / 500, fmod(0.618033988749 * i, 1), margin, &spot);
		CHECK(spot.room[0] > margin - 1e-9 && spot.room[1] > margin - 1e-9, "box: %g and %g",
			spot.room[0], spot.room[1]);
	}
}

/* An object's opaque Gaussians stay by its surface: for a ball that is easily told. */
static void gaussians_keep_to_surfaces(void)
{
	struct synth_options o = options(2, 3);
	struct synth_scene s;
	struct err e = {0};
	size_t far = 0, of = 0;

	o.gaussians = 40000;
	while (synth_scene_make(&s, &o, &e))
		if (!CHECK(e.code == ERR_CHECK, "%s", e.message))
			return;
		else
			o.seed++;
	for (int k = 0; k < s.object_count; k++) {
		const struct synth_object *b = &s.objects[k];
		if (b->shape != SYNTH_BALL)
			continue;
		for (size_t i = s.first[k]; i < s.first[k + 1]; i++) {
			const float *m = s.splats.means + 3 * i;
			double r = sqrt(
				pow(m[0] - b->x, 2) + pow(m[1] - b->y, 2) + pow(m[2] - b->z - b->radius, 2));
			of++;
			far += fabs(r - b->radius) > 0.06 * b->radius;
			CHECK(s.owner[i] == k, "owner of Gaussian %zu", i);
		}
	}
	CHECK(of > 1000 && far < of / 50, "%zu of %zu are off their ball", far, of);
	CHECK(s.first[s.object_count] < s.splats.n, "the table has Gaussians");
	synth_scene_free(&s);
}

static void whole_contains_truth(void)
{
	struct synth_options o = options(2, 1);
	struct synth_scene s;
	struct err e = {0};
	size_t pixels = (size_t)W * H, outside = 0, visible_area = 0, whole_area = 0, changed = 0;

	o.views = 6;
	while (synth_scene_make(&s, &o, &e))
		if (!CHECK(e.code == ERR_CHECK, "%s", e.message))
			return;
		else
			o.seed++;
	size_t all = (size_t)s.object_count * pixels;
	uint8_t *visible = mem_alloc(all, 1, "masks", &e), *whole = mem_alloc(all, 1, "masks", &e);
	for (size_t i = 0; i < s.cameras.n; i++) {
		const struct camera *c = &s.cameras.views[i];
		struct render_view *view = render_prepare(&s.splats, c, &e);
		if (!CHECK(view && !synth_truth_visible(&s, view, pixels, visible, &e) &&
				    !synth_truth_whole(&s, c, whole, &e),
			    "%s", e.message))
			return;
		for (size_t p = 0; p < all; p++) {
			outside += visible[p] && !whole[p];
			visible_area += visible[p];
			whole_area += whole[p];
		}
		render_free(view);
	}
	/* Where the others are does not matter: without them the whole is what is visible. whole is still
	 * that of the last view. */
	const struct camera *last = &s.cameras.views[s.cameras.n - 1];
	memset(s.splats.opacities + s.first[1], 0, (s.splats.n - s.first[1]) * sizeof *s.splats.opacities);
	struct render_view *view = render_prepare(&s.splats, last, &e);
	CHECK(view && !synth_truth_visible(&s, view, pixels, visible, &e), "%s", e.message);
	for (size_t p = 0; p < pixels; p++)
		changed += visible[p] != whole[p];
	CHECK(!changed, "%zu pixels of the first object are not whole", changed);
	render_free(view);
	CHECK(outside * 1000 <= visible_area, "%zu of %zu visible pixels are not of the whole", outside,
		visible_area);
	CHECK(whole_area > visible_area + visible_area / 20, "nothing is hidden: %zu of %zu", visible_area,
		whole_area);
	free(visible);
	free(whole);
	synth_scene_free(&s);
}

static void statistics_count(void)
{
	struct synth_statistics s = {0};
	static const long bands[SYNTH_BANDS] = {1, 2, 1, 1, 2};

	synth_statistics_see(&s, SPLIT_TEST, 0, 0);
	synth_statistics_see(&s, SPLIT_TEST, 0, 100);
	synth_statistics_see(&s, SPLIT_TEST, 1, 100);
	synth_statistics_see(&s, SPLIT_TEST, 14, 100);
	synth_statistics_see(&s, SPLIT_TEST, 15, 100);
	synth_statistics_see(&s, SPLIT_TEST, 50, 100);
	synth_statistics_see(&s, SPLIT_TEST, 85, 100);
	synth_statistics_see(&s, SPLIT_TEST, 100, 100);
	const struct synth_visibility *v = &s.visibility[SPLIT_TEST];
	CHECK(v->outside == 1 && v->pairs == 7, "%ld outside, %ld pairs", v->outside, v->pairs);
	for (int i = 0; i < SYNTH_BANDS; i++)
		CHECK(v->bands[i] == bands[i], "band %s: %ld", synth_bands[i], v->bands[i]);
	CHECK(!s.visibility[SPLIT_TRAIN].pairs, "training was not seen");
}

int main(void)
{
	presets_are_59_objects();
	loads_rest_on_supports();
	what_does_not_rest();
	sight_is_blocked();
	test_views_hide_things();
	hidden_training_objects_are_found();
	spots_keep_their_margin();
	gaussians_keep_to_surfaces();
	whole_contains_truth();
	statistics_count();
	return unit_end();
}
