/* Items side by side, each by one of a few workers that have a part of the threads each: for work on views,
 * of which much does not divide among threads, and where each takes much memory. */
#pragma once

#include "base/err.h"

/* No more work at a time than this: each takes memory of its own. */
enum { EACH_WORKERS = 8 };

/* How many workers n items may have here: no more than that, nor than threads or items, and 1 at least. */
int each_workers(size_t n);

struct each {
	void *context;
	int workers; /* each_workers; work gets the number of its own, 0 to workers - 1 */
	int (*work)(void *context, int worker, size_t item, struct err *e);
	/* in the order of the items, one at a time; NULL: nothing is to be done */
	int (*done)(void *context, size_t item, struct err *e);
};

/* Works on the items 0 to n - 1; both functions return 0, or -1 with *e set. Where some fail: -1 and *e of
 * the first of them; no item is begun after that is known, and none after it is `done`. Else 0. */
int each_run(const struct each *by, size_t n, struct err *e);
