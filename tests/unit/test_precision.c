/* Matrices in f32, f16 and u8: what comes back from a file, and what is refused. */
#include "unit.h"

#include "base/rng.h"
#include "formats/arrays/precision.h"

#include <float.h>
#include <unistd.h>

enum { ROWS = 37, MAX_COLUMNS = 16 };

static char path[] = "/tmp/test_precision.XXXXXX";

/* x (rows,columns) through a file. */
static int through(enum precision p, enum precision_group group, size_t rows, size_t columns, const float *x,
	float *y, struct err *e)
{
	struct arrays_out out;
	struct safetensors st;

	arrays_out_begin(&out, path, "test", NULL, NULL, NULL, 0, e);
	precision_put(&out, "x", p, group, rows, columns, x);
	if (arrays_out_end(&out) || safetensors_open(&st, path, e))
		return -1;
	int bad = precision_get(&st, "x", p, group, rows, columns, y, e);
	safetensors_close(&st);
	return bad;
}

static void returns(int columns)
{
	static float x[ROWS * MAX_COLUMNS], y[ROWS * MAX_COLUMNS];
	const int count = ROWS * columns;
	const size_t width = (size_t)columns;
	struct rng r;
	struct err e;

	rng_seed(&r, 7, 1);
	for (int i = 0; i < count; i++) /* every row and column of another size */
		x[i] = (float)(rng_normal(&r) *
			       exp((double)(i % columns - columns) + 10 - (double)(i / columns) / 3));
	for (int i = 0; i < ROWS && columns > 5; i++)
		x[i * columns + 5] = 0.1f;
	CHECK(!through(PRECISION_F32, PRECISION_ROWS, ROWS, width, x, y, &e), "%s", e.message);
	CHECK(!memcmp(x, y, sizeof *x * (size_t)count), "f32 is not exact");
	CHECK(!through(PRECISION_F16, PRECISION_ROWS, ROWS, width, x, y, &e), "%s", e.message);
	for (int i = 0; i < count; i++)
		CHECK(fabsf(x[i] - y[i]) <= fmaxf(fabsf(x[i]) * 0x1p-11f, 0x1p-25f), "f16: %g for %g",
			(double)y[i], (double)x[i]);
	for (int g = 0; g < 2; g++) {
		const enum precision_group group = g ? PRECISION_COLUMNS : PRECISION_ROWS;
		const int groups = g ? columns : ROWS, n = g ? ROWS : columns;
		CHECK(!through(PRECISION_U8, group, ROWS, width, x, y, &e), "%s", e.message);
		for (int k = 0; k < groups; k++) {
			const float *first = g ? x + k : x + (ptrdiff_t)k * columns;
			float low = INFINITY, high = -INFINITY, worst = 0, error = 0;
			for (int i = 0; i < n; i++) {
				const int at = g ? i * columns : i;
				low = fminf(low, first[at]);
				high = fmaxf(high, first[at]);
			}
			const float half = (high - low) / 255 / 2;
			for (int i = 0; i < n; i++) {
				const int at = g ? i * columns : i;
				error = fabsf(first[at] - y[first - x + at]);
				worst = fmaxf(worst, error);
				if (first[at] == low)
					CHECK(error == 0, "the lowest of group %d is off by %g", k,
						(double)error);
			}
			CHECK(worst <= half * 1.0001f + fmaxf(fabsf(low), fabsf(high)) * FLT_EPSILON,
				"group %d is off by %g, half a step is %g", k, (double)worst, (double)half);
			CHECK(low == high || worst > half / 100, "group %d is exact: nothing was tested", k);
		}
	}
}

static void extremes(void)
{
	const float large[3] = {-1e38f, 1e38f, 0}, same[3] = {-2.5f, -2.5f, -2.5f}, tiny[3] = {0, 1e-45f, 0};
	float y[3];
	struct err e;

	CHECK(!through(PRECISION_U8, PRECISION_ROWS, 1, 3, large, y, &e), "%s", e.message);
	CHECK(y[0] == -1e38f && fabsf(y[1] - 1e38f) < 1e32f, "%g %g", (double)y[0], (double)y[1]);
	CHECK(!through(PRECISION_U8, PRECISION_ROWS, 1, 3, same, y, &e) && !memcmp(y, same, sizeof y),
		"equal numbers are exact");
	CHECK(!through(PRECISION_U8, PRECISION_ROWS, 1, 3, tiny, y, &e) && y[0] == 0, "%g", (double)y[0]);
	for (int p = 0; p < PRECISIONS; p++)
		for (int g = 0; g < 2; g++) {
			CHECK(!through((enum precision)p, (enum precision_group)g, 0, 16, NULL, y, &e), "%s",
				e.message);
			CHECK(precision_parse(precision_name((enum precision)p)) == p, "name %d", p);
		}
}

/* Numbers that are not finite, or too large, in the last place. */
static void refuses(void)
{
	const float wrong[] = {NAN, INFINITY, -INFINITY, -65536, 2e38f};
	const char *said[] = {"is not finite", "is not finite", "is not finite",
		"is -65536, too large for this precision", "is 2e+38, too large for this precision"};
	const int until[] = {PRECISIONS, PRECISIONS, PRECISIONS, 0, 0};
	char expected[256];
	struct err e;

	for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
		for (int p = 0; p < PRECISIONS; p++) {
			const float x[3] = {0, 1, wrong[i]};
			float y[3];
			const int refused = p < until[i] || (p == PRECISION_F16 && i >= 3) ||
					    (p == PRECISION_U8 && i == 4);
			int bad = through((enum precision)p, PRECISION_ROWS, 1, 3, x, y, &e);
			CHECK(!bad == !refused, "%s of %g: %d", precision_name((enum precision)p),
				(double)wrong[i], bad);
			snprintf(expected, sizeof expected, "%s: tensor 'x': item 2 %s", path, said[i]);
			if (bad)
				CHECK(e.code == ERR_CHECK && !strcmp(e.message, expected), "%s", e.message);
		}
}

int main(void)
{
	int fd = mkstemp(path);

	if (CHECK(fd >= 0, "no temporary file")) {
		close(fd);
		returns(1);
		returns(5);
		returns(MAX_COLUMNS);
		extremes();
		refuses();
		unlink(path);
	}
	return unit_end();
}
