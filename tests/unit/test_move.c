/* Scenes that are moved: harmonics, and the picture that a camera moved alike has of them. Neighbours, by
 * trying all. */
#include "unit.h"

#include "base/rng.h"
#include "geom/neighbours.h"
#include "geom/rotation.h"
#include "splat/move.h"
#include "splat/render.h"

enum { N = 200, SIDE = 48 };

static void fill(struct splats *s, struct rng *r)
{
	for (size_t i = 0; i < s->n; i++) {
		for (size_t k = 0; k < 3; k++) {
			s->means[3 * i + k] = (float)rng_range(r, -1, 1);
			s->scales[3 * i + k] = (float)rng_range(r, 0.02, 0.3);
		}
		for (size_t k = 0; k < 4; k++)
			s->quats[4 * i + k] = (float)rng_range(r, -1, 1);
		s->opacities[i] = (float)rng_range(r, 0.05, 0.9);
		for (size_t k = 0; k < 3 * (size_t)s->sh_coefficients; k++)
			s->sh[3 * (size_t)s->sh_coefficients * i + k] = (float)rng_range(r, -0.4, 0.4);
	}
}

/* The camera of x -> R S x + T: as far in the new units, looking at the same things. */
static struct camera move_camera(const struct camera *c, const struct move *m)
{
	struct camera to = *c;
	double rotation[3][3];

	rotation_of_quat(m->quat, rotation);
	for (int a = 0; a < 3; a++) {
		for (int b = 0; b < 3; b++) {
			to.world_to_camera[a][b] = 0;
			for (int k = 0; k < 3; k++)
				to.world_to_camera[a][b] += c->world_to_camera[a][k] * rotation[b][k];
		}
		to.world_to_camera[a][3] = m->scale * c->world_to_camera[a][3];
		for (int b = 0; b < 3; b++)
			to.world_to_camera[a][3] -= to.world_to_camera[a][b] * m->shift[b];
	}
	return to;
}

static void draw(const struct splats *s, const struct camera *c, float *rgb)
{
	static const float background[3] = {0.2f, 0.3f, 0.4f};
	struct err e;
	struct render_view *v = render_prepare(s, c, &e);

	if (!v || render_colors(v, s, c, background, rgb, &e))
		exit(1);
	render_free(v);
}

/* The picture stays as it is; without turning the harmonics it would not. */
static void test_picture(int coefficients, const struct move *m)
{
	static float before[3 * SIDE * SIDE], after[3 * SIDE * SIDE], plain[3 * SIDE * SIDE];
	const struct camera c = {.width = SIDE,
		.height = SIDE,
		.fx = 60,
		.fy = 60,
		.cx = SIDE / 2.0,
		.cy = SIDE / 2.0,
		.world_to_camera = {{1, 0, 0, 0.1}, {0, 1, 0, -0.2}, {0, 0, 1, 4}, {0, 0, 0, 1}}};
	const struct camera moved = move_camera(&c, m);
	double offset[3] = {0}, worst = 0, without = 0;
	struct rng r;
	struct splats s;
	struct err e;
	float sh[3 * SH_MAX * N];

	rng_seed(&r, 5, 0);
	if (splats_alloc(&s, N, coefficients, &e))
		exit(1);
	fill(&s, &r);
	memcpy(sh, s.sh, 3 * (size_t)coefficients * N * sizeof *sh);
	draw(&s, &c, before);
	splats_move(&s, offset, m);
	draw(&s, &moved, after);
	memcpy(s.sh, sh, 3 * (size_t)coefficients * N * sizeof *sh);
	draw(&s, &moved, plain);
	for (int i = 0; i < 3 * SIDE * SIDE; i++) {
		worst = fmax(worst, fabs((double)before[i] - after[i]));
		without = fmax(without, fabs((double)before[i] - plain[i]));
	}
	/* A Gaussian at the threshold of 1/255 may be in one picture alone. */
	CHECK(worst < 0.006, "%d coefficients: %g", coefficients, worst);
	CHECK(coefficients == 1 || without > 0.05, "%d coefficients: %g without", coefficients, without);
	splats_free(&s);
}

/* Bands keep to themselves, and a turn and its inverse are nothing. */
static void test_turn(void)
{
	const double q[4] = {0.9, 0.1, -0.3, 0.7}, back[4] = {0.9, -0.1, 0.3, -0.7};
	double r[3][3], there[SH_MAX][SH_MAX], again[SH_MAX][SH_MAX], mixed = 0, off = 0;

	rotation_of_quat(q, r);
	sh_turn((const double(*)[3])r, there);
	rotation_of_quat(back, r);
	sh_turn((const double(*)[3])r, again);
	for (int j = 0; j < SH_MAX; j++)
		for (int k = 0; k < SH_MAX; k++) {
			double sum = 0;
			for (int i = 0; i < SH_MAX; i++)
				sum += there[j][i] * again[i][k];
			off = fmax(off, fabs(sum - (j == k)));
			if ((int)sqrt(j) != (int)sqrt(k))
				mixed = fmax(mixed, fabs(there[j][k]));
		}
	CHECK(off < 1e-12 && mixed < 1e-12, "%g, %g", off, mixed);
}

/* A scene with an offset: its world moves as one without. */
static void test_offset(void)
{
	const struct move m = {2, {sqrt(0.5), 0, 0, sqrt(0.5)}, {1, 2, 3}};
	double offset[3] = {100, 0, 0};
	struct splats s;
	struct rng r;
	struct err e;

	rng_seed(&r, 1, 0);
	if (splats_alloc(&s, 1, 1, &e))
		exit(1);
	fill(&s, &r);
	const float x = s.means[0], scale = s.scales[1];
	splats_move(&s, offset, &m);
	/* A quarter turn about z: x becomes y. */
	CHECK(fabs(offset[0] - 1) < 1e-9 && fabs(offset[1] - 202) < 1e-9 && offset[2] == 3, "%g %g %g",
		offset[0], offset[1], offset[2]);
	CHECK(fabsf(s.means[1] - 2 * x) < 1e-6f && fabsf(s.scales[1] - 2 * scale) < 1e-6f, "%g", s.means[1]);
	splats_free(&s);
}

static int rising(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* `steps` different coordinates an axis: with few, many points are the same. */
static void test_neighbours(size_t n, int k, int steps)
{
	static float points[3 * 500], found[500];
	static int32_t near[500 * NEIGHBOURS_MOST];
	static double all[500];
	struct rng r;
	struct err e;
	int wrong = 0;

	rng_seed(&r, n + (size_t)k, (uint64_t)steps);
	for (size_t i = 0; i < 3 * n; i++)
		points[i] = (float)rng_below(&r, (uint32_t)steps) / (float)steps;
	if (!CHECK(!neighbours_find(points, n, k, found, &e), "%s", e.message) ||
		!CHECK(!neighbours_list(points, n, k, near, &e), "%s", e.message))
		return;
	for (size_t i = 0; i < n; i++) {
		size_t others = 0;
		for (size_t j = 0; j < n; j++) {
			const float *p = points + 3 * i, *q = points + 3 * j;
			if (j != i)
				all[others++] =
					sqrt(pow((double)p[0] - q[0], 2) + pow((double)p[1] - q[1], 2) +
						pow((double)p[2] - q[2], 2));
		}
		qsort(all, others, sizeof *all, rising);
		const double right = others >= (size_t)k ? all[k - 1] : INFINITY;
		wrong += right == INFINITY ? found[i] != INFINITY : fabs(found[i] - right) > 1e-6;
		for (int j = 0; j < k; j++) {
			const int32_t other = near[i * (size_t)k + (size_t)j];
			const float *p = points + 3 * i, *q = points + 3 * (other < 0 ? 0 : other);
			const double d = sqrt(pow((double)p[0] - q[0], 2) + pow((double)p[1] - q[1], 2) +
					      pow((double)p[2] - q[2], 2));
			wrong += other < 0 ? others > (size_t)j
					   : other == (int32_t)i || fabs(d - all[j]) > 1e-6;
		}
	}
	CHECK(!wrong, "%zu points, %d nearest, %d steps: %d are wrong", n, k, steps, wrong);
}

int main(void)
{
	static const struct move moves[] = {{1, {1, 0, 0, 0}, {0, 0, 0}},
		{1, {0.3, -0.5, 0.7, 0.2}, {0, 0, 0}}, {2.5, {3, 1, 1, -2}, {5, -6, 7}}};
	static const int steps[] = {100000, 4, 1};

	for (int degree = 0; degree <= 3; degree++)
		for (int i = degree ? 1 : 0; i < 3; i++)
			test_picture((degree + 1) * (degree + 1), &moves[i]);
	test_turn();
	test_offset();
	for (int i = 0; i < 3; i++) {
		test_neighbours(500, 8, steps[i]);
		test_neighbours(300, 1, steps[i]);
		test_neighbours(5, 8, steps[i]);
	}
	test_neighbours(0, 8, 1);
	test_neighbours(1, 8, 1);
	return unit_end();
}
