#include "base/each.h"

#include "base/threads.h"

#include <omp.h>

int each_workers(size_t n)
{
	const int threads = threads_available(), fit = threads < EACH_WORKERS ? threads : EACH_WORKERS;

	return n < (size_t)fit ? (n ? (int)n : 1) : fit;
}

int each_run(const struct each *by, size_t n, struct err *e)
{
	const int threads = threads_available(), levels = omp_get_max_active_levels();
	const int share = threads / by->workers;
	size_t failed = n;

	if (share > 1)
		omp_set_max_active_levels(omp_get_active_level() + 2);
#pragma omp parallel num_threads(by->workers)
	{
		if (by->workers > 1)
			omp_set_num_threads(share > 1 ? share : 1);
#pragma omp for schedule(dynamic) ordered
		for (size_t i = 0; i < n; i++) {
			struct err own;
			size_t end;
#pragma omp critical(each_failed)
			end = failed;
			const int bad = i < end && by->work(by->context, omp_get_thread_num(), i, &own);
#pragma omp ordered
			if (failed == n && (bad || (by->done && by->done(by->context, i, &own)))) {
				*e = own;
#pragma omp critical(each_failed)
				failed = i;
			}
		}
	}
	omp_set_max_active_levels(levels);
	return failed < n ? -1 : 0;
}
