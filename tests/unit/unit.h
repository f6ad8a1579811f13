/* The smallest unit test kit. A test's main calls its cases and returns unit_end(); all are one program
 * (program.c). */
#ifndef UNIT_H
#define UNIT_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int unit_failed, unit_passed;

/* How many cases a test draws. The sanitizers, which look for other faults, are ten times as slow: to them
 * fewer. */
#ifdef __SANITIZE_ADDRESS__
#define UNIT_DRAWS(all, few) (few)
#else
#define UNIT_DRAWS(all, few) (all)
#endif

extern char **unit_arguments; /* what follows the test's name, NULL at its end */

/* Counts one named check; prints failures with their place. */
#define CHECK(condition, ...) unit_check(!!(condition), __FILE__, __LINE__, #condition, __VA_ARGS__)

__attribute__((format(printf, 5, 6))) static inline int unit_check(
	int ok, const char *file, int line, const char *text, const char *format, ...)
{
	if (ok) {
		unit_passed++;
		return 1;
	}
	unit_failed++;
	fprintf(stderr, "%s:%d: failed: %s: ", file, line, text);
	__builtin_va_list ap;
	__builtin_va_start(ap, format);
	vfprintf(stderr, format, ap);
	__builtin_va_end(ap);
	fputc('\n', stderr);
	return 0;
}

/* Prints "N passed, M failed"; the exit status. */
static inline int unit_end(void)
{
	printf("%d passed, %d failed\n", unit_passed, unit_failed);
	return unit_failed != 0 || unit_passed == 0;
}

#endif
