#include "unit.h"

#include "formats/splats/ply.h"

#include <stdint.h>
#include <unistd.h>

static char path[] = "/tmp/test_plypacked.XXXXXX";
static int file; /* open on path all the time: closing a truncated file may wait for the disk */

static unsigned char data[32768];
static size_t len;

static void put(uint32_t bits, int size)
{
	for (int i = 0; i < size; i++)
		data[len++] = (unsigned char)(bits >> 8 * i);
}

static void put_float(float value)
{
	uint32_t bits;

	memcpy(&bits, &value, 4);
	put(bits, 4);
}

static void put_text(const char *text)
{
	while (*text)
		data[len++] = (unsigned char)*text++;
}

static void save(size_t bytes)
{
	if (pwrite(file, data, bytes, 0) != (ssize_t)bytes || ftruncate(file, (off_t)bytes))
		exit(1);
}

static const char *const position = "xyz", *const color = "rgb";

/* What of the file differs from a right one. */
struct fault {
	const char *word_type, *sh_type; /* "uint", "uchar" */
	int chunks, sh_rows, sh_after;	 /* sh_after: an element between vertex and sh */
};

static void put_header(int n, int has_color, int rest, const struct fault *fault)
{
	static const char *const words[] = {"position", "rotation", "scale", "color"};
	char line[120];

	len = 0;
	snprintf(
		line, sizeof line, "ply\nformat binary_little_endian 1.0\nelement chunk %d\n", fault->chunks);
	put_text(line);
	for (int kind = 0; kind < (has_color ? 6 : 4); kind++)
		for (int k = 0; k < 3; k++) {
			snprintf(line, sizeof line, "property float %s_%s%c\n", kind % 2 ? "max" : "min",
				kind == 2 || kind == 3 ? "scale_" : "", kind < 4 ? position[k] : color[k]);
			put_text(line);
		}
	snprintf(line, sizeof line, "element vertex %d\n", n);
	put_text(line);
	for (int i = 0; i < 4; i++) {
		snprintf(line, sizeof line, "property %s packed_%s\n", fault->word_type, words[i]);
		put_text(line);
	}
	if (fault->sh_after)
		put_text("element other 0\n");
	if (rest) {
		snprintf(line, sizeof line, "element sh %d\n", fault->sh_rows);
		put_text(line);
	}
	for (int i = 0; i < rest; i++) {
		snprintf(line, sizeof line, "property %s f_rest_%d\n", fault->sh_type, i);
		put_text(line);
	}
	put_text("end_header\n");
}

static const uint32_t rotations[4] = {
	0u << 30 | 1023u << 20 | 0u << 10 |
		0u,		/* w is the largest: x 1/sqrt 2, y and z -1/sqrt 2: too long */
	1u << 30 | 1023u << 20, /* x: w 1/sqrt 2, the others the same: too long as well */
	2u << 30 | 700u << 20 | 300u << 10 | 512u,  /* y: w, x, z */
	3u << 30 | 511u << 20 | 512u << 10 | 1000u, /* z: w, x, y */
};

/* 300 Gaussians in two chunks; those of number 4 k + r have rotation r. The second chunk has other bounds. */
static void build(int has_color, int rest, const struct fault *fault)
{
	put_header(300, has_color, rest, fault);
	for (int c = 0; c < fault->chunks; c++) {
		for (int k = 0; k < 6; k++)
			put_float((float)(k < 3 ? -1 - c
						: k - 2 + c)); /* positions -1 to 1 2 3, and -2 to 2 3 4 */
		for (int k = 0; k < 6; k++)
			put_float(k < 3 ? -4 : 0);
		for (int k = 0; has_color && k < 6; k++)
			put_float(k < 3 ? -0.5f : 1.5f);
	}
	for (uint32_t i = 0; i < 300; i++) {
		put(i % 2 ? 0xffffffff : 1u << 21 | 2u << 11 | 3u, 4);
		put(rotations[i % 4], 4);
		put(i % 2 ? 0 : 2047u << 21 | 0u << 11 | 2047u, 4);
		put(i % 3 == 0 ? 0xff336600 : i % 3 == 1 ? 0x00000080 : 0x000000ff, 4);
	}
	for (int i = 0; i < 300; i++)
		for (int k = 0; k < rest; k++)
			put((uint32_t)(k == 0 ? 0 : k == 1 ? 255 : i % 200 + k), 1);
	save(len);
}

static int near(double a, double b)
{
	return fabs(a - b) <= 1e-6 * fmax(1, fabs(b));
}

static void unpacked(int has_color, int rest)
{
	static const struct fault none = {"uint", "uchar", 2, 300, 0};
	struct splats s = {0};
	struct err e = {0};
	double offset[3] = {0}, root = sqrt(2), low = has_color ? -0.5 : 0, span = has_color ? 2 : 1;

	build(has_color, rest, &none);
	int bad = ply_read(&s, offset, NULL, path, &e);
	if (!CHECK(!bad && s.n == 300 && s.sh_coefficients == 1 + rest / 3, "%s", e.message))
		return;
	CHECK(near(s.means[0], -1 + 2 / 2047.0) && near(s.means[1], -1 + 3 * 2 / 1023.0) &&
			near(s.means[2], -1 + 4 * 3 / 2047.0),
		"mean %g %g %g", s.means[0], s.means[1], s.means[2]);
	CHECK(s.means[3] == 1 && s.means[4] == 2 && s.means[5] == 3, "the greatest of chunk 0");
	CHECK(s.means[255 * 3] == 1 && s.means[257 * 3] == 2 && s.means[257 * 3 + 2] == 4,
		"Gaussian 256 begins chunk 1");
	CHECK(s.scales[0] == 1 && near(s.scales[1], exp(-4)) && s.scales[2] == 1, "scales");
	CHECK(s.opacities[0] == 0 && near(s.opacities[1], 128 / 255.0) && s.opacities[2] == 1,
		"opacities %g %g %g", s.opacities[0], s.opacities[1], s.opacities[2]);
	const float *sh = s.sh;
	for (int c = 0; c < 3; c++) {
		double want = (low + span * (double[]){1, 0.2, 0.4}[c] - 0.5) / 0.28209479177387814;
		CHECK(near(sh[c], want), "colour %d is %g, not %g", c, sh[c], want);
	}
	const float *q = s.quats;
	CHECK(q[0] == 0 && near(q[1], root / 2) && near(q[2], -root / 2) && near(q[3], -root / 2),
		"w is left over");
	CHECK(q[5] == 0 && near(q[4], root / 2), "x is left over");
	q += 8;
	CHECK(near(q[0], (700 / 1023.0 - 0.5) * root) && near(q[1], (300 / 1023.0 - 0.5) * root) &&
			near(q[3], (512 / 1023.0 - 0.5) * root) && q[2] > 0 &&
			near(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1),
		"y is left over: %g %g %g %g", q[0], q[1], q[2], q[3]);
	q += 4;
	CHECK(near(q[2], (1000 / 1023.0 - 0.5) * root) && near(q[1], -q[0]) && q[3] > 0.7, "z is left over");
	int channel = rest / 3;
	for (int i = 0; i < 300; i++)
		for (int k = 0; k < rest; k++) {
			double want = k == 0 ? -4 : k == 1 ? 4 : (i % 200 + k) * 8 / 255.0 - 4;
			float have = s.sh[3 * (1 + channel) * i + 3 * (1 + k % channel) + k / channel];
			if (!near(have, want))
				CHECK(0, "f_rest_%d of %d is %g, not %g", k, i, have, want);
		}
	splats_free(&s);
}

static void refused(const char *reason, int rest, const struct fault *fault)
{
	struct splats s;
	struct err e = {0};
	double offset[3];

	build(1, rest, fault);
	CHECK(ply_read(&s, offset, NULL, path, &e) && e.code == ERR_FORMAT && strstr(e.message, reason),
		"%s, not %s", e.message, reason);
}

/* A file that has packed vertices and nothing else, and one in ascii. */
static void no_chunks(void)
{
	static const char *const encodings[] = {"binary_big_endian", "ascii"};
	static const char *const reasons[] = {
		"no element 'chunk' before element 'vertex'", "packed Gaussians in ascii or with lists"};

	for (int i = 0; i < 2; i++) {
		struct splats s;
		struct err e = {0};
		double offset[3];
		len = 0;
		put_text("ply\nformat ");
		put_text(encodings[i]);
		put_text(
			" 1.0\nelement vertex 0\nproperty uint packed_position\nproperty uint packed_rotation\n"
			"property uint packed_scale\nproperty uint packed_color\nend_header\n");
		save(len);
		CHECK(ply_read(&s, offset, NULL, path, &e) && strstr(e.message, reasons[i]), "%s", e.message);
	}
}

static void cut(void)
{
	static const struct fault none = {"uint", "uchar", 2, 300, 0};
	struct splats s;
	double offset[3];
	int accepted = 0;

	build(1, 9, &none);
	for (size_t bytes = 0; bytes < len; bytes++) {
		struct err e = {0};
		save(bytes);
		if (!ply_read(&s, offset, NULL, path, &e)) {
			accepted++;
			splats_free(&s);
		}
	}
	CHECK(accepted == 0, "%d cut files were read", accepted);
	save(len);
	for (size_t at = 0; at < 2000; at++) { /* the header, the chunks and the first rows */
		struct err e = {0};
		data[at] ^= 0xff;
		save(len);
		if (!ply_read(&s, offset, NULL, path, &e))
			splats_free(&s);
		else
			accepted += e.code != ERR_FORMAT;
		data[at] ^= 0xff;
	}
	CHECK(accepted == 0, "%d changed files gave another error", accepted);
}

int main(void)
{
	file = mkstemp(path);
	if (file < 0)
		return 1;
	for (int has_color = 0; has_color < 2; has_color++)
		for (int degree = 0; degree < 4; degree++)
			unpacked(has_color, 3 * (degree + 1) * (degree + 1) - 3);
	refused("property 'packed_position' is not uint", 0, &(struct fault){"int", "uchar", 2, 300, 0});
	refused(": 1 chunks of 256 for 300 Gaussians", 0, &(struct fault){"uint", "uchar", 1, 300, 0});
	refused("element 'sh' has 299 rows for 300 Gaussians", 9,
		&(struct fault){"uint", "uchar", 2, 299, 0});
	refused("element 'sh' does not follow element 'vertex'", 9,
		&(struct fault){"uint", "uchar", 2, 300, 1});
	refused("element 'sh' has 8 properties, expected 9, 24 or 45", 8,
		&(struct fault){"uint", "uchar", 2, 300, 0});
	refused("element 'sh': property 0 is not uchar f_rest_0", 9,
		&(struct fault){"uint", "char", 2, 300, 0});
	no_chunks();
	cut();
	unlink(path);
	return unit_end();
}
