#include "unit.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/rng.h"
#include "formats/splats/anysplats.h"
#include "formats/splats/ply.h"

#include <float.h>
#include <stdint.h>
#include <unistd.h>

/* A file in the making. */
struct bytes {
	unsigned char data[65536];
	size_t len;
	int encoding; /* 0 ascii, 1 little-endian, 2 big-endian */
};

static char path[] = "/tmp/test_ply.XXXXXX";

static void put_text(struct bytes *b, const char *text)
{
	size_t len = strlen(text);

	memcpy(b->data + b->len, text, len);
	b->len += len;
}

/* type: 'c' 'C' 's' 'S' 'i' 'I' for signed and unsigned integers of 1, 2, 4 bytes, 'f', 'd'. */
static void put_value(struct bytes *b, char type, double value)
{
	size_t size = strchr("cC", type) ? 1 : strchr("sS", type) ? 2 : type == 'd' ? 8 : 4;
	float single = (float)value;
	uint64_t bits = strchr("fd", type) ? 0 : (uint64_t)(int64_t)value;
	uint32_t low;

	if (b->encoding == 0) {
		char word[40];
		snprintf(word, sizeof word, "%.17g ", type == 'f' ? (double)single : value);
		put_text(b, word);
		return;
	}
	if (type == 'f') {
		memcpy(&low, &single, 4);
		bits = low;
	} else if (type == 'd') {
		memcpy(&bits, &value, 8);
	}
	for (size_t i = 0; i < size; i++)
		b->data[b->len++] = (unsigned char)(bits >> 8 * (b->encoding == 2 ? size - 1 - i : i));
}

static int file; /* open on path all the time: closing a truncated file may wait for the disk */

static void save(const unsigned char *data, size_t len)
{
	if (pwrite(file, data, len, 0) != (ssize_t)len || ftruncate(file, (off_t)len)) {
		perror(path);
		exit(1);
	}
}

/* The properties, in an order and of types that no writer has. f_rest_k of Gaussian i is k + i/8. */
static const char *const foreign =
	"property double rot_3\nproperty list uchar short tags\nproperty float z\n"
	"property int x\nproperty short y\nproperty float opacity\n"
	"property float f_dc_2\nproperty float f_dc_0\nproperty float f_dc_1\n"
	"property float scale_2\nproperty float scale_1\nproperty float scale_0\n"
	"property char rot_0\nproperty ushort rot_1\nproperty uint rot_2\nproperty uint8 extra\n";

/* n Gaussians, with an element before the vertices and one after, both with lists. */
static void build_foreign(struct bytes *b, int encoding, int n, int rest)
{
	static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
	char line[120];

	b->len = 0;
	b->encoding = encoding;
	snprintf(line, sizeof line, "ply\nformat %s 1.0\ncomment made by a test\nelement camera 2\n",
		names[encoding]);
	put_text(b, line);
	put_text(b, "property float fov\nproperty list int double path\n");
	snprintf(line, sizeof line, "element vertex %d\n", n);
	put_text(b, line);
	put_text(b, foreign);
	for (int k = rest; k-- > 0;) {
		snprintf(line, sizeof line, "property float32 f_rest_%d\n", k);
		put_text(b, line);
	}
	put_text(b, "element face 1\nproperty list uint8 int vertex_indices\nend_header\n");
	for (int i = 0; i < 2; i++) {
		put_value(b, 'f', 0.5);
		put_value(b, 'i', i);
		for (int k = 0; k < i; k++)
			put_value(b, 'd', 7);
	}
	for (int i = 0; i < n; i++) {
		put_value(b, 'd', 0.25);
		put_value(b, 'C', i % 3);
		for (int k = 0; k < i % 3; k++)
			put_value(b, 's', -3);
		put_value(b, 'f', 2.5 + i);
		put_value(b, 'i', -5 - i);
		put_value(b, 's', i - 2);
		put_value(b, 'f', 0);
		put_value(b, 'f', 30);
		put_value(b, 'f', 10);
		put_value(b, 'f', 20);
		put_value(b, 'f', 2);
		put_value(b, 'f', 1);
		put_value(b, 'f', 0);
		put_value(b, 'c', -1);
		put_value(b, 'S', 65535);
		put_value(b, 'I', 3);
		put_value(b, 'C', 255);
		for (int k = rest; k-- > 0;)
			put_value(b, 'f', k + i / 8.0);
	}
	put_value(b, 'C', 3);
	for (int k = 0; k < 3; k++)
		put_value(b, 'i', k);
}

static void any_layout(int encoding, int rest)
{
	static struct bytes b;
	struct splats s;
	struct err e = {0};
	double offset[3] = {1, 1, 1};
	int channel = rest / 3;

	build_foreign(&b, encoding, 4, rest);
	save(b.data, b.len);
	int bad = anysplats_read(&s, offset, NULL, path, &e);
	if (!CHECK(!bad, "encoding %d, %d f_rest: %s", encoding, rest, e.message))
		return;
	CHECK(s.n == 4 && s.sh_coefficients == 1 + channel, "%zu Gaussians, K = %d", s.n, s.sh_coefficients);
	CHECK(offset[0] == 0 && offset[1] == 0 && offset[2] == 0, "near the origin");
	for (int i = 0; i < 4; i++) {
		const float *m = s.means + 3 * i, *c = s.scales + 3 * i, *q = s.quats + 4 * i;
		const float *sh = s.sh + 3 * (1 + channel) * i;
		CHECK(m[0] == -5 - i && m[1] == i - 2 && m[2] == 2.5f + (float)i, "mean %g %g %g", m[0], m[1],
			m[2]);
		CHECK(c[0] == 1 && c[1] == (float)exp(1) && c[2] == (float)exp(2), "scale %g %g %g", c[0],
			c[1], c[2]);
		CHECK(q[0] == -1 && q[1] == 65535 && q[2] == 3 && q[3] == 0.25f, "quaternion %g %g %g %g",
			q[0], q[1], q[2], q[3]);
		CHECK(s.opacities[i] == 0.5f, "opacity %g", s.opacities[i]);
		CHECK(sh[0] == 10 && sh[1] == 20 && sh[2] == 30, "base colour %g %g %g", sh[0], sh[1], sh[2]);
		/* The file has all of red, then green, then blue; coefficient k of channel c is number c
		 * (K-1) + k. */
		for (int k = 0; k < channel; k++)
			for (int c2 = 0; c2 < 3; c2++) {
				float want = (float)(c2 * channel + k + i / 8.0), have = sh[3 * (k + 1) + c2];
				CHECK(have == want, "sh %d %d is %g, not %g", k, c2, have, want);
			}
	}
	splats_free(&s);
}

/* Every file cut short is refused, whatever is cut; a changed byte never does harm. */
static void broken(int encoding)
{
	static struct bytes b;
	struct splats s;
	double offset[3] = {0};
	int accepted = 0, wrong_code = 0;

	build_foreign(&b, encoding, 3, 9);
	/* The last value of an ascii file may lose its last blank. */
	for (size_t len = 0; len + (encoding == 0 ? 2 : 0) < b.len; len++) {
		struct err e = {0};
		save(b.data, len);
		if (!anysplats_read(&s, offset, NULL, path, &e)) {
			accepted++;
			splats_free(&s);
		} else {
			wrong_code += e.code != ERR_FORMAT || s.means != NULL;
		}
	}
	CHECK(accepted == 0, "encoding %d: %d cut files were read", encoding, accepted);
	CHECK(wrong_code == 0, "encoding %d: %d cut files gave another error", encoding, wrong_code);
	for (size_t at = 0; at < b.len; at++) {
		struct err e = {0};
		struct rows_report report;
		b.data[at] ^= 0xff;
		save(b.data, b.len);
		if (!anysplats_read(&s, offset, &report, path, &e)) {
			splats_free(&s);
			free(report.dropped);
		} else {
			wrong_code += e.code != ERR_FORMAT || report.dropped != NULL;
		}
		b.data[at] ^= 0xff;
	}
	CHECK(wrong_code == 0, "encoding %d: %d changed files gave another error", encoding, wrong_code);
}

/* A random scene, opacities and scales with their extremes in it. */
static void make_splats(struct splats *s, size_t n, int k)
{
	struct err e;
	struct rng r;

	if (splats_alloc(s, n, k, &e))
		exit(1);
	rng_seed(&r, 7, (uint64_t)k);
	for (size_t i = 0; i < n; i++) {
		s->opacities[i] = i < 2 ? (float)i : (float)rng_uniform(&r);
		for (int c = 0; c < 3; c++) {
			s->means[3 * i + (size_t)c] = (float)rng_normal(&r);
			s->scales[3 * i + (size_t)c] = i == 3 ? 0 : (float)exp(rng_range(&r, -12, 3));
		}
		for (int c = 0; c < 4; c++)
			s->quats[4 * i + (size_t)c] = (float)rng_normal(&r);
	}
	for (size_t i = 0; i < 3 * n * (size_t)k; i++)
		s->sh[i] = (float)rng_normal(&r);
}

static void round_trip(int k, const double offset[3])
{
	struct splats a, b = {0};
	struct err e = {0};
	double back[3] = {0}, worst_mean = 0, worst_scale = 0, worst_opacity = 0;
	size_t n = 200;

	make_splats(&a, n, k);
	int bad = ply_write(&a, offset, path, &e) || anysplats_read(&b, back, NULL, path, &e);
	if (!CHECK(!bad, "K = %d: %s", k, e.message) || !b.means)
		return;
	CHECK(b.n == n && b.sh_coefficients == k, "%zu Gaussians, K = %d", b.n, b.sh_coefficients);
	for (size_t i = 0; i < 3 * n; i++) {
		double want = a.means[i] + offset[i % 3], have = b.means[i] + back[i % 3];
		worst_mean = fmax(worst_mean, fabs(want - have));
		worst_scale = fmax(worst_scale,
			fabs((double)a.scales[i] - b.scales[i]) / fmax((double)a.scales[i], 1e-30));
	}
	for (size_t i = 0; i < n; i++)
		worst_opacity = fmax(worst_opacity, fabs((double)a.opacities[i] - b.opacities[i]));
	CHECK(worst_mean < 1e-6, "means off by %g", worst_mean);
	CHECK(worst_scale < 2e-6, "scales off by a factor of 1 + %g", worst_scale);
	CHECK(worst_opacity < 2e-7, "opacities off by %g", worst_opacity);
	CHECK(b.opacities[0] == 0 && b.opacities[1] == 1, "opacities 0 and 1 are %g and %g", b.opacities[0],
		b.opacities[1]);
	CHECK(b.scales[9] >= 0 && b.scales[9] <= FLT_TRUE_MIN, "scale 0 is %g", b.scales[9]);
	CHECK(!memcmp(a.quats, b.quats, n * 16), "quaternions changed");
	CHECK(!memcmp(a.sh, b.sh, n * 12 * (size_t)k), "spherical harmonics changed");
	int is_far = fabs(offset[0]) > 1000;
	CHECK(is_far == (back[0] != 0) && back[0] == round(back[0]), "offset %g becomes %g", offset[0],
		back[0]);
	splats_free(&a);
	splats_free(&b);
}

/* A file that is likely like another gives what it gives alone: rows that moved or turned, that changed else,
 * that cannot be used, and none of them. */
static void like_another(int k, const double offset[3])
{
	const size_t n = 200, width = 3 * (size_t)k;
	struct splats a, first = {0}, plain = {0}, quick = {0};
	struct ply_like like = {0};
	struct rows_report one, two;
	struct err e = {0};
	double at[3], from[3];

	make_splats(&a, n, k);
	int bad = ply_write(&a, offset, path, &e) || anysplats_read(&first, at, NULL, path, &e) ||
		  file_map(path, &like.map, &e);
	like.splats = &first;
	CHECK(!unlink(path), "the map stays");
	for (size_t i = 0; i < n; i += 3) {
		a.means[3 * i] += (float)i;
		a.quats[4 * i] = i % 9 ? a.quats[4 * i] : -a.quats[4 * i];
		a.opacities[i] *= i % 4 ? 1 : 0.5f;
		a.sh[width * i + width - 1] += i % 5 ? 0 : 1;
	}
	a.means[3 * 30] = NAN;
	memset(a.quats + 4 * 31, 0, 4 * sizeof *a.quats);
	a.quats[4 * 33] = INFINITY;
	bad = bad || ply_write(&a, offset, path, &e) || anysplats_read(&plain, at, &one, path, &e) ||
	      anysplats_read_like(&quick, from, &two, path, &like, &e);
	if (!CHECK(!bad, "%s", e.message))
		return;
	CHECK(one.not_finite == 2 && one.zero_quat == 1 && two.not_finite == 2 && two.zero_quat == 1,
		"%zu and %zu", two.not_finite, two.zero_quat);
	CHECK(plain.n == n - 3 && quick.n == n - 3 && !memcmp(at, from, sizeof at), "%zu", quick.n);
	CHECK(!memcmp(plain.means, quick.means, plain.n * 12) &&
			!memcmp(plain.quats, quick.quats, plain.n * 16) &&
			!memcmp(plain.scales, quick.scales, plain.n * 12) &&
			!memcmp(plain.opacities, quick.opacities, plain.n * 4) &&
			!memcmp(plain.sh, quick.sh, plain.n * 12 * (size_t)k),
		"not the same");
	free(one.dropped);
	free(two.dropped);
	file_unmap(&like.map);
	for (int i = 0; i < 4; i++)
		splats_free((struct splats *[]){&a, &first, &plain, &quick}[i]);
}

/* A file of the plain layout, of doubles: what a row holds is x y z, dc, opacity, scale, rot. */
static void build_plain(struct bytes *b, int n, double rows[][14])
{
	static const char *const names[] = {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
		"scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"};
	char line[80];

	b->len = 0;
	b->encoding = 1;
	snprintf(line, sizeof line, "ply\r\nformat binary_little_endian 1.0\r\nelement vertex %d\r\n", n);
	put_text(b, line);
	for (int k = 0; k < 14; k++) {
		snprintf(line, sizeof line, "property double %s\r\n", names[k]);
		put_text(b, line);
	}
	put_text(b, "end_header\r\n");
	for (int i = 0; i < n; i++)
		for (int k = 0; k < 14; k++)
			put_value(b, 'd', rows[i][k]);
	save(b->data, b->len);
}

static void left_out(void)
{
	static struct bytes b;
	double rows[26][14];
	struct splats s;
	struct rows_report report;
	struct err e = {0};
	double offset[3] = {0};

	for (int i = 0; i < 26; i++)
		for (int k = 0; k < 14; k++)
			rows[i][k] = 1 + i;
	for (int k = 0; k < 14; k++)
		rows[1 + k][k] = k == 8 ? INFINITY : k % 3 == 0 ? NAN : k % 3 == 1 ? INFINITY : -INFINITY;
	rows[16][8] = 89;    /* exp is above the floats */
	rows[17][1] = 3e38;  /* finite, but its distance from an offset need not be */
	rows[18][4] = 1e300; /* a double beyond the floats */
	rows[19][7] = rows[19][8] = rows[19][9] = 88.5; /* each is a float, their sum is not */
	memset(&rows[20][10], 0, 4 * sizeof(double));
	memset(&rows[21][10], 0, 4 * sizeof(double));
	rows[21][13] = -1e-200;
	for (int k = 10; k < 14; k++)
		rows[22][k] = 1e37;
	for (int k = 7; k < 10; k++) /* what has a limit: opaque and clear, and flat */
		rows[24][k] = rows[25][k] = k == 9 ? -INFINITY : 0;
	rows[24][6] = INFINITY;
	rows[25][6] = -INFINITY;
	build_plain(&b, 26, rows);
	int bad = anysplats_read(&s, offset, &report, path, &e);
	if (!CHECK(!bad, "%s", e.message))
		return;
	CHECK(report.read == 26 && report.not_finite == 18 && report.zero_quat == 1,
		"read %zu, left out %zu and %zu", report.read, report.not_finite, report.zero_quat);
	for (size_t i = 0; i < 19; i++) {
		size_t want = i < 14 ? i + 1 : i + 2;
		CHECK(report.dropped[i] == want, "left out %zu in place of %zu", report.dropped[i], want);
	}
	CHECK(s.n == 7 && s.means[0] == 1 && s.means[3] == 16 && s.means[6] == 22, "the others moved up");
	CHECK(s.opacities[5] == 1 && s.opacities[6] == 0 && s.scales[15] == 1 && s.scales[17] == 0,
		"infinite: opacities %g and %g, scale %g", s.opacities[5], s.opacities[6], s.scales[17]);
	CHECK(s.quats[8] == 0 && s.quats[11] == -1, "a tiny quaternion is made one: %g", s.quats[11]);
	CHECK(s.quats[12] == 0.5f && s.quats[15] == 0.5f, "a huge one too: %g", s.quats[12]);
	splats_free(&s);
	free(report.dropped);
	build_plain(&b, 14, rows + 1);
	CHECK(anysplats_read(&s, offset, &report, path, &e) &&
			strstr(e.message, "none of its 14 Gaussians can be used: 14 have a value"),
		"%s", e.message);
}

static void recentring(void)
{
	static struct bytes b;
	double rows[5][14];
	struct splats s;
	struct err e = {0};
	double offset[3] = {0};

	for (int i = 0; i < 5; i++) {
		for (int k = 0; k < 14; k++)
			rows[i][k] = 0.5;
		rows[i][0] = 1e6 + 0.001 * i;
		rows[i][1] = -4000000.25 + i;
		rows[i][2] = 3;
	}
	build_plain(&b, 5, rows);
	int bad = anysplats_read(&s, offset, NULL, path, &e);
	if (!CHECK(!bad, "%s", e.message))
		return;
	CHECK(offset[0] == 1e6 && offset[1] == -3999998 && offset[2] == 3, "offset %g %.9g %g", offset[0],
		offset[1], offset[2]);
	for (int i = 0; i < 5; i++)
		CHECK(fabs(s.means[3 * i] - 0.001 * i) < 1e-9, "a millimetre at a thousand kilometres: %g",
			s.means[3 * i]);
	splats_free(&s);
	for (int i = 0; i < 5; i++) { /* as far from the origin as it is large */
		rows[i][0] = 100 * i;
		rows[i][1] = 20;
	}
	build_plain(&b, 5, rows);
	CHECK(!anysplats_read(&s, offset, NULL, path, &e) && offset[0] == 0 && offset[1] == 0 &&
			offset[2] == 0,
		"offset %g %g %g", offset[0], offset[1], offset[2]);
	splats_free(&s);
}

/* Counts that no file could hold fail before memory is asked for. */
static void huge_counts(void)
{
	static const char *const counts[] = {"99999999", "4294967296", "9223372036854775807",
		"18446744073709551616", "99999999999999999999999"};
	char text[256];
	struct splats s;
	double offset[3] = {0};

	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
		struct err e = {0};
		static struct bytes b;
		build_foreign(&b, 1, 1, 0);
		char *at = strstr((char *)b.data, "element vertex 1");
		size_t head = (size_t)(at - (char *)b.data), len;
		len = (size_t)snprintf(text, sizeof text, "element vertex %s", counts[i]);
		memmove(b.data + head + len, b.data + head + 16, b.len - head - 16);
		memcpy(at, text, len);
		save(b.data, b.len - 16 + len);
		CHECK(anysplats_read(&s, offset, NULL, path, &e) && e.code == ERR_FORMAT, "%s: %s", counts[i],
			e.message);
	}
}

int main(void)
{
	file = mkstemp(path);
	if (file < 0)
		return 1;
	for (int encoding = 0; encoding < 3; encoding++) {
		for (int degree = 0; degree < 4; degree++)
			any_layout(encoding, 3 * (degree + 1) * (degree + 1) - 3);
		broken(encoding);
	}
	left_out();
	recentring();
	huge_counts();
	for (int degree = 0; degree < 4; degree++) {
		round_trip((degree + 1) * (degree + 1), (double[]){0, 0, 0});
		round_trip((degree + 1) * (degree + 1), (double[]){-12345.5, 1e6, 3});
		like_another((degree + 1) * (degree + 1), (double[]){0, 0, 0});
		like_another((degree + 1) * (degree + 1), (double[]){-12345.5, 1e6, 3});
	}
	unlink(path);
	return unit_end();
}
