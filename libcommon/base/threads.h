/* Threads of OpenMP. */
#ifndef BASE_THREADS_H
#define BASE_THREADS_H

/* How many a parallel region that is entered here may have: 1 within one already, unless regions may nest. */
int threads_available(void);

#endif
