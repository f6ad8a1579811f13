/* An optimal assignment: rows to distinct columns, so that the sum of their values is largest. */
#pragma once

#include "base/err.h"

/* value (rows,columns) row-major, finite; rows <= columns. column (rows) gets a column for each row, no two
 * the same. Shortest augmenting paths (Kuhn 1955; Jonker and Volgenant 1987): rows^2 columns steps. The same
 * values give the same columns, also where several assignments are as good. -1 with *e out of memory. */
int assignment_best(const double *value, size_t rows, size_t columns, size_t *column, struct err *e);
