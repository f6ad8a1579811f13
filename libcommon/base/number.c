#include "base/number.h"

#include <stdio.h>
#include <stdlib.h>

char *number_text(char text[NUMBER_SIZE], double x)
{
	for (int digits = 1; digits <= 17; digits++) {
		snprintf(text, NUMBER_SIZE, "%.*g", digits, x);
		if (strtod(text, NULL) == x)
			break;
	}
	return text;
}

char *number_percent(char text[NUMBER_SIZE], double p)
{
	if (p > 0 && p < 0.01)
		snprintf(text, NUMBER_SIZE, "below 1%%");
	else
		snprintf(text, NUMBER_SIZE, "%.0f%%", p < 1 && p > 0.99 ? 99 : 100 * p);
	return text;
}
