/* Labels of Gaussians, and the colours of labels. */
#include "unit.h"

#include "lift/lift_labels.h"

enum { GAUSSIANS = 6, OBJECTS = 3 };

/* Objects: 0 has Gaussians 0 to 3, 1 has 2 to 4, 2 nothing. Gaussian 1 is a stray of object 0, 2 is more of
 * object 1, and 3 as much of both. */
static void test_labels(void)
{
	int64_t indptr[OBJECTS + 1] = {0, 4, 7, 7};
	int32_t index[] = {0, 1, 2, 3, 2, 3, 4}, first[] = {0, 2, 3}, second[] = {2, 3, 4};
	float share[] = {0.5f, 0.9f, 0.6f, 0.5f, 0.7f, 0.5f, 1};
	const struct lifted l = {
		.gaussians = GAUSSIANS, .objects = OBJECTS, .indptr = indptr, .index = index, .share = share};
	const struct extent extents[OBJECTS] = {{.n = 3, .ids = first}, {.n = 3, .ids = second}, {.n = 0}};
	static const int32_t expected[GAUSSIANS] = {1, 0, 2, 1, 2, 0};
	int32_t labels[GAUSSIANS];
	struct err e;

	CHECK(!labels_find(labels, &l, extents, &e), "%s", e.message);
	for (int i = 0; i < GAUSSIANS; i++)
		CHECK(labels[i] == expected[i], "%d: %d, not %d", i, labels[i], expected[i]);
}

/* The twin goes round the hexagon of hues side by side. */
static void colour_twin(int label, double rgb[3])
{
	const double hue = 6 * fmod(label * 0.6180339887498949, 1), high = 0.95, low = 0.95 * 0.25;
	const int side = (int)hue;
	const double between = low + (high - low) * (side % 2 ? 1 - (hue - side) : hue - side);
	static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}};

	rgb[order[side][0]] = high;
	rgb[order[side][1]] = between;
	rgb[order[side][2]] = low;
}

static void test_colours(void)
{
	uint8_t rgb[3], others[256][3];
	double twin[3];
	int least = 1000;

	for (int label = 1; label < 256; label++) {
		labels_colour(label, rgb);
		colour_twin(label, twin);
		for (int c = 0; c < 3; c++)
			CHECK(fabs(rgb[c] - 255 * twin[c]) < 0.501, "label %d, %d: %d, not %g", label, c,
				rgb[c], 255 * twin[c]);
		memcpy(others[label], rgb, sizeof rgb);
	}
	for (int a = 1; a <= 12; a++)
		for (int b = 1; b < a; b++) {
			int far = 0;
			for (int c = 0; c < 3; c++)
				far += abs(others[a][c] - others[b][c]);
			least = far < least ? far : least;
		}
	CHECK(least > 40, "two of the first twelve colours are %d apart", least);
}

int main(void)
{
	test_labels();
	test_colours();
	return unit_end();
}
