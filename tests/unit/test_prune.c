/* Which of a view's weights are left out, against a twin that sorts and sums in whole numbers. */
#include "unit.h"

#include "base/rng.h"
#include "splat/prune.h"

#include <omp.h>

enum { PIXELS = 400, LONGEST = 300 };

/* Rows as they are rendered: at least 2^-29, at most 1 in sum; some empty, some with many equal weights. */
struct sample {
	int64_t indptr[PIXELS + 1];
	int32_t index[PIXELS * LONGEST];
	float weight[PIXELS * LONGEST], transmittance[PIXELS];
};

static float draw(struct rng *r, int kind, size_t n)
{
	const double even = 1.0 / (double)n;

	if (kind == 0)
		return (float)(even * rng_uniform(r) + 1e-6);
	if (kind == 1)
		return (float)(even * exp(-12 * rng_uniform(r))) + 0x1p-29F;
	return 0x1p-9F * (float)(1 + rng_below(r, 2)) * (rng_below(r, 3) ? 1 : 0x1p-20F);
}

static void sample_init(struct sample *s, uint64_t seed)
{
	struct rng r;

	rng_seed(&r, seed, 1);
	s->indptr[0] = 0;
	for (int p = 0; p < PIXELS; p++) {
		const size_t n = p % 7 ? rng_below(&r, LONGEST + 1) : rng_below(&r, 4);
		for (size_t k = 0; k < n; k++) {
			s->index[s->indptr[p] + (int64_t)k] = (int32_t)rng_below(&r, 1000);
			s->weight[s->indptr[p] + (int64_t)k] = draw(&r, p % 3, n);
		}
		s->indptr[p + 1] = s->indptr[p] + (int64_t)n;
	}
}

struct item {
	float weight;
	size_t place;
};

static int by_weight(const void *a, const void *b)
{
	const struct item *x = a, *y = b;

	if (x->weight != y->weight)
		return x->weight < y->weight ? -1 : 1;
	return (x->place < y->place) - (x->place > y->place);
}

/* goes (n); returns the sum of what goes. */
static float twin(const float *row, size_t n, double tolerance, double least, char *goes)
{
	struct item items[LONGEST];
	long double sum = 0, out = 0;

	for (size_t i = 0; i < n; i++) {
		items[i] = (struct item){row[i], i};
		goes[i] = 0;
		sum += (long double)row[i];
	}
	if (n)
		qsort(items, n, sizeof *items, by_weight);
	for (size_t k = 0;
		k < n && out + (long double)items[k].weight <= (long double)(tolerance * (double)sum); k++) {
		out += (long double)items[k].weight;
		goes[items[k].place] = 1;
	}
	out = (long double)(float)out;
	for (size_t i = 0; i < n; i++)
		if (!goes[i] && (double)row[i] < least) {
			out += (long double)row[i];
			goes[i] = 1;
		}
	return out < 1 ? (float)out : 1;
}

static void test_rows(double tolerance, double least, int threads)
{
	static struct sample before, s;
	static float dropped[PIXELS];
	struct render_weights w = {.indptr = s.indptr, .index = s.index, .weight = s.weight};
	size_t out = 0;
	struct err e;

	omp_set_num_threads(threads);
	sample_init(&before, (uint64_t)threads);
	s = before;
	if (!CHECK(!prune_weights(&w, PIXELS, tolerance, least, dropped, &e), "%s", e.message))
		return;
	for (size_t p = 0; p < PIXELS; p++) {
		const float *row = before.weight + before.indptr[p];
		const size_t n = (size_t)(before.indptr[p + 1] - before.indptr[p]);
		char goes[LONGEST];
		int64_t at = s.indptr[p];
		const float sum = twin(row, n, tolerance, least, goes);
		int same = 1;
		for (size_t i = 0; i < n; i++) {
			out += goes[i];
			if (goes[i])
				continue;
			same &= at < s.indptr[p + 1] && s.weight[at] == row[i] &&
				s.index[at] == before.index[before.indptr[p] + (int64_t)i];
			at++;
		}
		CHECK(same && at == s.indptr[p + 1], "tolerance %g, least %g: row %zu of %zu weights",
			tolerance, least, p, n);
		CHECK(!memcmp(&sum, &dropped[p], sizeof sum),
			"tolerance %g, least %g: row %zu drops %.9g, not %.9g", tolerance, least, p,
			(double)dropped[p], (double)sum);
	}
	CHECK((tolerance > 1e-9 || least > 0) == (out > 0), "tolerance %g, least %g: %zu go", tolerance,
		least, out);
}

int main(void)
{
	const double tolerances[] = {0, 1e-12, 0.01, 0.05, 0.5, 0.999},
		     leasts[] = {0, 0.5 / 255, 0x1p-9, 0.3};

	for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++)
		for (size_t k = 0; k < sizeof leasts / sizeof *leasts; k++)
			test_rows(tolerances[t], leasts[k], 1 + (int)(t + k) % 3);
	return unit_end();
}
