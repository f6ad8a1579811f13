/* Which of a block's weights are left out, against a twin that sorts and sums in long double. */
#include "unit.h"

#include "base/rng.h"
#include "splat/kernels.h"

enum { BLOCKS = 25, LONGEST = 300 };

/* A block as it is rendered: weights of at least 2^-29, of a pixel at most 1 in sum; some with none, some
 * with many equal ones. */
struct sample {
	float weights[LONGEST + BLEND_ROWS_MORE][BLEND_LANES];
	uint32_t places[LONGEST];
	uint16_t lanes[LONGEST];
	struct blend_rows rows;
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

static void sample_init(struct sample *s, struct rng *r, int kind)
{
	s->rows = (struct blend_rows){
		s->weights, s->places, s->lanes, kind % 7 ? rng_below(r, LONGEST + 1) : rng_below(r, 4)};
	for (size_t k = 0; k < s->rows.n; k++) {
		s->places[k] = (uint32_t)k;
		for (int l = 0; l < BLEND_LANES; l++)
			s->weights[k][l] = rng_below(r, 4) ? draw(r, (kind + l) % 3, s->rows.n) : 0;
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

/* How many of a lane's weights go; they must be those that go from the twin's. */
static size_t check_lane(const struct sample *before, const struct sample *s, int lane, float dropped,
	double tolerance, double least)
{
	float row[LONGEST];
	char goes[LONGEST];
	size_t n = 0, out = 0, at = 0;
	int same = 1;

	for (size_t k = 0; k < before->rows.n; k++)
		if (before->weights[k][lane] > 0)
			row[n++] = before->weights[k][lane];
	const float sum = twin(row, n, tolerance, least, goes);
	for (size_t k = 0, j = 0; k < before->rows.n; k++) {
		const int stays = j < s->rows.n && s->places[j] == k;
		const float was = before->weights[k][lane], is = stays ? s->weights[j][lane] : 0;
		j += (size_t)stays;
		same &= is == (was > 0 && !goes[at] ? was : 0);
		out += was > 0 && goes[at];
		at += was > 0;
	}
	CHECK(same, "tolerance %g, least %g: %zu weights", tolerance, least, n);
	CHECK(sum == dropped, "tolerance %g, least %g: %zu weights drop %.9g, not %.9g", tolerance, least, n,
		(double)dropped, (double)sum);
	return out;
}

static void test_blocks(double tolerance, double least, enum cpu_level level)
{
	static struct sample before, s;
	size_t out = 0;
	struct rng r;

	rng_seed(&r, 1 + (uint64_t)level, 1);
	for (int b = 0; b < BLOCKS; b++) {
		float dropped[BLEND_LANES], from = (float)least;
		int same = 1;
		sample_init(&s, &r, b);
		before = s;
		kernels_of(level)->prune(
			&s.rows, tolerance, (double)from < least ? nextafterf(from, 1) : from, dropped);
		for (int l = 0; l < BLEND_LANES; l++)
			out += check_lane(&before, &s, l, dropped[l], tolerance, least);
		for (size_t k = 0; k < s.rows.n; k++)
			for (int l = 0; l < BLEND_LANES; l++)
				same &= (s.lanes[k] >> l & 1) == (s.weights[k][l] > 0);
		CHECK(same, "lanes are those that have a weight");
	}
	CHECK((tolerance > 1e-9 || least > 0) == (out > 0), "tolerance %g, least %g: %zu go", tolerance,
		least, out);
}

int main(void)
{
	const double tolerances[] = {0, 1e-12, 0.01, 0.05, 0.5, 0.999},
		     leasts[] = {0, 0.5 / 255, 0x1p-9, 0.3};

	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++)
		for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++)
			for (size_t k = 0; k < sizeof leasts / sizeof *leasts; k++)
				test_blocks(tolerances[t], leasts[k], level);
	return unit_end();
}
