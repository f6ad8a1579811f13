#include "answer/peak.h"

#include "base/mem.h"

/* Where a place outside 0 to n - 1 is mirrored to: -1 is 1, n is n - 2. */
static int mirrored(int at, int n)
{
	if (n == 1)
		return 0;
	while (at < 0 || at >= n)
		at = at < 0 ? -at : 2 * (n - 1) - at;
	return at;
}

/* to (n): sums of `window` numbers around each of from (n), both so many numbers apart. */
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

/* The sums of all windows of sums, in place. */
static void sum_windows(double *sums, double *rows, int height, int width, int window)
{
	for (int r = 0; r < height; r++)
		sum_line(
			sums + (size_t)r * (size_t)width, rows + (size_t)r * (size_t)width, 1, width, window);
	for (int c = 0; c < width; c++)
		sum_line(rows + c, sums + c, (size_t)width, height, window);
}

void peak_mean(const float *image, int height, int width, int window, double *room, double *to)
{
	const size_t pixels = (size_t)height * (size_t)width;

	for (size_t p = 0; p < pixels; p++)
		to[p] = (double)image[p];
	sum_windows(to, room, height, width, window);
	for (size_t p = 0; p < pixels; p++)
		to[p] /= (double)window * window;
}

int peak_find(const float *image, int height, int width, int window, int *x, int *y, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	SCOPED double *sums = mem_alloc(2 * pixels, sizeof *sums, "peak", e);
	size_t best = 0;
	int is_any = 0;

	if (!sums)
		return -1;
	for (size_t p = 0; p < pixels; p++) {
		sums[p] = image[p] > 0 ? (double)image[p] : 0;
		is_any |= image[p] > 0;
	}
	if (is_any)
		sum_windows(sums, sums + pixels, height, width, window);
	for (size_t p = 1; p < pixels && is_any; p++)
		best = sums[p] > sums[best] ? p : best;
	*x = (int)(best % (size_t)width);
	*y = (int)(best / (size_t)width);
	return is_any;
}
