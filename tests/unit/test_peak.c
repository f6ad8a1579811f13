/* Peaks of responses: against windows summed pixel by pixel in float64, and by hand. */
#include "unit.h"

#include "answer/peak.h"
#include "base/rng.h"

enum { H = 13, W = 17 };

static int mirrored(int at, int n)
{
	for (int turns = 0; turns < 64 && (at < 0 || at >= n); turns++)
		at = n == 1 ? 0 : at < 0 ? -at : 2 * (n - 1) - at;
	return at;
}

/* The mean around a pixel by the definition. */
static double around(const float *image, int height, int width, int window, int x, int y)
{
	double sum = 0;

	for (int v = 0; v < window; v++)
		for (int u = 0; u < window; u++) {
			const int row = mirrored(y + v - window / 2, height),
				  column = mirrored(x + u - window / 2, width);
			sum += fmax(0, (double)image[row * width + column]);
		}
	return sum / window / window;
}

static void test_twin(uint64_t seed, int height, int width, int window)
{
	float image[H * W];
	struct rng r;
	struct err e = {0};
	double best = 0;
	int x = -1, y = -1;

	rng_seed(&r, seed, 1);
	for (int p = 0; p < height * width; p++)
		image[p] = (float)(rng_uniform(&r) - 0.6);
	for (int p = 0; p < height * width; p++)
		best = fmax(best, around(image, height, width, window, p % width, p / width));
	CHECK(peak_find(image, height, width, window, &x, &y, &e) == 1, "%s", e.message);
	CHECK(x >= 0 && x < width && y >= 0 && y < height, "%d,%d", x, y);
	const double own = around(image, height, width, window, x, y);
	CHECK(own > best - 1e-12, "%dx%d, %d: %g at %d,%d, %g elsewhere", height, width, window, own, x, y,
		best);
}

static void check(const float *image, int window, int column, int row, const char *what)
{
	struct err e = {0};
	int x = -1, y = -1;
	const int found = peak_find(image, 5, 6, window, &x, &y, &e);

	CHECK(found == 1 && x == column && y == row, "%s: %d,%d", what, x, y);
}

static void test_by_hand(void)
{
	float image[5 * 6] = {0};
	struct err e = {0};
	int x, y;

	for (int p = 0; p < 30; p++)
		image[p] = p % 2 ? -1 : 0;
	CHECK(!peak_find(image, 5, 6, 3, &x, &y, &e), "nothing is above 0");
	image[0] = 2;
	image[2 * 6 + 2] = image[2 * 6 + 3] = image[3 * 6 + 2] = image[3 * 6 + 3] = 1;
	check(image, 1, 0, 0, "one alone");
	check(image, 3, 2, 2, "together");
	image[0] = image[2 * 6 + 2] = 0;
	check(image, 1, 3, 2, "the first of equal ones");
	/* Two pixels are one's own and the one before it. */
	image[2 * 6 + 3] = 3;
	check(image, 2, 3, 3, "an even window");
}

int main(void)
{
	const int windows[] = {1, 2, 3, 6, 30, 100};

	for (uint64_t seed = 0; seed < 5; seed++)
		for (size_t k = 0; k < sizeof windows / sizeof *windows; k++) {
			test_twin(seed, H, W, windows[k]);
			test_twin(seed, 1, 7, windows[k]);
			test_twin(seed, 7, 1, windows[k]);
		}
	test_by_hand();
	return unit_end();
}
