/* Labels are whole: a picture of them that was scaled with mixing, or saved with loss, has at the edge of two
 * of them those between, which are other things'. */
#include "formats/images/png.h"

static int is_between(uint32_t a, uint32_t value, uint32_t b, int is_number)
{
	if (value == a || value == b || (a | value | b) & PNG_PAINT_NONE)
		return 0;
	if (is_number || (a | value | b) & PNG_PAINT_NUMBER)
		return (a < value) == (value < b);
	for (int k = 0; k < 24; k += 8) {
		const uint32_t x = a >> k & 255, y = value >> k & 255, z = b >> k & 255;
		if ((y < x && y < z) || (y > x && y > z))
			return 0;
	}
	return 1;
}

int png_check_edges(const char *path, const uint32_t *values, const uint8_t *counts, int height, int width,
	int is_number, struct err *e)
{
	/* a tenth: of clean maps it is 0.5%, of what was scaled 20% and more; a hundredth that means
	 * something */
	enum { FEWEST = 32, SHARE = 10, WRONG = 100 };
	const size_t w = (size_t)width, n = (size_t)height * w;
	size_t edges = 0, between = 0, wrong = 0;

	for (size_t p = 0; p < n; p++)
		for (int k = 0; k < 2; k++) {
			const size_t step = k ? w : 1;
			if (k ? p < w || p + w >= n : p % w == 0 || p % w == w - 1)
				continue;
			edges += values[p - step] != values[p + step];
			if (!is_between(values[p - step], values[p], values[p + step], is_number))
				continue;
			between++;
			wrong += !counts || counts[p];
		}
	if (between < FEWEST || SHARE * between < edges || WRONG * wrong < edges)
		return 0;
	return err_file(e, path,
		"at %.0f%% of its edges are values between those on either side, some of them other labels: it was a JPEG, or scaled with mixing: scale labels to the nearest pixel, and save them as PNG",
		100 * (double)between / (double)edges);
}
