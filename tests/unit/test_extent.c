/* Boxes around Gaussians: what they must not be misled by, and the truth that they are compared with. */
#include "unit.h"

#include "answer/locate.h"
#include "base/rng.h"
#include "geom/rotation.h"
#include "lift/extent.h"
#include "synth/objects.h"

enum { MOST = 4000 };

static const double z_up[3] = {0, 0, 1};

struct object {
	struct splats splats;
	int32_t ids[MOST];
	float responses[MOST];
};

static void object_begin(struct object *o, size_t n)
{
	struct err e;

	if (splats_alloc(&o->splats, n, 4, &e))
		exit(1);
	for (size_t i = 0; i < n; i++) {
		for (size_t k = 0; k < 3; k++) {
			o->splats.means[3 * i + k] = 0;
			o->splats.scales[3 * i + k] = 0.001f;
		}
		for (size_t k = 0; k < 4; k++)
			o->splats.quats[4 * i + k] = k == 0;
		for (size_t k = 0; k < 12; k++)
			o->splats.sh[12 * i + k] = 0.5f;
		o->splats.opacities[i] = 0.5f;
		o->ids[i] = (int32_t)i;
		o->responses[i] = 0.5f;
	}
}

/* Gaussians all over the surface of a box of these sides that is turned about z. */
static void put_box(struct object *o, size_t from, size_t to, const double sides[3], double angle)
{
	struct rng rng;

	rng_seed(&rng, 5, 1);
	for (size_t i = from; i < to; i++) {
		const int face = (int)(i % 3);
		double p[3];
		for (int k = 0; k < 3; k++)
			p[k] = sides[k] * (k == face ? (double)(i / 3 % 2) - 0.5 : rng_uniform(&rng) - 0.5);
		o->splats.means[3 * i] = (float)(cos(angle) * p[0] - sin(angle) * p[1]);
		o->splats.means[3 * i + 1] = (float)(sin(angle) * p[0] + cos(angle) * p[1]);
		o->splats.means[3 * i + 2] = (float)p[2];
	}
}

static void find(struct extent *x, const struct object *o, size_t n)
{
	struct err e;

	CHECK(!extent_find(x, &o->splats, o->ids, o->responses, n, z_up, &e), "out of memory");
}

static double iou_with(const struct box *b, const double sides[3], double angle)
{
	const struct box true_box = {{0},
		{{cos(angle), sin(angle), 0}, {-sin(angle), cos(angle), 0}, {0, 0, 1}},
		{sides[0] / 2, sides[1] / 2, sides[2] / 2}};

	return box_iou(b, &true_box);
}

static void a_turned_box_is_found(void)
{
	static struct object o;
	const double sides[3] = {2, 1, 0.5};
	struct extent x;

	object_begin(&o, MOST);
	for (int i = 0; i < 6; i++) {
		const double angle = 0.3 * i;
		put_box(&o, 0, MOST, sides, angle);
		find(&x, &o, MOST);
		CHECK(x.n > 0.99 * MOST, "%zu Gaussians", x.n);
		CHECK(iou_with(&x.turned, sides, angle) > 0.9, "turned by %g: %g", angle,
			iou_with(&x.turned, sides, angle));
		double low[3], high[3];
		box_bounds(&x.turned, low, high);
		CHECK(fabs(x.aligned.centre[0]) < 0.05 && x.aligned.half[0] < high[0] + 0.05, "aligned");
		extent_free(&x);
	}
	splats_free(&o.splats);
}

/* Strays far away, a halo of half-hearted responses, and one that is enormous. */
static void a_few_wrong_ones_do_no_harm(void)
{
	static struct object o;
	const double sides[3] = {1, 1, 1};
	const size_t good = 3000, strays = 200, halo = 300;
	struct extent x;
	struct rng rng;

	rng_seed(&rng, 9, 1);
	object_begin(&o, MOST);
	put_box(&o, 0, good, sides, 0);
	for (size_t i = good; i < good + strays; i++)
		for (size_t k = 0; k < 3; k++)
			o.splats.means[3 * i + k] = (float)(200 * (rng_uniform(&rng) - 0.5));
	for (size_t i = good + strays; i < good + strays + halo; i++) {
		for (size_t k = 0; k < 3; k++)
			o.splats.means[3 * i + k] = (float)(2 * (rng_uniform(&rng) - 0.5));
		o.responses[i] = 0.1f;
	}
	o.splats.scales[0] = 1e6f;
	find(&x, &o, good + strays + halo);
	CHECK(iou_with(&x.aligned, sides, 0) > 0.9, "aligned %g", iou_with(&x.aligned, sides, 0));
	CHECK(iou_with(&x.turned, sides, 0) > 0.85, "turned %g", iou_with(&x.turned, sides, 0));
	CHECK(x.n >= good && x.n < good + halo + 5, "%zu kept", x.n);
	for (size_t i = 1; i < x.n; i++)
		if (!CHECK(x.ids[i] > x.ids[i - 1], "not in order at %zu", i))
			break;
	extent_free(&x);
	splats_free(&o.splats);
}

/* What stands on a flat thing leaves it a twentieth of its weight, above it; a table's legs are a fifth. */
static void what_sticks_out_counts_by_its_weight(void)
{
	static struct object o;
	const double sides[3] = {2, 2, 0.05};
	struct rng rng;

	rng_seed(&rng, 11, 1);
	object_begin(&o, MOST);
	for (int kind = 0; kind < 2; kind++) {
		const size_t good = MOST - (kind ? MOST / 5 : MOST / 20);
		struct extent x;
		put_box(&o, 0, MOST, sides, 0);
		for (size_t i = good; i < MOST; i++) {
			o.splats.means[3 * i] = kind && i % 2 ? 0.95f : -0.95f;
			o.splats.means[3 * i + 1] = kind && i % 4 < 2 ? 0.95f : -0.95f;
			o.splats.means[3 * i + 2] = (kind ? -1 : 1) * (float)rng_uniform(&rng);
		}
		find(&x, &o, MOST);
		const double height = 2 * x.turned.half[2];
		CHECK(kind ? height > 0.95 : height < 0.15, "%s: %g high", kind ? "legs" : "flat", height);
		CHECK(fabs(x.turned.half[0] - 1) < 0.05, "%g wide", 2 * x.turned.half[0]);
		extent_free(&x);
	}
	splats_free(&o.splats);
}

/* Two halves, as something before the object leaves them. */
static void parts_stay_together(void)
{
	static struct object o;
	struct extent x;

	object_begin(&o, 2000);
	put_box(&o, 0, 2000, (double[3]){1, 1, 1}, 0);
	for (size_t i = 0; i < 1000; i++)
		o.splats.means[3 * i] += 4;
	find(&x, &o, 2000);
	CHECK(x.n == 2000 && fabs(2 * x.aligned.half[0] - 5) < 0.1, "%zu, %g long", x.n,
		2 * x.aligned.half[0]);
	extent_free(&x);
	splats_free(&o.splats);
}

static void hard_cases(void)
{
	static struct object o;
	struct extent x;

	object_begin(&o, 1000);
	find(&x, &o, 0);
	CHECK(x.n == 0 && x.aligned.half[0] == 0, "none");
	extent_free(&x);

	o.splats.means[1] = 7;
	o.splats.scales[2] = 0.5f;
	find(&x, &o, 1);
	CHECK(x.n == 1 && fabs(x.turned.half[2] - 0.5) < 1e-6 && fabs(x.aligned.centre[1] - 7) < 1e-6,
		"one: %g %g", x.turned.half[2], x.aligned.centre[1]);
	extent_free(&x);

	o.splats.means[1] = 0;
	o.splats.scales[2] = 0.001f;
	find(&x, &o, 1000);
	CHECK(x.n == 1000 && fabs(x.aligned.half[0] - 0.001) < 1e-6, "all in one place: %g",
		x.aligned.half[0]);
	extent_free(&x);

	/* Flat, without any thickness. */
	put_box(&o, 0, 1000, (double[3]){2, 1, 0}, 0);
	for (size_t i = 0; i < 3000; i++)
		o.splats.scales[i] = 0;
	find(&x, &o, 1000);
	CHECK(x.n == 1000 && x.turned.half[2] == 0 && fabs(x.turned.half[0] - 1) < 0.02, "flat: %g %g",
		x.turned.half[0], x.turned.half[2]);
	extent_free(&x);

	/* So far out that float has steps of a sixteenth. */
	put_box(&o, 0, 1000, (double[3]){20, 10, 5}, 0);
	for (size_t i = 0; i < 3000; i++)
		o.splats.means[i] += 1e6f;
	find(&x, &o, 1000);
	CHECK(x.n == 1000 && fabs(x.aligned.centre[0] - 1e6) < 0.2 && fabs(x.aligned.half[0] - 10) < 0.3,
		"far: %.9g, %g", x.aligned.centre[0], x.aligned.half[0]);
	extent_free(&x);

	/* Tiny and enormous responses, as a trained model may have. */
	for (size_t i = 0; i < 1000; i++)
		o.responses[i] = i % 7 ? 1e-30f : 1e30f;
	find(&x, &o, 1000);
	CHECK(isfinite(x.aligned.half[0]) && x.aligned.half[0] > 9, "responses: %g", x.aligned.half[0]);
	extent_free(&x);
	splats_free(&o.splats);
}

/* Every up gives a box whose third axis it is, with axes at right angles. */
static void up_is_kept(void)
{
	static struct object o;
	struct rng rng;
	struct err e;

	rng_seed(&rng, 2, 1);
	object_begin(&o, 100);
	put_box(&o, 0, 100, (double[3]){3, 1, 1}, 0.5);
	for (int i = 0; i < 50; i++) {
		struct extent x;
		double q[4], m[3][3];
		for (int k = 0; k < 4; k++)
			q[k] = i < 4 ? k == i : rng_uniform(&rng) - 0.5;
		rotation_of_quat(q, m);
		CHECK(!extent_find(&x, &o.splats, o.ids, o.responses, 100, m[2], &e), "out of memory");
		const double(*a)[3] = x.turned.axes;
		for (int j = 0; j < 3; j++) {
			const double *u = a[j], *v = a[(j + 1) % 3], *w = a[(j + 2) % 3];
			const double dot = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
			const double cross = u[1] * v[2] - u[2] * v[1];
			CHECK(fabs(dot) < 1e-12 && fabs(cross - w[0]) < 1e-12, "axes %d of %d", j, i);
			CHECK(a[2][j] == m[2][j], "up of %d", i);
		}
		extent_free(&x);
	}
	splats_free(&o.splats);
}

/* The true boxes touch a dense sample of the surface on all sides, and nothing sticks out. */
static void true_boxes_are_tight(void)
{
	for (int shape = 0; shape < SYNTH_SHAPES; shape++)
		for (int turn = 0; turn < 3; turn++) {
			struct synth_object o = {.shape = (enum synth_shape)shape,
				.size = SYNTH_BIG,
				.x = 1,
				.y = -2,
				.z = 0.5,
				.yaw = 2.3 * turn};
			struct synth_surface s;
			struct box boxes[2];
			double most[2][3] = {{0}}, least[2][3] = {{0}};
			synth_object_measure(&o);
			synth_object_surface(&s, o.shape);
			synth_object_boxes(&o, &boxes[0], &boxes[1]);
			for (int i = 0; i < 300 * 300; i++) {
				struct synth_spot spot;
				double p[3];
				synth_surface_spot(
					&s, (i % 300 + 0.5) / 300, (i / 300 + 0.5) / 300.0, 0, &spot);
				synth_object_place(&o, spot.point, p);
				for (int b = 0; b < 2; b++)
					for (int k = 0; k < 3; k++) {
						const double *axis = boxes[b].axes[k], *c = boxes[b].centre;
						const double at =
							(axis[0] * (p[0] - c[0]) + axis[1] * (p[1] - c[1]) +
								axis[2] * (p[2] - c[2])) /
							boxes[b].half[k];
						most[b][k] = fmax(most[b][k], at);
						least[b][k] = fmin(least[b][k], at);
					}
			}
			for (int b = 0; b < 2; b++)
				for (int k = 0; k < 3; k++)
					CHECK(most[b][k] > 0.9 && most[b][k] < 1 + 1e-9 &&
							least[b][k] < -0.9 && least[b][k] > -1 - 1e-9,
						"%s, box %d, axis %d: %g to %g",
						synth_value_name(SYNTH_SHAPE, (int)o.shape), b, k,
						least[b][k], most[b][k]);
		}
}

/* What is shown of a scene: with, without, and painted. */
static void scenes_to_show(void)
{
	static struct object o;
	static char of[500];
	struct splats with, without, painted;
	struct err e;

	object_begin(&o, 500);
	put_box(&o, 0, 500, (double[3]){1, 1, 1}, 0);
	memset(of, 1, 200);
	CHECK(!locate_show(&with, &o.splats, of, LOCATE_ISOLATED, &e) &&
			!locate_show(&without, &o.splats, of, LOCATE_REMOVED, &e) &&
			!locate_show(&painted, &o.splats, of, LOCATE_COLOURED, &e),
		"out of memory");
	CHECK(with.n == 200 && without.n == 300 && painted.n == 500, "%zu %zu %zu", with.n, without.n,
		painted.n);
	CHECK(with.sh_coefficients == 4 && !memcmp(with.sh, o.splats.sh, with.n * 12 * sizeof(float)),
		"colours");
	CHECK(painted.sh[0] > o.splats.sh[0] && painted.sh[2] < o.splats.sh[2] &&
			painted.sh[3] < o.splats.sh[3],
		"not painted");
	CHECK(painted.sh[12 * 499] == 0.5f, "painted too much");
	splats_free(&with);
	splats_free(&without);
	splats_free(&painted);
	splats_free(&o.splats);
}

int main(void)
{
	a_turned_box_is_found();
	a_few_wrong_ones_do_no_harm();
	what_sticks_out_counts_by_its_weight();
	parts_stay_together();
	hard_cases();
	up_is_kept();
	true_boxes_are_tight();
	scenes_to_show();
	return unit_end();
}
