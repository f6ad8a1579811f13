/* The bytes of a .splat: formats/splats/splat.md. */
#include "read_as.h"
#include "unit.h"

#include "formats/splats/splat.h"

#include <unistd.h>

enum { N = 3, RECORD = 32 };

static void fill(struct splats *s)
{
	static const float means[N][3] = {{-1, 0, 0}, {1, 2, 3}, {0, 0, 9}};
	static const float scales[N][3] = {{0.25f, 0.25f, 0.25f}, {0.5f, 0.25f, 0.125f}, {1, 1, 1}};
	static const float quats[N][4] = {{0, 0, -2, 0}, {3, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}};
	static const float opacities[N] = {0.5f, 1, 0.001f}, colours[N][3] = {{9, -9, 1}, {0}, {0}};

	for (int i = 0; i < N; i++) {
		memcpy(s->means + 3 * i, means[i], sizeof means[i]);
		memcpy(s->scales + 3 * i, scales[i], sizeof scales[i]);
		memcpy(s->quats + 4 * i, quats[i], sizeof quats[i]);
		s->opacities[i] = opacities[i];
		for (int k = 0; k < 12; k++)
			s->sh[12 * i + k] = k < 3 ? colours[i][k] : 5;
	}
}

/* What was written is read: means and scales as they were, in the file's order, the rest to a byte. */
static void test_read(unsigned char *bytes, size_t len)
{
	struct splats s;
	struct err e;
	double offset[3];
	struct file_map map = {malloc(len), len, 0}, cut = {malloc(len - 1), len - 1, 0};

	memcpy((void *)(size_t)map.data, bytes, len);
	memcpy((void *)(size_t)cut.data, bytes, len - 1);
	if (!CHECK(!read_as(splat_read_map, &s, offset, &map, &e) && s.n == N && s.sh_coefficients == 1, "%s",
		    e.message))
		return;
	CHECK(s.means[0] == 1 && s.means[1] == 2 && s.means[2] == 3, "%g %g %g", s.means[0], s.means[1],
		s.means[2]);
	CHECK(fabsf(s.scales[1] - 0.25f) < 1e-6f && s.opacities[0] == 1, "%g, %g", s.scales[1],
		s.opacities[0]);
	CHECK(fabsf(s.sh[0]) < 1 / 143.0f && s.quats[0] > 0.99f, "%g, %g", s.sh[0], s.quats[0]);
	CHECK(fabsf(s.quats[8] - 0.5f) < 1e-6f && fabsf(s.opacities[1] - 0.5f) < 1 / 509.0f, "%g",
		s.quats[8]);
	splats_free(&s);
	CHECK(read_as(splat_read_map, &s, offset, &cut, &e) && e.code == ERR_FORMAT &&
			!strcmp(e.message, "f: 95 bytes are not a whole number of Gaussians of 32"),
		"%s", e.message);
}

int main(void)
{
	/* The page's example is the largest, as faint things come late however large they are. */
	static const unsigned char example[RECORD] = {0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x40, 0x00,
		0x00, 0x40, 0x40, 0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0x80, 0x3e, 0x00, 0x00, 0x00, 0x3e,
		0x80, 0x80, 0x80, 0xff, 0xff, 0x80, 0x80, 0x80};
	/* Colours are cut to a byte, a quaternion is made one, and what is -1 fits. */
	static const unsigned char second[8] = {255, 0, 199, 128, 128, 128, 0, 128};
	static const unsigned char third[4] = {192, 192, 192, 192};
	static const double origin[3];
	char path[] = "/tmp/test_splat.XXXXXX";
	unsigned char bytes[N * RECORD + 1] = {0};
	struct splats s;
	struct err e;
	const int temporary = mkstemp(path);

	if (temporary < 0 || splats_alloc(&s, N, 4, &e))
		return 1;
	fill(&s);
	CHECK(!splat_write(&s, origin, path, &e), "%s", e.message);
	FILE *in = fopen(path, "rb");
	size_t got = in ? fread(bytes, 1, sizeof bytes, in) : 0;
	if (in)
		fclose(in);
	CHECK(got == N * RECORD, "%zu bytes", got);
	CHECK(!memcmp(bytes, example, RECORD), "the example");
	CHECK(!memcmp(bytes + RECORD + 24, second, 8), "%d %d %d, %d, %d %d %d %d", bytes[56], bytes[57],
		bytes[58], bytes[59], bytes[60], bytes[61], bytes[62], bytes[63]);
	CHECK(!memcmp(bytes + 2 * RECORD + 28, third, 4), "%d", bytes[92]);
	test_read(bytes, got);
	CHECK(splat_write(&s, origin, "/nowhere/x.splat", &e) && e.code == ERR_SYSTEM, "no folder");
	close(temporary);
	unlink(path);
	splats_free(&s);
	return unit_end();
}
