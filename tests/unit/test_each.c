/* Items side by side: all are worked on once, `done` comes in order, and the first failure is the one that is
 * told. */
#include "base/each.h"
#include "unit.h"

#include <omp.h>
#include <string.h>

enum { N = 50 };

struct context {
	int worked[N], of[N], done, threads, workers;
	size_t fails, stops; /* the first item whose work fails, and whose `done` fails; N: none */
};

static int work(void *context, int worker, size_t item, struct err *e)
{
	struct context *c = context;

	c->worked[item]++;
	c->of[item] = worker;
	if (!item)
		c->threads = omp_get_max_threads();
	return item >= c->fails ? err_set(e, ERR_FORMAT, "item %zu", item) : 0;
}

static int done(void *context, size_t item, struct err *e)
{
	struct context *c = context;

	CHECK(item == (size_t)c->done, "%zu is done as the %d-th", item, c->done);
	if (item >= c->stops)
		return err_set(e, ERR_FORMAT, "end of %zu", item);
	c->done++;
	return 0;
}

static int run(struct context *c, size_t n, struct err *e)
{
	const struct each by = {c, each_workers(n), work, done};

	c->workers = by.workers;
	return each_run(&by, n, e);
}

static void all(int threads)
{
	struct context c = {.fails = N, .stops = N};
	struct err e;

	omp_set_num_threads(threads);
	CHECK(!run(&c, N, &e) && c.done == N, "%d threads: %d done", threads, c.done);
	for (int i = 0; i < N; i++)
		CHECK(c.worked[i] == 1 && c.of[i] >= 0 && c.of[i] < c.workers, "item %d: %d times, by %d", i,
			c.worked[i], c.of[i]);
	CHECK(c.workers <= EACH_WORKERS && c.workers <= threads, "%d workers", c.workers);
	CHECK(c.threads * c.workers <= threads || c.threads == 1, "%d threads for each of %d", c.threads,
		c.workers);
	CHECK(omp_get_max_threads() == threads, "%d threads are left of %d", omp_get_max_threads(), threads);
	c = (struct context){.fails = N, .stops = N};
	CHECK(!run(&c, 0, &e) && !c.done && c.workers == 1, "no items");
	c = (struct context){.fails = N, .stops = N};
	CHECK(!run(&c, 1, &e) && c.done == 1 && c.workers == 1, "one item");
}

static void failures(int threads)
{
	struct context c = {.fails = 20, .stops = N};
	struct err e;

	omp_set_num_threads(threads);
	CHECK(run(&c, N, &e) == -1 && !strcmp(e.message, "item 20"), "%d threads: %s", threads, e.message);
	CHECK(c.done == 20, "%d are done before the first that fails", c.done);
	c = (struct context){.fails = 20, .stops = 7};
	CHECK(run(&c, N, &e) == -1 && !strcmp(e.message, "end of 7") && c.done == 7, "%d threads: %s",
		threads, e.message);
}

int main(void)
{
	static const int threads[] = {1, 2, 7, 19};

	for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
		all(threads[i]);
		failures(threads[i]);
	}
	return unit_end();
}
