/* .glb written and read back: the same numbers, near the origin and far away; files that are cut off. */
#include "read_as.h"
#include "unit.h"

#include "base/rng.h"
#include "formats/splats/glb.h"

#include <unistd.h>

enum { N = 50 };

static char path[] = "/tmp/test_glb.XXXXXX";

static void fill(struct splats *s, struct rng *r)
{
	for (size_t i = 0; i < 3 * s->n; i++) {
		s->means[i] = (float)rng_range(r, -5, 5);
		s->scales[i] = (float)exp(rng_range(r, -9, 3));
	}
	for (size_t i = 0; i < 4 * s->n; i++)
		s->quats[i] = (float)rng_range(r, -1, 1);
	for (size_t i = 0; i < s->n; i++)
		s->opacities[i] = (float)rng_range(r, 0, 1);
	for (size_t i = 0; i < 3 * (size_t)s->sh_coefficients * s->n; i++)
		s->sh[i] = (float)rng_range(r, -2, 2);
}

static int read_back(struct splats *s, double offset[3], struct err *e)
{
	struct file_map map;

	return file_map(path, &map, e) || read_as(glb_read_map, s, offset, &map, e) ? -1 : 0;
}

/* The largest difference, as a part of the larger number where that is above 1. */
static double worst(const float *a, const float *b, size_t n)
{
	double most = 0;

	for (size_t i = 0; i < n; i++)
		most = fmax(most, fabs((double)a[i] - b[i]) / fmax(1, fabs((double)a[i])));
	return most;
}

static double worst_turn(const struct splats *a, const struct splats *b)
{
	double most = 0;

	for (size_t i = 0; i < a->n; i++) {
		double length = 0, dot = 0;
		for (size_t k = 0; k < 4; k++) {
			length += (double)a->quats[4 * i + k] * a->quats[4 * i + k];
			dot += (double)a->quats[4 * i + k] * b->quats[4 * i + k];
		}
		most = fmax(most, fabs(dot / sqrt(length) - 1));
	}
	return most;
}

static void test_round_trip(int coefficients, const double at[3], struct rng *r)
{
	struct splats s, t;
	struct err e = {0};
	double offset[3];

	if (!CHECK(!splats_alloc(&s, N, coefficients, &e), "%s", e.message))
		return;
	fill(&s, r);
	if (!CHECK(!glb_write(&s, at, path, &e) && !read_back(&t, offset, &e), "%s", e.message))
		return;
	CHECK(t.n == N && t.sh_coefficients == coefficients, "%zu, %d", t.n, t.sh_coefficients);
	for (size_t i = 0; i < 3 * N; i++) {
		const double was = s.means[i] + at[i % 3], is = t.means[i] + offset[i % 3];
		CHECK(fabs(was - is) < 1e-6, "mean %zu: %.9g, not %.9g", i, is, was);
	}
	CHECK(worst(s.scales, t.scales, 3 * N) < 1e-6, "%g", worst(s.scales, t.scales, 3 * N));
	CHECK(worst_turn(&s, &t) < 1e-6, "%g", worst_turn(&s, &t));
	CHECK(worst(s.opacities, t.opacities, N) < 1e-6, "%g", worst(s.opacities, t.opacities, N));
	const size_t n = 3 * (size_t)coefficients * N;
	CHECK(worst(s.sh, t.sh, n) == 0, "%g", worst(s.sh, t.sh, n));
	splats_free(&s);
	splats_free(&t);
}

/* Cut anywhere it is refused; with any byte of the header and the JSON changed nothing breaks. */
static void test_damage(struct rng *r)
{
	static const double origin[3];
	struct splats s, t;
	struct err e = {0};
	double offset[3];
	char *bytes;
	size_t n;

	if (!CHECK(!splats_alloc(&s, 2, 4, &e), "%s", e.message))
		return;
	fill(&s, r);
	if (!CHECK(!glb_write(&s, origin, path, &e) && !file_read(path, &bytes, &n, &e), "%s", e.message))
		return;
	for (size_t cut = 0; cut < n; cut++) {
		char *copy = malloc(cut + 1);
		memcpy(copy, bytes, cut);
		struct file_map map = {(unsigned char *)copy, cut, 0};
		e = (struct err){0};
		CHECK(read_as(glb_read_map, &t, offset, &map, &e) && e.code == ERR_FORMAT, "cut at %zu: %s",
			cut, e.message);
	}
	for (size_t at = 0; at < n; at++) {
		char *copy = malloc(n);
		memcpy(copy, bytes, n);
		copy[at] ^= 1 + (char)(at % 7);
		struct file_map map = {(unsigned char *)copy, n, 0};
		e = (struct err){0};
		if (!read_as(glb_read_map, &t, offset, &map, &e))
			splats_free(&t);
		else
			CHECK(e.code == ERR_FORMAT, "byte %zu: %s", at, e.message);
	}
	free(bytes);
	splats_free(&s);
}

int main(void)
{
	static const double places[2][3] = {{0, 0, 0}, {3e6, -2, 1e5}};
	struct rng r;
	const int temporary = mkstemp(path);

	if (temporary < 0)
		return 1;
	rng_seed(&r, 1, 0);
	for (int degree = 0; degree < 4; degree++)
		for (int k = 0; k < 2; k++)
			test_round_trip((degree + 1) * (degree + 1), places[k], &r);
	test_damage(&r);
	close(temporary);
	unlink(path);
	return unit_end();
}
