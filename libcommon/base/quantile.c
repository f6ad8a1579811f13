#include "base/quantile.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

double quantile_sorted(const double *sorted, size_t n, double share)
{
	double place = share * (double)(n - 1);
	size_t below = (size_t)place;

	if (below + 1 >= n || sorted[below] == sorted[below + 1])
		return sorted[below];
	return sorted[below] + (place - (double)below) * (sorted[below + 1] - sorted[below]);
}

/* Rises with the number, -0 below 0. */
static uint64_t key_of(double at)
{
	uint64_t bits;

	memcpy(&bits, &at, sizeof bits);
	return bits ^ (bits >> 63 ? UINT64_MAX : (uint64_t)1 << 63);
}

/* A radix sort of DIGIT_BITS at a time from the least ones on; what all have alike is passed over. */
void quantile_order(struct quantile_item *items, struct quantile_item *other, size_t n)
{
	struct quantile_item *from = items, *to = other;
	size_t count[DIGITS + 1];
	uint64_t differ = 0;

	for (size_t i = 0; i < n; i++)
		differ |= key_of(items[i].at) ^ key_of(items[0].at);
	for (int shift = 0; shift < 64; shift += DIGIT_BITS) {
		if (!(differ >> shift & (DIGITS - 1)))
			continue;
		memset(count, 0, sizeof count);
		for (size_t i = 0; i < n; i++)
			count[1 + (key_of(from[i].at) >> shift & (DIGITS - 1))]++;
		for (int d = 0; d < DIGITS; d++)
			count[d + 1] += count[d];
		for (size_t i = 0; i < n; i++)
			to[count[key_of(from[i].at) >> shift & (DIGITS - 1)]++] = from[i];
		struct quantile_item *const was = from;
		from = to;
		to = was;
	}
	if (from != items)
		memcpy(items, from, n * sizeof *items);
}

static double middle_of(double a, double b, double c)
{
	return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

double quantile_weighted(struct quantile_item *items, size_t n, double share)
{
	double left = 0;

	for (size_t i = 0; i < n; i++)
		left += share * items[i].weight;
	return quantile_passed(items, n, left);
}

/* What is on the wrong side of a pivot is left aside, until the pivot is what is looked for (Hoare 1961). */
double quantile_passed(struct quantile_item *items, size_t n, double left)
{
	for (;;) {
		const double pivot = middle_of(items[0].at, items[n / 2].at, items[n - 1].at);
		double under = 0, here = 0;
		size_t below = 0, to = 0, above = n;
		while (to < above) {
			const struct quantile_item x = items[to];
			if (x.at < pivot) {
				under += x.weight;
				items[to++] = items[below];
				items[below++] = x;
			} else if (x.at > pivot) {
				items[to] = items[--above];
				items[above] = x;
			} else {
				here += x.weight;
				to++;
			}
		}
		if (left < under && below) {
			n = below;
		} else if (left < under + here || above == n) {
			return pivot;
		} else {
			left -= under + here;
			items += above;
			n -= above;
		}
	}
}
