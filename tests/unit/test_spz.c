/* .spz written and read back in each version, within the bounds of formats/splats/spz.md; files that are cut
 * off. */
#include "read_as.h"
#include "unit.h"

#include "base/rng.h"
#include "formats/splats/spz.h"

#include <unistd.h>

enum { N = 300 };

static char path[] = "/tmp/test_spz.XXXXXX";

static void fill(struct splats *s, struct rng *r, double reach)
{
	for (size_t i = 0; i < s->n; i++) {
		for (size_t k = 0; k < 3; k++) {
			s->means[3 * i + k] = (float)rng_range(r, -reach, reach);
			s->scales[3 * i + k] = (float)exp(rng_range(r, -9.9, 5.8));
		}
		for (size_t k = 0; k < 4; k++)
			s->quats[4 * i + k] = (float)rng_range(r, -1, 1);
		s->opacities[i] = (float)rng_range(r, 0, 1);
		for (size_t k = 0; k < 3 * (size_t)s->sh_coefficients; k++)
			s->sh[3 * (size_t)s->sh_coefficients * i + k] = (float)rng_range(r, -0.93, 0.93);
	}
}

/* The angle between two rotations. */
static double angle(const float *p, const float *q)
{
	double dot = 0, a = 0, b = 0;

	for (int k = 0; k < 4; k++) {
		dot += (double)p[k] * q[k];
		a += (double)p[k] * p[k];
		b += (double)q[k] * q[k];
	}
	return 2 * acos(fmin(1, fabs(dot) / sqrt(a * b)));
}

static int read_back(struct splats *s, double offset[3], struct err *e)
{
	struct file_map map;

	return file_map(path, &map, e) || read_as(spz_read_map, s, offset, &map, e) ? -1 : 0;
}

static double worst(const float *a, const float *b, size_t n, int is_log)
{
	double most = 0;

	for (size_t i = 0; i < n; i++)
		most = fmax(
			most, is_log ? fabs(log((double)a[i] / (double)b[i])) : fabs((double)a[i] - b[i]));
	return most;
}

/* Colours and the two groups of harmonics have bounds of their own. */
static void check_sh(const struct splats *a, const struct splats *b, int version)
{
	static const double bounds[3] = {1 / 76.5 + 1e-6, 1 / 32.0 + 1e-6, 1 / 16.0 + 1e-6};

	for (size_t i = 0; i < a->n; i++)
		for (int k = 0; k < a->sh_coefficients; k++) {
			const size_t at = 3 * ((size_t)a->sh_coefficients * i + (size_t)k);
			const double bound = bounds[k == 0 ? 0 : k < 4 ? 1 : 2];
			if (worst(a->sh + at, b->sh + at, 3, 0) > bound) {
				CHECK(0, "version %d: Gaussian %zu, coefficient %d", version, i, k);
				return;
			}
		}
	CHECK(1, "harmonics");
}

static void test_round_trip(int version, int coefficients, double reach, const double offset[3])
{
	struct rng r;
	struct splats a, b;
	struct err e;
	double back[3], turned = 0, step = ldexp(1, -16);

	rng_seed(&r, (uint64_t)(100 * version + coefficients), 0);
	if (splats_alloc(&a, N, coefficients, &e))
		exit(1);
	fill(&a, &r, reach);
	while ((reach + fabs(offset[1])) / step >= (1 << 23))
		step *= 2;
	int bad = spz_write(&a, offset, version, path, &e) || read_back(&b, back, &e);
	if (!CHECK(!bad, "version %d: %s", version, e.message))
		return;
	CHECK(b.n == N && b.sh_coefficients == coefficients, "%zu, %d", b.n, b.sh_coefficients);
	for (size_t i = 0; i < 3 * N; i++)
		b.means[i] = (float)((double)b.means[i] + back[i % 3] - offset[i % 3]);
	CHECK(worst(a.means, b.means, 3 * N, 0) <= step, "%g", worst(a.means, b.means, 3 * N, 0) / step);
	CHECK(worst(a.scales, b.scales, 3 * N, 1) <= 1 / 32.0 + 1e-5, "%g",
		worst(a.scales, b.scales, 3 * N, 1));
	CHECK(worst(a.opacities, b.opacities, N, 0) <= 1 / 510.0 + 1e-6, "%g",
		worst(a.opacities, b.opacities, N, 0));
	for (size_t i = 0; i < N; i++)
		turned = fmax(turned, angle(a.quats + 4 * i, b.quats + 4 * i));
	CHECK(turned < (version == 2 ? 0.2 : 0.004), "version %d: %g", version, turned);
	check_sh(&a, &b, version);
	splats_free(&a);
	splats_free(&b);
}

/* A file of four Gaussians; *r goes on after them. */
static char *make_file(int version, int coefficients, struct rng *r, size_t *len)
{
	struct splats a;
	struct err e;
	double zero[3] = {0};
	char *bytes;

	rng_seed(r, 7, 0);
	if (splats_alloc(&a, 4, coefficients, &e))
		exit(1);
	fill(&a, r, 10);
	if (spz_write(&a, zero, version, path, &e) || file_read(path, &bytes, len, &e))
		exit(1);
	splats_free(&a);
	return bytes;
}

/* Every shorter file is refused, with one reason. */
static void test_cuts(int version)
{
	struct rng r;
	struct splats b;
	struct err e;
	double zero[3] = {0};
	size_t len;
	char *bytes = make_file(version, 4, &r, &len);
	int kept = 0;

	for (size_t cut = 4; cut < len; cut++) {
		unsigned char *part = malloc(cut);
		struct file_map map = {part, cut, 0};
		memcpy(part, bytes, cut);
		e.message[0] = 0;
		if (!read_as(spz_read_map, &b, zero, &map, &e) || e.code != ERR_FORMAT || !*e.message)
			kept++;
	}
	CHECK(!kept, "version %d: %d cuts are read", version, kept);
	free(bytes);
}

/* A changed byte is refused or makes other Gaussians, but never more than the file has room for. */
static void test_changes(int version)
{
	struct rng r;
	struct splats b;
	struct err e;
	double zero[3] = {0};
	size_t len;
	char *bytes = make_file(version, 9, &r, &len);
	int refused = 0;

	for (size_t at = 0; at < len; at++) {
		unsigned char *changed = malloc(len);
		struct file_map map = {changed, len, 0};
		memcpy(changed, bytes, len);
		changed[at] ^= (unsigned char)(1 + rng_below(&r, 255));
		if (read_as(spz_read_map, &b, zero, &map, &e))
			refused++;
		else
			splats_free(&b);
	}
	CHECK(refused > (int)len / 4, "version %d: %d of %zu refused", version, refused, len);
	free(bytes);
}

static void test_far(void)
{
	struct splats s;
	struct err e;
	double zero[3] = {0};

	if (splats_alloc(&s, 1, 1, &e))
		exit(1);
	s.means[0] = 9e6f;
	s.means[1] = s.means[2] = 0;
	CHECK(spz_write(&s, zero, 3, path, &e) && e.code == ERR_FORMAT &&
			strstr(e.message, "do not fit an .spz"),
		"%s", e.message);
	s.n = 0;
	struct splats b;
	for (int version = 2; version <= 4; version++) {
		CHECK(!spz_write(&s, zero, version, path, &e) && !read_back(&b, zero, &e) && b.n == 0, "%s",
			e.message);
		splats_free(&b);
	}
	s.n = 1;
	splats_free(&s);
}

static void test_flips(void)
{
	/* Y_1 to Y_3 go as y, z, x; Y_4 as xy, Y_10 as xyz, Y_6 as none. */
	CHECK(gaussian_flip_sign(1, FLIP_Y) == -1 && gaussian_flip_sign(2, FLIP_Y) == 1, "degree 1");
	CHECK(gaussian_flip_sign(3, FLIP_X) == -1 && gaussian_flip_sign(4, FLIP_X | FLIP_Y) == 1, "x, xy");
	CHECK(gaussian_flip_sign(10, FLIP_X | FLIP_Y | FLIP_Z) == -1 && gaussian_flip_sign(6, 7) == 1, "xyz");
}

int main(void)
{
	static const double zero[3], far[3] = {1000, -2000, 50};
	const int file = mkstemp(path);

	if (file < 0)
		return 1;
	for (int version = 2; version <= 4; version++) {
		for (int degree = 0; degree <= 3; degree++)
			test_round_trip(version, (degree + 1) * (degree + 1), 20, zero);
		test_round_trip(version, 1, 1000, zero);
		test_cuts(version);
		test_changes(version);
	}
	test_round_trip(3, 1, 20, far);
	test_far();
	test_flips();
	close(file);
	unlink(path);
	return unit_end();
}
