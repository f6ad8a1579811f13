/* SOG: tests/golden/sog, which splat-transform 2.7.1 made of the eight Gaussians of eight.ply, from its
 * folder and as a zip; zips that are cut off or changed. */
#include "read_as.h"
#include "unit.h"

#include "base/file.h"
#include "base/rng.h"
#include "formats/splats/anysplats.h"
#include "formats/splats/ply.h"
#include "formats/splats/sog.h"

#include <minizip/zip.h>
#include <unistd.h>

#define FOLDER "tests/golden/sog/"

enum { N = 8 };

static char path[] = "/tmp/test_sog.XXXXXX";

static void put_file(zipFile zip, const char *name, int method)
{
	char from[80], *data;
	size_t len;
	struct err e;

	snprintf(from, sizeof from, FOLDER "%s", name);
	if (file_read(from, &data, &len, &e)) {
		fprintf(stderr, "%s\n", e.message);
		exit(1);
	}
	zipOpenNewFileInZip(zip, name, NULL, NULL, 0, NULL, 0, NULL, method, method ? 9 : 0);
	zipWriteInFileInZip(zip, data, (unsigned)len);
	zipCloseFileInZip(zip);
	free(data);
}

/* The folder as a zip, packed or not, without the file of that name. */
static void make_zip(int method, const char *without)
{
	static const char *const names[] = {"meta.json", "means_l.webp", "means_u.webp", "quats.webp",
		"scales.webp", "sh0.webp", "shN_centroids.webp", "shN_labels.webp"};
	zipFile zip = zipOpen(path, APPEND_STATUS_CREATE);

	if (!zip)
		exit(1);
	for (size_t i = 0; i < sizeof names / sizeof *names; i++)
		if (!without || strcmp(names[i], without))
			put_file(zip, names[i], method);
	zipClose(zip, NULL);
}

static double distance(const struct splats *a, size_t i, const struct splats *b, size_t k)
{
	double sum = 0;

	for (size_t c = 0; c < 3; c++)
		sum += pow((double)a->means[3 * i + c] - b->means[3 * k + c], 2);
	return sqrt(sum);
}

/* 1 less the dot product of the two unit quaternions, whatever their signs. */
static double turned(const float *p, const float *q)
{
	double dot = 0, a = 0, b = 0;

	for (int k = 0; k < 4; k++) {
		dot += (double)p[k] * q[k];
		a += (double)p[k] * p[k];
		b += (double)q[k] * q[k];
	}
	return 1 - fabs(dot) / sqrt(a * b);
}

/* Each of a is in b, which has another order. A codebook has the mean of values
 * that are close. */
static void check_same(const struct splats *a, const struct splats *b)
{
	if (!CHECK(b->n == N && b->sh_coefficients == 4, "%zu, %d", b->n, b->sh_coefficients))
		return;
	for (size_t i = 0; i < N; i++) {
		size_t near = 0;
		for (size_t k = 1; k < N; k++)
			if (distance(a, i, b, k) < distance(a, i, b, near))
				near = k;
		CHECK(distance(a, i, b, near) < 4e-4, "%zu: %g", i, distance(a, i, b, near));
		for (size_t c = 0; c < 3; c++)
			CHECK(fabsf(a->scales[3 * i + c] / b->scales[3 * near + c] - 1) < 0.06f,
				"%zu: scale %g", i, a->scales[3 * i + c]);
		for (size_t c = 0; c < 12; c++)
			CHECK(fabsf(a->sh[12 * i + c] - b->sh[12 * near + c]) < 0.035f,
				"%zu: harmonic %zu: %g for %g", i, c, b->sh[12 * near + c],
				a->sh[12 * i + c]);
		CHECK(fabsf(a->opacities[i] - b->opacities[near]) < 1 / 254.0f, "%zu: opacity", i);
		CHECK(turned(a->quats + 4 * i, b->quats + 4 * near) < 1e-4, "%zu: %g", i,
			turned(a->quats + 4 * i, b->quats + 4 * near));
	}
}

static void test_golden(const struct splats *a)
{
	struct splats b;
	struct err e;
	double offset[3];
	struct file_map map;

	if (CHECK(!anysplats_read(&b, offset, NULL, FOLDER "meta.json", &e), "%s", e.message))
		check_same(a, &b);
	splats_free(&b);
	for (int method = 0; method <= Z_DEFLATED; method += Z_DEFLATED) {
		make_zip(method, NULL);
		if (CHECK(!file_map(path, &map, &e) && !read_as(sog_read_map, &b, offset, &map, &e), "%s",
			    e.message))
			check_same(a, &b);
		splats_free(&b);
	}
}

static void test_missing(void)
{
	static const char *const names[] = {"meta.json", "means_u.webp", "sh0.webp", "shN_labels.webp"};
	struct splats b;
	struct err e;
	double offset[3];
	struct file_map map;
	char expected[80];

	for (int i = 0; i < 4; i++) {
		make_zip(0, names[i]);
		snprintf(expected, sizeof expected,
			"f: no file '%s' in the zip: unzip it if it is a packed file", names[i]);
		CHECK(!file_map(path, &map, &e) && read_as(sog_read_map, &b, offset, &map, &e) &&
				e.code == ERR_FORMAT && !strcmp(e.message, expected),
			"%s", e.message);
	}
}

/* Every shorter file is refused; one with a changed byte is refused or read, and nothing else. */
static void test_damage(int method)
{
	struct rng r;
	struct splats b;
	struct err e;
	double offset[3];
	char *bytes;
	size_t len;
	int read = 0, refused = 0;

	make_zip(method, NULL);
	if (file_read(path, &bytes, &len, &e))
		exit(1);
	rng_seed(&r, 3, 0);
	for (size_t at = 0; at < len; at++) {
		struct file_map cut = {malloc(at + 1), at, 0}, changed = {malloc(len), len, 0};
		memcpy((void *)(size_t)cut.data, bytes, at);
		memcpy((void *)(size_t)changed.data, bytes, len);
		*(unsigned char *)(size_t)(changed.data + at) ^= (unsigned char)(1 + rng_below(&r, 255));
		if (!read_as(sog_read_map, &b, offset, &cut, &e)) {
			/* minizip does without the last bytes, which say how long the comment is. */
			read += at + 3 < len;
			splats_free(&b);
		}
		if (read_as(sog_read_map, &b, offset, &changed, &e))
			refused++;
		splats_free(&b);
	}
	CHECK(!read, "%d cuts are read", read);
	CHECK(refused > (int)len / 4, "%d of %zu changes are refused", refused, len);
	free(bytes);
}

int main(void)
{
	struct splats a;
	struct err e;
	double offset[3];
	const int file = mkstemp(path);

	if (file < 0)
		return 1;
	if (CHECK(!anysplats_read(&a, offset, NULL, FOLDER "eight.ply", &e), "%s", e.message))
		test_golden(&a);
	test_missing();
	test_damage(0);
	test_damage(Z_DEFLATED);
	splats_free(&a);
	close(file);
	unlink(path);
	return unit_end();
}
