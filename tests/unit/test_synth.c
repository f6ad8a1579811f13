/* The synthetic scene: surfaces, objects, cameras and truth. */
#include "unit.h"

#include "base/mem.h"
#include "synth/presets.h"
#include "synth/cameras.h"
#include "synth/synth_scene.h"
#include "synth/sentence.h"

enum { SEEDS = 12, H = 90, W = 120 };

static const int counts[] = {2, 3, 5, 8, 24};

/* A ball's heights are uniform (Archimedes), and its normals point away from its middle. */
static void ball_is_covered_evenly(void)
{
	enum { N = 40000, BANDS = 8 };
	struct synth_surface s;
	int bands[BANDS] = {0}, inwards = 0;
	struct synth_spot spot;
	const double *point = spot.point, *normal = spot.normal;
	double r = 0.38, worst = 0;

	synth_object_surface(&s, SYNTH_BALL);
	CHECK(fabs(s.area - 4 * 3.14159265358979 * r * r) < 0.01 * s.area, "area %g", s.area);
	for (int i = 0; i < N; i++) {
		synth_surface_spot(&s, (i + 0.5) / N, fmod(0.618033988749 * i, 1), 0, &spot);
		double dz = point[2] - r,
		       outwards = point[0] * normal[0] + point[1] * normal[1] + dz * normal[2];
		inwards += outwards < 0.9 * r;
		bands[(int)fmin(BANDS - 1, point[2] / (2 * r) * BANDS)]++;
	}
	for (int i = 0; i < BANDS; i++)
		worst = fmax(worst, fabs(bands[i] * (double)BANDS / N - 1));
	CHECK(worst < 0.03, "a band of height is off by %g", worst);
	CHECK(inwards == 0, "%d normals do not point outwards", inwards);
}

/* Every shape keeps within the radius and height that placing relies on, and stands on the table. */
static void shapes_keep_their_measures(void)
{
	for (uint64_t seed = 1; seed <= SEEDS; seed++) {
		struct synth_object objects[8];
		struct synth_table table;
		synth_arrange(objects, 8, &table, synth_preset(0), seed);
		for (int k = 0; k < 8; k++) {
			const struct synth_object *o = &objects[k];
			struct synth_surface s;
			struct synth_spot spot;
			const double *point = spot.point, *normal = spot.normal;
			double far = 0, high = 0, low = 1, bad_normal = 0;
			synth_object_surface(&s, o->shape);
			for (int i = 0; i < 4000; i++) {
				synth_surface_spot(
					&s, (i + 0.5) / 4000, fmod(0.618033988749 * i, 1), 0, &spot);
				far = fmax(far, o->scale * hypot(point[0], point[1]));
				high = fmax(high, o->scale * point[2]);
				low = fmin(low, point[2]);
				double length = hypot(hypot(normal[0], normal[1]), normal[2]);
				bad_normal = fmax(bad_normal, fabs(length - 1));
			}
			CHECK(far < o->radius + 1e-6 && far > 0.9 * o->radius, "%s: %g of %g wide", o->name,
				far, o->radius);
			CHECK(high < o->height + 1e-6 && high > 0.95 * o->height, "%s: %g of %g high",
				o->name, high, o->height);
			CHECK(low >= 0 && low < 0.05, "%s: lowest point at %g", o->name, low);
			CHECK(bad_normal < 1e-9, "%s: a normal's length is off by %g", o->name, bad_normal);
		}
	}
}

static void objects_stand_apart(void)
{
	for (uint64_t seed = 1; seed <= SEEDS; seed++)
		for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
			struct synth_object o[SYNTH_MAX_OBJECTS];
			struct synth_table t;
			int n = counts[c], touching = 0, off = 0, same_name = 0, alike = 0;
			synth_arrange(o, n, &t, synth_preset(0), seed);
			for (int i = 0; i < n; i++) {
				off += fabs(o[i].x) + o[i].radius > t.half_width ||
				       fabs(o[i].y) + o[i].radius > t.half_depth;
				for (int j = 0; j < i; j++) {
					touching += hypot(o[i].x - o[j].x, o[i].y - o[j].y) <
						    o[i].radius + o[j].radius;
					same_name +=
						!strcmp(o[i].name, o[j].name) || !strcmp(o[i].ref, o[j].ref);
				}
				int group = 0;
				for (int j = 0; j < n; j++)
					group += o[i].shape == o[j].shape && o[i].colour == o[j].colour;
				alike += group > 1;
				CHECK(group <= 3, "seed %d: %d are a %s", (int)seed, group, o[i].name);
			}
			CHECK(!touching && !off && !same_name,
				"seed %d, %d objects: %d touch, %d off the table, %d names twice", (int)seed,
				n, touching, off, same_name);
			CHECK(alike == (n < 4 ? 0 : (n + 1) / 2), "seed %d, %d objects: %d have a like",
				(int)seed, n, alike);
		}
}

static void cameras_see_the_table(void)
{
	struct synth_object o[8];
	struct synth_table t;
	struct cameras c;
	struct err e = {0};
	double right[2], away[2], worst = 0;
	int seen = 0, tests = 0;
	struct synth_options options = {.preset = synth_preset(0),
		.seed = 3,
		.objects = 8,
		.views = 25,
		.width = W,
		.height = H,
		.gaussians = 1000};

	synth_arrange(o, 8, &t, synth_preset(0), 3);
	if (!CHECK(!synth_cameras_make(&c, &options, &t, &e), "%s", e.message))
		return;
	for (size_t i = 0; i < c.n; i++) {
		const struct camera *v = &c.views[i];
		tests += v->split == SPLIT_TEST;
		CHECK((v->split == SPLIT_TEST) == (i % 5 == 4), "split of view %zu", i);
		for (int a = 0; a < 3; a++)
			for (int b = 0; b < 3; b++) {
				double dot = -(a == b);
				for (int k = 0; k < 3; k++)
					dot += v->world_to_camera[a][k] * v->world_to_camera[b][k];
				worst = fmax(worst, fabs(dot));
			}
		/* y points down: a thing higher up has the smaller y. */
		double low[3], high[3];
		camera_transform(v, (double[3]){0, 0, 0}, low);
		camera_transform(v, (double[3]){0, 0, 1}, high);
		CHECK(high[1] < low[1] && low[2] > 0.2, "view %zu is upside down or looks away", i);
		for (int k = 0; k < 8; k++) {
			double p[3];
			camera_transform(v, (double[3]){o[k].x, o[k].y, o[k].height / 2}, p);
			double x = v->fx * p[0] / p[2] + v->cx, y = v->fy * p[1] / p[2] + v->cy;
			seen += p[2] > 0.2 && x >= 0 && x < W && y >= 0 && y < H;
		}
	}
	CHECK(worst < 1e-12, "rotations are off by %g", worst);
	CHECK(tests == 5, "%d test views", tests);
	CHECK(seen > 25 * 8 * 9 / 10, "%d of 200 object middles are in the picture", seen);
	synth_cameras_reference(&c, (double[3]){0}, right, away);
	CHECK(fabs(hypot(right[0], right[1]) - 1) < 1e-12 &&
			fabs(right[0] * away[0] + right[1] * away[1]) < 1e-12,
		"the reference directions are a frame");
	CHECK(right[0] > 0.9 && away[1] > 0.9, "the arc's middle is in front of the table");
	cameras_free(&c);
}

/* The masks against the blend weights themselves; returns the pixels that differ where the share is not a
 * tie. */
static int differing(const struct synth_scene *s, const struct render_view *view, const uint8_t *masks)
{
	struct render_weights w;
	struct err e = {0};
	int wrong = 0;

	if (render_weights(view, &w, &e))
		return -1;
	for (int p = 0; p < H * W; p++) {
		double share[2] = {0};
		for (int64_t i = w.indptr[p]; i < w.indptr[p + 1]; i++)
			if (s->owner[w.index[i]] >= 0)
				share[s->owner[w.index[i]]] += w.weight[i];
		for (int k = 0; k < 2; k++)
			wrong += fabs(share[k] - 0.5) > 1e-5 && masks[k * H * W + p] != (share[k] > 0.5);
	}
	render_weights_free(&w);
	return wrong;
}

/* Where nothing hides it, an object's mask lies where its middle projects. */
static void truth_is_where_the_objects_are(void)
{
	struct synth_options o = {.preset = synth_preset(0),
		.seed = 2,
		.objects = 2,
		.views = 4,
		.width = W,
		.height = H,
		.gaussians = 6000};
	struct synth_scene s;
	struct err e = {0};
	uint8_t *masks = mem_alloc(2, H * W, "masks", &e);

	if (!masks || !CHECK(!synth_scene_make(&s, &o, &e), "%s", e.message))
		return;
	int owned[3] = {0};
	for (size_t i = 0; i < s.splats.n; i++)
		owned[s.owner[i] + 1]++;
	CHECK(owned[1] > 1000 && owned[2] > 1000 && owned[0] > 1000, "%d %d %d Gaussians", owned[0], owned[1],
		owned[2]);
	for (size_t v = 0; v < s.cameras.n; v++) {
		const struct camera *c = &s.cameras.views[v];
		struct render_view *view = render_prepare(&s.splats, c, &e);
		if (!CHECK(view && !synth_truth_visible(&s, view, H * W, masks, &e), "%s", e.message))
			break;
		size_t both = 0;
		for (int k = 0; k < 2; k++) {
			const struct synth_object *q = &s.objects[k];
			double p[3], x = 0, y = 0, area = 0;
			camera_transform(c, (double[3]){q->x, q->y, q->height / 2}, p);
			for (int i = 0; i < H * W; i++)
				if (masks[k * H * W + i]) {
					x += i % W;
					y += i / W;
					area++;
				}
			double dx = x / area + 0.5 - c->fx * p[0] / p[2] - c->cx,
			       dy = y / area + 0.5 - c->fy * p[1] / p[2] - c->cy;
			CHECK(area > 40 && hypot(dx, dy) < 0.5 * sqrt(area),
				"view %zu, %s: %g pixels, %g away", v, q->name, area, hypot(dx, dy));
		}
		for (int i = 0; i < H * W; i++)
			both += masks[i] && masks[H * W + i];
		int wrong = differing(&s, view, masks);
		CHECK(wrong == 0, "view %zu: %d pixels are not what their blend weights say", v, wrong);
		CHECK(!both, "%zu pixels belong to two objects", both);
		render_free(view);
	}
	free(masks);
	synth_scene_free(&s);
}

int main(void)
{
	ball_is_covered_evenly();
	shapes_keep_their_measures();
	objects_stand_apart();
	cameras_see_the_table();
	truth_is_where_the_objects_are();
	return unit_end();
}
