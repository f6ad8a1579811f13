#include "splat/prune.h"

#include "base/mem.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Keys for a least-first heap: the weight's bits, which rise with it, above the distance from the row's end.
 */
static uint64_t make_key(float weight, uint32_t from_end)
{
	uint32_t bits;

	memcpy(&bits, &weight, sizeof bits);
	return (uint64_t)bits << 32 | from_end;
}

static void sift_down(uint64_t *heap, size_t n, size_t at)
{
	for (size_t child; (child = 2 * at + 1) < n; at = child) {
		child += child + 1 < n && heap[child + 1] < heap[child];
		if (heap[at] <= heap[child])
			return;
		uint64_t swap = heap[at];
		heap[at] = heap[child];
		heap[child] = swap;
	}
}

/* Marks what is to go from a row of n weights by -1; returns its sum. `heap` has room for n keys. Weights so
 * small that n of them may go need no order. */
static double mark_row(float *weight, size_t n, double tolerance, uint64_t *heap)
{
	double sum = 0, out = 0;
	size_t left = 0;

	for (size_t i = 0; i < n; i++)
		sum += (double)weight[i];
	const double small = n ? tolerance * sum / (double)n : 0;
	for (size_t i = 0; i < n; i++) {
		if ((double)weight[i] < small) {
			out += (double)weight[i];
			weight[i] = -1;
		} else {
			heap[left++] = make_key(weight[i], (uint32_t)(n - 1 - i));
		}
	}
	for (size_t i = left / 2; i-- > 0;)
		sift_down(heap, left, i);
	while (left) {
		size_t i = n - 1 - (uint32_t)heap[0];
		if (out + weight[i] > tolerance * sum)
			break;
		out += weight[i];
		weight[i] = -1;
		heap[0] = heap[--left];
		sift_down(heap, left, 0);
	}
	return out;
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

int prune_weights(struct render_weights *w, size_t pixels, double tolerance, float *dropped, struct err *e)
{
	size_t longest = 0;

	for (size_t p = 0; p < pixels; p++) {
		size_t n = (size_t)(w->indptr[p + 1] - w->indptr[p]);
		longest = n > longest ? n : longest;
	}
	uint64_t *heaps = mem_alloc(longest, (size_t)omp_get_max_threads() * sizeof *heaps, "pruning", e);
	if (!heaps)
		return -1;
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++)
		dropped[p] =
			(float)mark_row(w->weight + w->indptr[p], (size_t)(w->indptr[p + 1] - w->indptr[p]),
				tolerance, heaps + longest * (size_t)omp_get_thread_num());
	free(heaps);
	close_gaps(w, pixels);
	return 0;
}

void prune_below(struct render_weights *w, size_t pixels, double least, float *dropped)
{
#pragma omp parallel for schedule(static)
	for (size_t p = 0; p < pixels; p++) {
		double out = (double)dropped[p];
		for (int64_t i = w->indptr[p]; i < w->indptr[p + 1]; i++)
			if ((double)w->weight[i] < least) {
				out += (double)w->weight[i];
				w->weight[i] = -1;
			}
		dropped[p] = out < 1 ? (float)out : 1;
	}
	close_gaps(w, pixels);
}
