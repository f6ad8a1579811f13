#include "answer/peak.h"

#include "base/mem.h"

#include <stdlib.h>

/* Where a place outside 0 to n - 1 is mirrored to: -1 is 1, n is n - 2. */
static int mirrored(int at, int n)
{
	if (n == 1)
		return 0;
	while (at < 0 || at >= n)
		at = at < 0 ? -at : 2 * (n - 1) - at;
	return at;
}

/* to (n): sums of `window` numbers around each of from (n), both with so many numbers from one to the next.
 */
static void sum_line(const double *from, double *to, size_t step, int n, int window)
{
	double sum = 0;

	for (int k = 0; k < window; k++)
		sum += from[(size_t)mirrored(k - window / 2, n) * step];
	for (int i = 0; i < n; i++) {
		const int first = i - window / 2;
		to[(size_t)i * step] = sum;
		sum += from[(size_t)mirrored(first + window, n) * step] -
		       from[(size_t)mirrored(first, n) * step];
	}
}

int peak_find(const float *image, int height, int width, int window, int *x, int *y, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	double *sums = mem_alloc(2 * pixels, sizeof *sums, "peak", e), *rows = sums + pixels;
	size_t best = 0;
	int is_any = 0;

	if (!sums)
		return -1;
	for (size_t p = 0; p < pixels; p++) {
		sums[p] = image[p] > 0 ? (double)image[p] : 0;
		is_any |= image[p] > 0;
	}
	for (int r = 0; r < height && is_any; r++)
		sum_line(
			sums + (size_t)r * (size_t)width, rows + (size_t)r * (size_t)width, 1, width, window);
	for (int c = 0; c < width && is_any; c++)
		sum_line(rows + c, sums + c, (size_t)width, height, window);
	for (size_t p = 1; p < pixels && is_any; p++)
		best = sums[p] > sums[best] ? p : best;
	free(sums);
	*x = (int)(best % (size_t)width);
	*y = (int)(best / (size_t)width);
	return is_any;
}
