#include "base/rng.h"
#include "score/bootstrap.h"
#include "score/score_rows.h"
#include "unit.h"

#include <omp.h>

static struct interval mean_interval(const double *values, size_t n, const struct bootstrap *how)
{
	double sums[256][2];
	struct interval i;
	struct err e;

	for (size_t k = 0; k < n; k++) {
		sums[k][0] = values[k];
		sums[k][1] = 1;
	}
	if (bootstrap_ratios(&i, sums[0], n, 1, how, &e))
		abort();
	return i;
}

/* Every unit has the same ratio, whatever its weight. */
static void test_constant(void)
{
	double sums[9][2][2];
	struct interval i[2];
	struct err e;

	for (int k = 0; k < 9; k++) {
		sums[k][0][0] = 0.5 * (k + 1);
		sums[k][0][1] = k + 1;
		sums[k][1][0] = 0;
		sums[k][1][1] = 2;
	}
	CHECK(!bootstrap_ratios(i, sums[0][0], 9, 2, &(struct bootstrap){200, 0.95, 1}, &e), "runs");
	CHECK(i[0].low == 0.5 && i[0].high == 0.5, "%g %g", i[0].low, i[0].high);
	CHECK(i[1].low == 0 && i[1].high == 0, "%g %g", i[1].low, i[1].high);
}

/* The mean of two draws from 0 and 1 is 0, 1/2 and 1, a quarter, half and a quarter of the time. */
static void test_two(void)
{
	const double values[2] = {0, 1};
	struct interval wide = mean_interval(values, 2, &(struct bootstrap){1000, 0.6, 1});
	struct interval narrow = mean_interval(values, 2, &(struct bootstrap){1000, 0.4, 1});
	struct interval one = mean_interval(values, 2, &(struct bootstrap){1, 0.95, 1});

	CHECK(wide.low == 0 && wide.high == 1, "%g %g", wide.low, wide.high);
	CHECK(narrow.low == 0.5 && narrow.high == 0.5, "%g %g", narrow.low, narrow.high);
	CHECK(one.low == one.high, "one resample: %g %g", one.low, one.high);
}

/* Against the quantiles of a normal: the mean of n values of variance 1 has a deviation of 1/sqrt(n). */
static void test_width(void)
{
	double values[200], mean = 0, square = 0;
	struct rng r;

	rng_seed(&r, 3, 1);
	for (int i = 0; i < 200; i++) {
		values[i] = rng_normal(&r);
		mean += values[i] / 200;
		square += values[i] * values[i] / 200;
	}
	const double deviation = sqrt((square - mean * mean) / 200);
	struct interval i = mean_interval(values, 200, &(struct bootstrap){20000, 0.95, 5});
	CHECK(fabs((i.low - mean) / deviation + 1.96) < 0.05, "%g", (i.low - mean) / deviation);
	CHECK(fabs((i.high - mean) / deviation - 1.96) < 0.05, "%g", (i.high - mean) / deviation);
	i = mean_interval(values, 200, &(struct bootstrap){20000, 0.5, 5});
	CHECK(fabs((i.high - mean) / deviation - 0.674) < 0.05, "%g", (i.high - mean) / deviation);
}

static void test_coverage(void)
{
	enum { RUNS = 600, N = 40 };
	struct rng r;
	int covered = 0;

	rng_seed(&r, 7, 1);
	for (int run = 0; run < RUNS; run++) {
		double values[N];
		for (int i = 0; i < N; i++)
			values[i] = 3 + rng_normal(&r);
		struct interval i = mean_interval(values, N, &(struct bootstrap){300, 0.95, (uint64_t)run});
		covered += i.low <= 3 && 3 <= i.high;
	}
	CHECK(covered > 0.91 * RUNS && covered < 0.97 * RUNS, "%d of %d", covered, RUNS);
}

/* Pairs of one object are alike: drawing objects covers, where drawing pairs would be far from it. */
static void test_clusters(void)
{
	enum { RUNS = 300, OBJECTS = 20, EACH = 10 };
	static char names[OBJECTS][16];
	static struct score_pair pairs[OBJECTS * EACH];
	struct rng r;
	int covered = 0, covered_singly = 0;

	rng_seed(&r, 9, 1);
	for (int run = 0; run < RUNS; run++) {
		const struct bootstrap how = {200, 0.95, (uint64_t)run};
		double values[OBJECTS * EACH];
		struct score_row row;
		struct err e;
		for (int i = 0; i < OBJECTS; i++) {
			double effect = 0.1 * rng_normal(&r);
			snprintf(names[i], sizeof names[i], "%02d", i);
			for (int j = 0; j < EACH; j++) {
				values[i * EACH + j] = 0.5 + effect + 0.03 * rng_normal(&r);
				pairs[i * EACH + j] = (struct score_pair){
					.object = names[i], .iou = values[i * EACH + j], .either = 1};
			}
		}
		const struct score_sample sample = {OBJECTS * EACH, pairs, NULL, &how};
		CHECK(!score_row_make(&row, "", &sample, &e) && row.unit == SCORE_UNIT_OBJECTS &&
				row.units == OBJECTS,
			"objects");
		covered += row.miou.low <= 0.5 && 0.5 <= row.miou.high;
		struct interval singly = mean_interval(values, OBJECTS * EACH, &how);
		covered_singly += singly.low <= 0.5 && 0.5 <= singly.high;
	}
	CHECK(covered > 0.88 * RUNS && covered < 0.98 * RUNS, "%d of %d", covered, RUNS);
	CHECK(covered_singly < 0.7 * RUNS, "%d of %d", covered_singly, RUNS);
}

static double sign_test(const double *differences, size_t n, size_t resamples)
{
	struct err e;
	double p = -1;

	CHECK(!bootstrap_sign_test(&p, differences, n, &(struct bootstrap){resamples, 0.95, 1}, &e), "runs");
	return p;
}

static void test_signs(void)
{
	const double rising[3] = {1, 2, 3}, balanced[4] = {0.1, -0.3, 0.2, 0}, none[5] = {0};
	const double rounded[4] = {0.1, 0.2, -0.3, 0.001};
	double ones[40], mixed[12];
	struct rng r;

	CHECK(sign_test(rising, 3, 8) == 0.25, "two of eight patterns");
	CHECK(sign_test(balanced, 4, 1000) == 1, "a sum of 0 is never beaten");
	CHECK(sign_test(rounded, 4, 16) == 1, "0.001 more or less, however it is rounded");
	CHECK(sign_test(none, 5, 10) == 1, "no difference");
	CHECK(sign_test(none, 0, 10) == 1, "no units");
	for (int i = 0; i < 40; i++)
		ones[i] = 1;
	CHECK(sign_test(ones, 40, 999) == 1.0 / 1000, "all one way: %g", sign_test(ones, 40, 999));
	CHECK(sign_test(ones, 5, 32) == 2.0 / 32, "exact: %g", sign_test(ones, 5, 32));
	rng_seed(&r, 1, 1);
	for (int i = 0; i < 12; i++)
		mixed[i] = 0.4 + rng_normal(&r);
	double exact = sign_test(mixed, 12, 4096), random = sign_test(mixed, 12, 4095);
	CHECK(exact > 0.01 && exact < 0.9 && fabs(exact - random) < 0.03, "%g %g", exact, random);
	CHECK(exact * 4096 == floor(exact * 4096) && random != exact, "%g %g", exact, random);
}

/* The seed decides, the number of threads does not. */
static void test_threads(void)
{
	enum { MANY = 30000 }; /* resamples, enough for threads to be used */
	double values[50];
	struct rng r;

	rng_seed(&r, 1, 1);
	for (int i = 0; i < 50; i++)
		values[i] = rng_normal(&r);
	omp_set_num_threads(1);
	struct interval one = mean_interval(values, 50, &(struct bootstrap){MANY, 0.95, 1});
	double p = sign_test(values, 50, MANY);
	omp_set_num_threads(3);
	struct interval three = mean_interval(values, 50, &(struct bootstrap){MANY, 0.95, 1});
	struct interval other = mean_interval(values, 50, &(struct bootstrap){MANY, 0.95, 2});
	CHECK(!memcmp(&one, &three, sizeof one), "%a %a", one.low, three.low);
	CHECK(p == sign_test(values, 50, MANY), "%g", p);
	CHECK(one.low != other.low, "another seed");
}

int main(void)
{
	test_constant();
	test_two();
	test_width();
	test_coverage();
	test_clusters();
	test_signs();
	test_threads();
	return unit_end();
}
