/* .sog written and read back within the bounds of formats/splats/sog.md; its codebooks and palettes beside
 * naive ones. */
#include "read_as.h"
#include "unit.h"

#include "base/rng.h"
#include "formats/splats/sog.h"
#include "splat/palette.h"

#include <unistd.h>

enum { N = 3000, WIDTH = 9, ROWS = 500 };

static char path[] = "/tmp/test_sog_write.XXXXXX";

static int nearest(const double codes[PALETTE_CODES], double x)
{
	int best = 0;

	for (int k = 1; k < PALETTE_CODES; k++)
		if (fabs(codes[k] - x) < fabs(codes[best] - x))
			best = k;
	return best;
}

static void test_codebook(struct rng *r)
{
	static float values[N];
	double codes[PALETTE_CODES], error = 0, even = 0, low = 1e9, high = -1e9;
	struct err e;

	for (int i = 0; i < N; i++) {
		const double u = rng_range(r, -1, 1);
		values[i] = (float)(u * u * u * 5);
		low = fmin(low, (double)values[i]);
		high = fmax(high, (double)values[i]);
	}
	CHECK(!palette_codebook(codes, values, N, &e), "%s", e.message);
	for (int k = 1; k < PALETTE_CODES; k++)
		CHECK(codes[k] >= codes[k - 1], "code %d falls", k);
	for (int i = 0; i < N; i++) {
		const double x = (double)values[i], step = (high - low) / (PALETTE_CODES - 1);
		const double off = fabs(codes[palette_code(codes, x)] - x);
		CHECK(fabs(off - fabs(codes[nearest(codes, x)] - x)) < 1e-12, "%g has not the nearest code",
			x);
		error += off * off;
		const double far = x - low - step * rint((x - low) / step);
		even += far * far;
	}
	/* the best density of codes, the cube root of the values', would have 0.71 of it */
	CHECK(error < 0.72 * even, "squared error %g, of even steps %g", error, even);
	/* few different values are kept as they are */
	for (int i = 0; i < N; i++)
		values[i] = (float)(i % 200) * 0.37f;
	CHECK(!palette_codebook(codes, values, N, &e), "%s", e.message);
	for (int i = 0; i < N; i++)
		CHECK(codes[palette_code(codes, (double)values[i])] == (double)values[i], "%g",
			(double)values[i]);
	CHECK(!palette_codebook(codes, values, 0, &e) && codes[0] == 0 && codes[PALETTE_CODES - 1] == 0,
		"none");
}

/* The squared error of a palette of so many entries; each entry is the mean of its rows. */
static double palette_error(const float *rows, size_t most)
{
	static float centres[ROWS * WIDTH];
	static uint16_t labels[ROWS];
	double error = 0;
	size_t k = 0;
	struct err e;

	if (!CHECK(!palette_rows(centres, &k, labels, rows, ROWS, WIDTH, most, &e) && k <= most,
		    "%zu entries", k))
		return 1e9;
	for (size_t c = 0; c < k; c++)
		for (size_t j = 0; j < WIDTH; j++) {
			double sum = 0, n = 0;
			for (size_t i = 0; i < ROWS; i++)
				if (labels[i] == c) {
					const double off =
						(double)rows[i * WIDTH + j] - (double)centres[c * WIDTH + j];
					sum += (double)rows[i * WIDTH + j];
					error += off * off;
					n++;
				}
			CHECK(n > 0 && fabs(sum / n - (double)centres[c * WIDTH + j]) < 1e-6,
				"entry %zu, %zu", c, j);
		}
	return error;
}

static void test_palette(struct rng *r)
{
	static float rows[ROWS * WIDTH];
	double last = 1e9;

	for (size_t i = 0; i < ROWS * WIDTH; i++)
		rows[i] = (float)rng_range(r, -1, 1) + (float)(i / WIDTH % 10);
	for (size_t most = 1; most <= 512; most *= 8) {
		const double error = palette_error(rows, most);
		CHECK(error < last, "%zu entries have %g, fewer %g", most, error, last);
		last = error;
	}
	CHECK(last < 1e-9, "as many entries as rows: %g", last);
	/* rows that are all one */
	for (size_t i = 0; i < ROWS * WIDTH; i++)
		rows[i] = 2;
	CHECK(palette_error(rows, 64) == 0, "one row");
}

static void fill(struct splats *s, struct rng *r)
{
	for (size_t i = 0; i < 3 * s->n; i++) {
		s->means[i] = (float)rng_range(r, -7, 7);
		s->scales[i] = (float)exp(rng_range(r, -6, 0));
	}
	for (size_t i = 0; i < 4 * s->n; i++)
		s->quats[i] = (float)rng_range(r, -1, 1);
	for (size_t i = 0; i < s->n; i++)
		s->opacities[i] = (float)rng_range(r, 0, 1);
	for (size_t i = 0; i < 3 * (size_t)s->sh_coefficients * s->n; i++)
		s->sh[i] = (float)rng_range(r, -0.5, 0.5);
}

static void check_gaussian(const struct splats *s, size_t i, const struct splats *t, size_t j)
{
	double dot = 0, length = 0;

	CHECK(fabs((double)s->opacities[i] - t->opacities[j]) < 1 / 509.0, "%zu", i);
	for (size_t k = 0; k < 3; k++) {
		CHECK(fabs(log((double)s->scales[3 * i + k] / (double)t->scales[3 * j + k])) < 0.02, "%zu",
			i);
		CHECK(fabs((double)s->sh[3 * (size_t)s->sh_coefficients * i + k] -
			      t->sh[3 * (size_t)s->sh_coefficients * j + k]) < 0.006,
			"%zu", i);
	}
	for (size_t k = 0; k < 4; k++) {
		dot += (double)s->quats[4 * i + k] * t->quats[4 * j + k];
		length += (double)s->quats[4 * i + k] * s->quats[4 * i + k];
	}
	CHECK(2 * acos(fmin(1, fabs(dot) / sqrt(length))) < 0.02, "%zu is turned by %g", i,
		2 * acos(fmin(1, fabs(dot) / sqrt(length))));
}

/* Each Gaussian is found by its place. */
static void check_all(const struct splats *s, const struct splats *t, const double offset[3])
{
	const double step = 2 * log1p(7) / 65535 / 2 * 8 * 1.01;

	for (size_t i = 0; i < s->n; i++) {
		size_t best = 0;
		double least = 1e9;
		for (size_t j = 0; j < t->n; j++) {
			double far = 0;
			for (size_t k = 0; k < 3; k++)
				far = fmax(far,
					fabs((double)s->means[3 * i + k] - t->means[3 * j + k] - offset[k]));
			if (far < least) {
				least = far;
				best = j;
			}
		}
		CHECK(least < step, "Gaussian %zu is %g away, more than %g", i, least, step);
		check_gaussian(s, i, t, best);
	}
}

static void test_round_trip(size_t n, int coefficients, struct rng *r)
{
	static const double origin[3];
	struct splats s, t;
	struct file_map map;
	double offset[3];
	struct err e = {0};

	if (!CHECK(!splats_alloc(&s, n, coefficients, &e), "%s", e.message))
		return;
	fill(&s, r);
	if (!CHECK(!sog_write(&s, origin, path, &e) && !file_map(path, &map, &e) &&
			    !read_as(sog_read_map, &t, offset, &map, &e),
		    "%zu, %d: %s", n, coefficients, e.message))
		return;
	CHECK(t.n == n && t.sh_coefficients == (n ? coefficients : 1), "%zu, %d", t.n, t.sh_coefficients);
	check_all(&s, &t, offset);
	splats_free(&s);
	splats_free(&t);
}

/* Few harmonics are kept as they are, but for the codes. */
static void test_harmonics(void)
{
	static const double origin[3];
	struct splats s, t;
	struct file_map map;
	double offset[3];
	struct err e = {0};
	struct rng r;

	rng_seed(&r, 2, 0);
	if (!CHECK(!splats_alloc(&s, 40, 16, &e), "%s", e.message))
		return;
	fill(&s, &r);
	for (size_t i = 0; i < 40; i++)
		for (size_t k = 0; k < 48; k++)
			s.sh[48 * i + k] = (float)((i % 5 * 7 + k) % 100) / 100;
	for (size_t i = 0; i < 120; i++)
		s.means[i] = (float)(i / 3) / 10;
	if (CHECK(!sog_write(&s, origin, path, &e) && !file_map(path, &map, &e) &&
			    !read_as(sog_read_map, &t, offset, &map, &e),
		    "%s", e.message)) {
		for (size_t i = 0; i < 40; i++) {
			const size_t from = (size_t)lrint(10 * (double)t.means[3 * i]);
			for (size_t k = 0; k < 48; k++)
				CHECK(t.sh[48 * i + k] == s.sh[48 * from + k], "%zu, %zu: %g, not %g", from,
					k, (double)t.sh[48 * i + k], (double)s.sh[48 * from + k]);
		}
		splats_free(&t);
	}
	splats_free(&s);
}

int main(void)
{
	struct rng r;
	const int temporary = mkstemp(path);

	if (temporary < 0)
		return 1;
	rng_seed(&r, 1, 0);
	test_codebook(&r);
	test_palette(&r);
	for (int degree = 0; degree < 4; degree++)
		test_round_trip(300 + (size_t)degree, (degree + 1) * (degree + 1), &r);
	test_round_trip(0, 4, &r);
	test_round_trip(1, 4, &r);
	test_harmonics();
	close(temporary);
	unlink(path);
	return unit_end();
}
