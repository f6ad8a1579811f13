#include "stability.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static int rows, failed;

void row(const char *name, const char *compared, double error, double bound, const char *does)
{
	const int is_bad = !isfinite(error) || error > bound;

	printf("| %s | %s | %.1e | %.0e | %s%s |\n", name, compared, error, bound, is_bad ? "FAILED: " : "",
		does);
	fflush(stdout);
	rows++;
	failed += is_bad;
}

const char *compared(const char *format, ...)
{
	static char texts[8][256];
	static int next;
	char *text = texts[next++ % 8];
	va_list ap;

	va_start(ap, format);
	vsnprintf(text, sizeof texts[0], format, ap);
	va_end(ap);
	return text;
}

/* usage: stability [quick] */
int main(int argc, char **argv)
{
	const int is_quick = argc > 1 && !strcmp(argv[1], "quick");

	printf("| case | compared | error | bound | what the program does |\n|---|---|---|---|---|\n");
	splat_cases(is_quick);
	model_cases(is_quick);
	mask_cases();
	return failed || !rows;
}
