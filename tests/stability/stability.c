#include "stability.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

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

int main(void)
{
	printf("| case | compared | error | bound | what the program does |\n|---|---|---|---|---|\n");
	splat_cases();
	model_cases();
	mask_cases();
	return failed || !rows;
}
