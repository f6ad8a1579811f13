/* Threads of OpenMP. */
#pragma once

/* How many a parallel region that is entered here may have: 1 within one already, unless regions may nest. */
int threads_available(void);
