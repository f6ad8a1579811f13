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
