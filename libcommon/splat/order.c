#include "splat/order.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/threads.h"

#include <omp.h>

enum {
	DIGIT_BITS = 12,
	DIGITS = 1 << DIGIT_BITS,
	FEW = 1 << 22, /* below this many items two digits tell nearly all apart, else three are used */
	SHORT_RUN = 32,
};

uint32_t order_key(double depth)
{
	float x = (float)depth;
	uint32_t bits; /* of a positive float: they rise with it */

	memcpy(&bits, &x, sizeof bits);
	return bits;
}

/* Digits are taken from (key - low) >> shift. */
struct digits {
	uint32_t low;
	int shift, passes;
};

static struct digits choose_digits(const struct order_item *items, size_t n)
{
	uint32_t low = UINT32_MAX, high = 0;
	struct digits d = {.passes = n < FEW ? 2 : 3};

	for (size_t i = 0; i < n; i++) {
		low = items[i].key < low ? items[i].key : low;
		high = items[i].key > high ? items[i].key : high;
	}
	d.low = low;
	while (n && (uint64_t)(high - low) >> d.shift >> (d.passes * DIGIT_BITS))
		d.shift++;
	return d;
}

static uint32_t digit(uint32_t key, struct digits d, int pass)
{
	return (key - d.low) >> d.shift >> (pass * DIGIT_BITS) & (DIGITS - 1);
}

/* One pass by many threads: each counts, then moves its own stretch. counts (threads,DIGITS). */
static void sort_pass(const struct order_item *from, struct order_item *to, size_t n, struct digits d,
	int pass, uint32_t *counts, int threads)
{
#pragma omp parallel num_threads(threads)
	{
		const int mine = omp_get_thread_num(), all = omp_get_num_threads();
		const size_t begin = n * (size_t)mine / (size_t)all,
			     end = n * ((size_t)mine + 1) / (size_t)all;
		uint32_t *count = counts + (size_t)mine * DIGITS;

		memset(count, 0, DIGITS * sizeof *count);
		for (size_t i = begin; i < end; i++)
			count[digit(from[i].key, d, pass)]++;
#pragma omp barrier
#pragma omp single
		for (uint32_t k = 0, sum = 0; k < DIGITS; k++)
			for (int t = 0; t < all; t++) {
				uint32_t here = counts[(size_t)t * DIGITS + k];
				counts[(size_t)t * DIGITS + k] = sum;
				sum += here;
			}
		for (size_t i = begin; i < end; i++)
			to[count[digit(from[i].key, d, pass)]++] = from[i];
	}
}

/* For the items of a run: by depth, then by index. */
struct exact {
	double depth;
	struct order_item item;
};

static int by_depth(const void *a, const void *b)
{
	const struct exact *x = a, *y = b;

	return x->depth != y->depth ? COMPARE(x->depth, y->depth) : COMPARE(x->item.index, y->item.index);
}

static int is_behind(const struct order_item *a, const struct order_item *b, const struct projected *p)
{
	return a->key != b->key ? a->key > b->key : p[a->index].depth > p[b->index].depth;
}

static int settle_run(struct order_item *items, size_t n, const struct projected *p, struct err *e)
{
	if (n <= SHORT_RUN) {
		for (size_t i = 1; i < n; i++) {
			struct order_item one = items[i];
			size_t k = i;
			for (; k > 0 && is_behind(&items[k - 1], &one, p); k--)
				items[k] = items[k - 1];
			items[k] = one;
		}
		return 0;
	}
	SCOPED struct exact *run = mem_alloc(n, sizeof *run, "depth order", e);
	if (!run)
		return -1;
	for (size_t i = 0; i < n; i++)
		run[i] = (struct exact){p[items[i].index].depth, items[i]};
	qsort(run, n, sizeof *run, by_depth);
	for (size_t i = 0; i < n; i++)
		items[i] = run[i].item;
	return 0;
}

static uint32_t run_key(const struct order_item *item, struct digits d)
{
	return (item->key - d.low) >> d.shift;
}

/* Where the first run begins that begins at `at` or later. */
static size_t next_run(const struct order_item *items, size_t n, struct digits d, size_t at)
{
	while (at && at < n && run_key(&items[at], d) == run_key(&items[at - 1], d))
		at++;
	return at;
}

/* Settles the runs of equal digits that begin in [begin,end). */
static int settle_some(struct order_item *items, size_t begin, size_t end, struct digits d,
	const struct projected *p, struct err *e)
{
	for (size_t i = begin, next; i < end; i = next) {
		const uint32_t key = run_key(&items[i], d);
		for (next = i + 1; next < end && run_key(&items[next], d) == key; next++)
			;
		if (next > i + 1 && settle_run(items + i, next - i, p, e))
			return -1;
	}
	return 0;
}

/* Runs of equal digits stand by index still: each thread settles those of its own stretch. */
static int settle(struct order_item *items, size_t n, struct digits d, const struct projected *p, int threads,
	struct err *e)
{
	int failed = 0;

#pragma omp parallel num_threads(threads) reduction(| : failed)
	{
		const size_t mine = (size_t)omp_get_thread_num(), all = (size_t)omp_get_num_threads();
		const size_t begin = next_run(items, n, d, n * mine / all),
			     end = next_run(items, n, d, n * (mine + 1) / all);
		struct err own;
		/* before items are moved */
#pragma omp barrier
		failed = settle_some(items, begin, end, d, p, &own) != 0;
		if (failed) {
			failed = 1;
#pragma omp critical
			*e = own;
		}
	}
	return failed ? -1 : 0;
}

struct order_item *order_sort(struct order_item *items, struct order_item *spare, size_t n,
	const struct projected *p, struct err *e)
{
	const int threads = threads_available();
	const struct digits d = choose_digits(items, n);
	SCOPED uint32_t *counts = mem_alloc((size_t)threads * DIGITS, sizeof *counts, "depth order", e);

	if (!counts)
		return NULL;
	for (int pass = 0; pass < d.passes; pass++) {
		sort_pass(items, spare, n, d, pass, counts, threads);
		struct order_item *swap = items;
		items = spare;
		spare = swap;
	}
	if (settle(items, n, d, p, threads, e))
		return NULL;
	return items;
}
