/* Boxes in space: their common volume, rotations, and which way is up. */
#include "unit.h"

#include "base/rng.h"
#include "geom/box.h"
#include "geom/rotation.h"
#include "geom/up.h"
#include "score/box_score.h"

static struct box random_box(struct rng *rng)
{
	struct box b;
	double q[4], m[3][3];

	for (int k = 0; k < 4; k++)
		q[k] = rng_uniform(rng) - 0.5;
	rotation_of_quat(q, m);
	for (int k = 0; k < 3; k++) {
		b.centre[k] = rng_uniform(rng) - 0.5;
		b.half[k] = 0.2 + rng_uniform(rng);
		for (int d = 0; d < 3; d++)
			b.axes[k][d] = m[d][k];
	}
	return b;
}

static int is_inside(const struct box *b, const double p[3])
{
	for (int k = 0; k < 3; k++) {
		double at = 0;
		for (int d = 0; d < 3; d++)
			at += (p[d] - b->centre[d]) * b->axes[k][d];
		if (fabs(at) > b->half[k])
			return 0;
	}
	return 1;
}

/* By points on a grid in a: its error falls with their number. */
static double sampled_iou(const struct box *a, const struct box *b)
{
	enum { SIDE = 60 };
	long inside = 0;

	for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
		const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
		double p[3] = {a->centre[0], a->centre[1], a->centre[2]};
		for (int k = 0; k < 3; k++)
			for (int d = 0; d < 3; d++)
				p[d] += ((at[k] + 0.5) / SIDE * 2 - 1) * a->half[k] * a->axes[k][d];
		inside += is_inside(b, p);
	}
	const double common = box_volume(a) * (double)inside / (SIDE * SIDE * SIDE);
	return common / (box_volume(a) + box_volume(b) - common);
}

static void iou_agrees_with_counting(void)
{
	struct rng rng;

	rng_seed(&rng, 7, 1);
	for (int i = 0; i < 20; i++) {
		const struct box a = random_box(&rng), b = random_box(&rng);
		CHECK(fabs(box_iou(&a, &b) - sampled_iou(&a, &b)) < 4e-3, "%g, counted %g", box_iou(&a, &b),
			sampled_iou(&a, &b));
		CHECK(fabs(box_iou(&a, &b) - box_iou(&b, &a)) < 1e-8, "pair %d", i);
		CHECK(fabs(box_iou(&a, &a) - 1) < 1e-8, "with itself: %.12g", box_iou(&a, &a));
	}
}

static void iou_of_known_boxes(void)
{
	const double zero[3] = {0}, one[3] = {1, 1, 1};
	const struct box a = box_between(zero, one);
	struct box b = box_between((double[3]){0.5, 0, 0}, (double[3]){1.5, 1, 1});

	CHECK(fabs(box_iou(&a, &b) - 1 / 3.0) < 1e-8, "half beside: %g", box_iou(&a, &b));
	b = box_between((double[3]){0.25, 0.25, 0.25}, (double[3]){0.75, 0.75, 0.75});
	CHECK(fabs(box_iou(&a, &b) - 0.125) < 1e-8, "inside: %g", box_iou(&a, &b));
	CHECK(fabs(box_iou(&b, &a) - 0.125) < 1e-8, "around: %g", box_iou(&b, &a));
	b = box_between((double[3]){1, 0, 0}, (double[3]){2, 1, 1});
	CHECK(box_iou(&a, &b) < 1e-8, "touching: %g", box_iou(&a, &b));
	b = box_between((double[3]){3, 0, 0}, (double[3]){4, 1, 1});
	CHECK(box_iou(&a, &b) == 0, "apart: %g", box_iou(&a, &b));
	b = box_between(zero, (double[3]){1, 1, 0});
	CHECK(box_iou(&a, &b) == 0 && box_iou(&b, &b) == 0, "flat");

	/* Turned by 45 degrees about z: what both have is an octagon of 2 sqrt(2) - 2. */
	const double c = sqrt(0.5);
	struct box turned = a;
	const double axes[3][3] = {{c, c, 0}, {-c, c, 0}, {0, 0, 1}};
	memcpy(turned.axes, axes, sizeof axes);
	const double common = 2 * sqrt(2) - 2;
	CHECK(fabs(box_iou(&a, &turned) - common / (2 - common)) < 1e-8, "turned: %g", box_iou(&a, &turned));

	/* The same a million units away. */
	struct box far_a = a, far_turned = turned;
	for (int k = 0; k < 3; k++) {
		far_a.centre[k] += 1e6;
		far_turned.centre[k] += 1e6;
	}
	CHECK(fabs(box_iou(&far_a, &far_turned) - common / (2 - common)) < 1e-6, "far: %g",
		box_iou(&far_a, &far_turned));
}

/* The point of a box that is nearest to p. */
static void nearest_in(const struct box *b, const double p[3], double out[3])
{
	double from[3];

	for (int d = 0; d < 3; d++) {
		from[d] = p[d] - b->centre[d];
		out[d] = b->centre[d];
	}
	for (int k = 0; k < 3; k++) {
		double at = 0;
		for (int d = 0; d < 3; d++)
			at += from[d] * b->axes[k][d];
		at = fmax(-b->half[k], fmin(b->half[k], at));
		for (int d = 0; d < 3; d++)
			out[d] += at * b->axes[k][d];
	}
}

/* By projecting a point onto the one and the other in turn. */
static double projected_gap(const struct box *a, const struct box *b)
{
	double p[3], q[3], square = 0;

	memcpy(q, b->centre, sizeof q);
	for (int i = 0; i < 20000; i++) {
		nearest_in(a, q, p);
		nearest_in(b, p, q);
	}
	for (int d = 0; d < 3; d++)
		square += (p[d] - q[d]) * (p[d] - q[d]);
	return sqrt(square);
}

static void gap_agrees_with_projections(void)
{
	struct rng rng;
	int touching = 0;

	rng_seed(&rng, 8, 1);
	for (int i = 0; i < 200; i++) {
		struct box a = random_box(&rng), b = random_box(&rng);
		for (int k = 0; k < 3; k++)
			b.centre[k] += 3 * (rng_uniform(&rng) - 0.5);
		const double gap = box_gap(&a, &b), twin = projected_gap(&a, &b);
		CHECK(fabs(gap - twin) < 1e-3, "pair %d: %g, projected %g", i, gap, twin);
		CHECK(fabs(gap - box_gap(&b, &a)) < 1e-9, "pair %d", i);
		touching += gap == 0;
	}
	CHECK(touching > 20 && touching < 180, "%d of 200 touch", touching);
}

static void gap_of_known_boxes(void)
{
	const double zero[3] = {0}, one[3] = {1, 1, 1};
	const struct box a = box_between(zero, one);
	struct box b = box_between((double[3]){3, 0.2, 0.2}, (double[3]){4, 0.4, 0.4});

	CHECK(fabs(box_gap(&a, &b) - 2) < 1e-12, "face to face: %g", box_gap(&a, &b));
	b = box_between((double[3]){4, 5, 0}, (double[3]){6, 6, 1});
	CHECK(fabs(box_gap(&a, &b) - 5) < 1e-12, "edge to edge: %g", box_gap(&a, &b));
	b = box_between((double[3]){0.4, 0.4, -1}, (double[3]){0.6, 0.6, 2});
	CHECK(box_gap(&a, &b) == 0, "a stick through it: %g", box_gap(&a, &b));
	b = box_between((double[3]){0.4, 0.4, 0.4}, (double[3]){0.6, 0.6, 0.6});
	CHECK(box_gap(&a, &b) == 0, "inside: %g", box_gap(&a, &b));
}

static void rotations_come_back(void)
{
	struct rng rng;

	rng_seed(&rng, 3, 1);
	for (int i = 0; i < 200; i++) {
		double q[4], m[3][3], p[4], dot = 0, length = 0;
		for (int k = 0; k < 4; k++) {
			q[k] = i < 4 ? k == i : rng_uniform(&rng) - 0.5;
			length += q[k] * q[k];
		}
		rotation_of_quat(q, m);
		rotation_to_quat(m, p);
		for (int k = 0; k < 4; k++)
			dot += q[k] * p[k] / sqrt(length);
		CHECK(fabs(fabs(dot) - 1) < 1e-12 && p[0] >= 0, "%d: %g", i, dot);
	}
}

/* Level cameras that look down from all around a place: their own ups lean inwards, or, from one side only,
 * all the same way. */
static void up_is_what_level_cameras_agree_in(void)
{
	enum { N = 12 };
	struct camera views[N];
	const struct cameras all = {N, views};
	double up[3];

	for (int spread = 0; spread < 3; spread++) {
		const double arc = spread == 0 ? 2 * 3.14159265358979 : spread == 1 ? 1.5 : 0;
		for (int i = 0; i < N; i++) {
			const double turn = arc * i / N, down = 0.6;
			const double rotation[3][3] = {{cos(turn), sin(turn), 0},
				{sin(down) * sin(turn), -sin(down) * cos(turn), -cos(down)},
				{-cos(down) * sin(turn), cos(down) * cos(turn), -sin(down)}};
			views[i] = (struct camera){0};
			for (int k = 0; k < 3; k++)
				memcpy(views[i].world_to_camera[k], rotation[k], sizeof rotation[k]);
			CHECK(fabs(rotation[1][2]) > 0.8, "not level");
		}
		cameras_up(&all, up);
		/* From one direction alone nothing tells how much the cameras look down. */
		CHECK(up[2] > (spread == 2 ? cos(0.61) : cos(0.01)), "arc %g: %g %g %g", arc, up[0], up[1],
			up[2]);
	}
	cameras_up(&(struct cameras){0}, up);
	CHECK(up[0] == 0 && up[1] == 0 && up[2] == 1, "no cameras");
}

static void scores_are_means(void)
{
	const double zero[3] = {0}, one[3] = {1, 1, 1};
	const struct box a = box_between(zero, one),
			 b = box_between((double[3]){0.5, 0, 0}, (double[3]){1.5, 1, 1});
	const struct box_pair pairs[] = {{"x", 0, 0, a, a, a, a}, {"x", 0, 0, b, a, a, a},
		{.name = "y", .is_missing = 1, .true_aligned = a, .true_turned = a},
		{.name = "y", .is_empty = 1, .true_aligned = a, .true_turned = a}};
	struct box_score s;

	box_score_sum(&s, pairs, 4);
	CHECK(s.pairs == 4 && s.missing == 1 && s.empty == 1, "%zu %zu", s.missing, s.empty);
	CHECK(fabs(s.aligned.iou - (1 + 1 / 3.0) / 4) < 1e-8, "%g", s.aligned.iou);
	CHECK(s.aligned.p25 == 0.5 && s.aligned.p50 == 0.25, "%g %g", s.aligned.p25, s.aligned.p50);
	CHECK(s.turned.p50 == 0.5, "%g", s.turned.p50);
	CHECK(fabs(s.distance - 0.25) < 1e-12 && fabs(s.relative - 0.25 / sqrt(3)) < 1e-12, "%g %g",
		s.distance, s.relative);
	box_score_sum(&s, pairs + 2, 2);
	CHECK(isnan(s.distance) && s.aligned.iou == 0, "nothing found");
}

int main(void)
{
	iou_agrees_with_counting();
	iou_of_known_boxes();
	gap_agrees_with_projections();
	gap_of_known_boxes();
	rotations_come_back();
	up_is_what_level_cameras_agree_in();
	scores_are_means();
	return unit_end();
}
