#include "base/threads.h"

#include <omp.h>

int threads_available(void)
{
	return omp_get_active_level() < omp_get_max_active_levels() ? omp_get_max_threads() : 1;
}
