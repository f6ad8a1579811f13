/* The optimal assignment against all assignments tried. */
#include "base/rng.h"
#include "nn/assignment.h"
#include "unit.h"

enum { MOST_ROWS = 5, MOST_COLUMNS = 7, LARGE = 120 };

/* The largest sum for the rows from `row` on, with the columns that are not taken. */
static double try_all(const double *value, size_t rows, size_t columns, size_t row, unsigned taken)
{
	double most = -INFINITY;

	if (row == rows)
		return 0;
	for (size_t j = 0; j < columns; j++)
		if (!(taken >> j & 1))
			most = fmax(most, value[row * columns + j] +
						  try_all(value, rows, columns, row + 1, taken | 1u << j));
	return most;
}

static double sum_up(const double *value, size_t rows, size_t columns, const size_t *column, const char *what)
{
	unsigned char taken[LARGE] = {0};
	double sum = 0;

	for (size_t i = 0; i < rows; i++) {
		CHECK(column[i] < columns && !taken[column[i]], "%s: row %zu has column %zu", what, i,
			column[i]);
		taken[column[i]] = 1;
		sum += value[i * columns + column[i]];
	}
	return sum;
}

static void test_brute_force(void)
{
	double value[MOST_ROWS * MOST_COLUMNS];
	size_t column[MOST_ROWS];
	struct rng r;
	struct err e;

	rng_seed(&r, 11, 1);
	for (int round = 0; round < 400; round++) {
		const size_t rows = rng_below(&r, MOST_ROWS + 1);
		const size_t columns = rows + rng_below(&r, (uint32_t)(MOST_COLUMNS - rows + 1));
		/* every third round has whole numbers, so that many assignments are as good */
		for (size_t i = 0; i < rows * columns; i++)
			value[i] = round % 3 ? rng_normal(&r) * 5 : (double)rng_below(&r, 3) - 1;
		CHECK(!assignment_best(value, rows, columns, column, &e), "%s", e.message);
		const double sum = sum_up(value, rows, columns, column, "small");
		const double most = try_all(value, rows, columns, 0, 0);
		CHECK(fabs(sum - most) < 1e-12, "round %d, %zux%zu: %g, expected %g", round, rows, columns,
			sum, most);
	}
}

/* A hidden assignment that nothing beats, as many rows as columns. */
static void test_large(void)
{
	static double value[LARGE * LARGE];
	size_t column[LARGE];
	double price[LARGE];
	struct rng r;
	struct err e;

	rng_seed(&r, 12, 1);
	for (size_t j = 0; j < LARGE; j++)
		price[j] = rng_uniform(&r) * 100;
	for (size_t i = 0; i < LARGE; i++)
		for (size_t j = 0; j < LARGE; j++)
			value[i * LARGE + j] =
				price[i] + price[j] - (j == i * 7 % LARGE ? 0 : 1 + rng_uniform(&r));
	CHECK(!assignment_best(value, LARGE, LARGE, column, &e), "%s", e.message);
	for (size_t i = 0; i < LARGE; i++)
		CHECK(column[i] == i * 7 % LARGE, "row %zu has column %zu", i, column[i]);
	sum_up(value, LARGE, LARGE, column, "large");
}

int main(void)
{
	test_brute_force();
	test_large();
	return unit_end();
}
