#include "unit.h"

#include "base/vecmath.h"

/* Distance in units of the last place of the rounded truth. */
static double ulps(float have, double want)
{
	float rounded = (float)want;

	return fabs((double)have - want) / ((double)nextafterf(rounded, INFINITY) - (double)rounded);
}

static float lane_exp(float x)
{
	return vec_exp(vec_splat(x))[VEC_LANES - 1];
}

static void exp_is_accurate(void)
{
	double worst = 0, worst2 = 0;

	for (int i = -870000; i < 887000; i++) {
		float x = (float)i * 1e-4f;
		worst = fmax(worst, ulps(lane_exp(x), exp((double)x)));
	}
	CHECK(worst < 1.1, "exp is %g ulp off", worst);
	for (int i = -1260000; i < 1260000; i++) {
		float x = (float)i * 1e-4f;
		worst2 = fmax(worst2, ulps(vec_exp2(vec_splat(x))[0], exp2((double)x)));
	}
	CHECK(worst2 < 2.2, "exp2 is %g ulp off", worst2);
}

static void exp_at_the_ends(void)
{
	CHECK(lane_exp(0) == 1 && lane_exp(-0.0f) == 1, "e^0 = %g", (double)lane_exp(0));
	CHECK(lane_exp(-INFINITY) == 0 && lane_exp(-200) == 0, "e^-200 = %g", (double)lane_exp(-200));
	CHECK(lane_exp(-103) > 0 && lane_exp(-103) < 3e-45f, "e^-103 = %g", (double)lane_exp(-103));
	CHECK(isinf(lane_exp(INFINITY)) && isinf(lane_exp(89)), "e^89 = %g", (double)lane_exp(89));
	CHECK(isfinite(lane_exp(88.72f)), "e^88.72 = %g", (double)lane_exp(88.72f));
	CHECK(isnan(lane_exp(NAN)), "e^NaN = %g", (double)lane_exp(NAN));
}

static void lanes_keep_their_places(void)
{
	float x[VEC_LANES], y[VEC_LANES];
	int32_t counts[VEC_LANES];

	for (int l = 0; l < VEC_LANES; l++) {
		x[l] = (float)l;
		counts[l] = 5;
	}
	vecn v = vec_load(x);
	CHECK(vec_bits(vec_lt(v, vec_splat(2))) == 3, "bits %x", vec_bits(vec_lt(v, vec_splat(2))));
	CHECK((vec_bits(vec_ge(v, vec_splat(2))) & 15) == 12, "bits %x", vec_bits(vec_ge(v, vec_splat(2))));
	CHECK(vec_choose(vec_lt(v, vec_splat(2)), vec_splat(9), v)[1] == 9, "select takes the first");
	CHECK(vec_choose(vec_lt(v, vec_splat(2)), vec_splat(9), v)[2] == 2, "select takes the second");
	CHECK(vec_keep(vec_lt(v, vec_splat(2)), v)[1] == 1 && vec_keep(vec_lt(v, vec_splat(2)), v)[2] == 0,
		"keep");
	vec_count(counts, vec_lt(v, vec_splat(2)));
	CHECK(counts[1] == 6 && counts[2] == 5, "counts are %d, %d", counts[1], counts[2]);
	vec_store(y, vec_fnma(v, vec_splat(2), vec_fma(v, v, vec_splat(1))));
	for (int l = 0; l < VEC_LANES; l++)
		CHECK(y[l] == (float)(l * l + 1 - 2 * l), "lane %d holds %g", l, (double)y[l]);
	CHECK(vec_max(v, vec_splat(1))[0] == 1 && vec_min(v, vec_splat(1))[3] == 1, "max and min");
	CHECK(vec_round(vec_splat(2.5f))[0] == 2 && vec_round(vec_splat(-3.5f))[0] == -4, "ties to even");
}

int main(void)
{
	exp_is_accurate();
	exp_at_the_ends();
	lanes_keep_their_places();
	return unit_end();
}
