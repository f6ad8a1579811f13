/* Weights are summed as whole numbers of 2^-52, which those from 2^-29 are: no sum is rounded, so that sums
 * may be taken in any order. A row's weights go into bins, by their exponent and two more bits; what is below
 * the bin in which the sum becomes too large goes, and of that bin alone, which has two or three of them, the
 * order is needed. */
#include "splat/prune.h"

#include "base/mem.h"

#include <math.h>
#include <omp.h>

#define UNIT 0x1p-52

enum {
	SHIFT = 21,		     /* of a float's bits, which leaves the exponent and two bits */
	FIRST_BIN = (127 - 29) << 2, /* that of 2^-29 */
	BINS = ((127 + 1) << 2) - FIRST_BIN
};

/* A float's bits rise with it from 0 on; those of -1 are less. */
static int32_t bits_of(float x)
{
	int32_t bits;

	memcpy(&bits, &x, sizeof bits);
	return bits;
}

static int bin_of(float weight)
{
	const int bin = (bits_of(weight) >> SHIFT) - FIRST_BIN;

	return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

/* Of the least float of a bin; the first and the last have all that is beyond. */
static int32_t bin_begin(int bin)
{
	return bin == BINS ? INT32_MAX : bin ? (bin + FIRST_BIN) << SHIFT : 0;
}

static int64_t whole(float weight)
{
	return (int64_t)((double)weight / UNIT);
}

/* Whether weight i goes before k: the smaller, of equal ones the farther. */
static int goes_before(const float *row, uint32_t i, uint32_t k)
{
	return row[i] < row[k] || (row[i] == row[k] && i > k);
}

/* Marks weights of the `count` in list, the least first, as long as the sum of what is out is at most `most`.
 * Returns it. */
static int64_t mark_listed(float *row, uint32_t *list, size_t count, int64_t out, int64_t most)
{
	for (size_t n = count; n; n--) {
		size_t least = 0;
		for (size_t k = 1; k < n; k++)
			least = goes_before(row, list[k], list[least]) ? k : least;
		const uint32_t i = list[least];
		if (out + whole(row[i]) > most)
			break;
		out += whole(row[i]);
		row[i] = -1;
		list[least] = list[n - 1];
	}
	return out;
}

/* The sum of what goes of a row's share, of which the bin where it ends is marked; *begin is of that bin. */
static int64_t mark_share(float *row, size_t n, double tolerance, uint32_t *list, int32_t *begin)
{
	int64_t bins[BINS] = {0}, sum = 0, out = 0;
	size_t count = 0;
	int last = 0;

	for (size_t i = 0; i < n; i++) {
		const int64_t weight = whole(row[i]);
		bins[bin_of(row[i])] += weight;
		sum += weight;
	}
	const int64_t most = (int64_t)(tolerance * (double)sum);
	while (last < BINS - 1 && out + bins[last] <= most)
		out += bins[last++];
	*begin = bin_begin(last);
	const int32_t end = bin_begin(last + 1);
	for (size_t i = 0; i < n; i++) {
		list[count] = (uint32_t)i;
		count += (uint32_t)(bits_of(row[i]) - *begin) < (uint32_t)(end - *begin);
	}
	return mark_listed(row, list, count, out, most);
}

/* The sum of weights from `begin` up to `end`, which are bits. */
static int64_t sum_between(const float *row, size_t n, int32_t begin, int32_t end)
{
	int64_t sum = 0;

	for (size_t i = 0; i < n; i++) {
		const int32_t bits = bits_of(row[i]);
		sum += bits >= begin && bits < end ? whole(row[i]) : 0;
	}
	return sum;
}

static void mark_below(float *row, size_t n, int32_t end)
{
	for (size_t i = 0; i < n; i++)
		row[i] = bits_of(row[i]) < end ? -1 : row[i];
}

/* Marks what is to go from a row of n weights by -1; returns its sum. `least` is bits; `list` (n + 1). */
static float mark_row(float *row, size_t n, double tolerance, int32_t least, uint32_t *list)
{
	int32_t begin = 0;
	float share = 0;

	if (tolerance > 0)
		share = (float)((double)mark_share(row, n, tolerance, list, &begin) * UNIT);
	double all = (double)share;
	if (least > begin)
		all += (double)sum_between(row, n, begin, least) * UNIT;
	mark_below(row, n, least > begin ? least : begin);
	return all < 1 ? (float)all : 1;
}

/* Closes the gaps of what is marked by -1. */
static void close_gaps(struct render_weights *w, size_t pixels)
{
	int64_t kept = 0, begin = 0;

	for (size_t p = 0; p < pixels; p++) {
		int64_t end = w->indptr[p + 1];
		for (int64_t i = begin; i < end; i++) {
			w->index[kept] = w->index[i];
			w->weight[kept] = w->weight[i];
			kept += w->weight[i] >= 0;
		}
		begin = end;
		w->indptr[p + 1] = kept;
	}
}

/* Of the least float that is not below x. */
static int32_t bits_from(double x)
{
	const float near = (float)x;

	return bits_of((double)near < x ? nextafterf(near, INFINITY) : near);
}

static size_t longest_row(const struct render_weights *w, size_t pixels)
{
	size_t longest = 0;

	for (size_t p = 0; p < pixels; p++) {
		const size_t n = (size_t)(w->indptr[p + 1] - w->indptr[p]);
		longest = n > longest ? n : longest;
	}
	return longest;
}

int prune_weights(struct render_weights *w, size_t pixels, double tolerance, double least, float *dropped,
	struct err *e)
{
	const size_t room = longest_row(w, pixels) + 1; /* a list is written one past its end */
	const int32_t bits = bits_from(least);
	SCOPED uint32_t *lists = mem_alloc(room, (size_t)omp_get_max_threads() * sizeof *lists, "pruning", e);

	if (!lists)
		return -1;
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++)
		dropped[p] = mark_row(w->weight + w->indptr[p], (size_t)(w->indptr[p + 1] - w->indptr[p]),
			tolerance, bits, lists + room * (size_t)omp_get_thread_num());
	close_gaps(w, pixels);
	return 0;
}
