#include "base/rng.h"

#include <math.h>

uint32_t rng_u32(struct rng *r)
{
	uint64_t old = r->state;

	r->state = old * 6364136223846793005ULL + r->increment;
	uint32_t xorshifted = (uint32_t)(((old >> 18) ^ old) >> 27);
	uint32_t turn = (uint32_t)(old >> 59);
	return (xorshifted >> turn) | (xorshifted << (-turn & 31));
}

void rng_seed(struct rng *r, uint64_t seed, uint64_t stream)
{
	r->state = 0;
	r->increment = (stream << 1) | 1;
	rng_u32(r);
	r->state += seed;
	rng_u32(r);
}

uint32_t rng_below(struct rng *r, uint32_t n)
{
	uint32_t threshold = -n % n;

	for (;;) {
		uint32_t x = rng_u32(r);
		if (x >= threshold)
			return x % n;
	}
}

int rng_draw(struct rng *r, const int *weights, int n)
{
	int sum = 0, i = 0;

	for (int k = 0; k < n; k++)
		sum += weights[k];
	for (int at = (int)rng_below(r, (uint32_t)sum); at >= weights[i]; i++)
		at -= weights[i];
	return i;
}

double rng_uniform(struct rng *r)
{
	uint64_t high = rng_u32(r) >> 5, low = rng_u32(r) >> 6;

	return (double)(high * 67108864 + low) / 9007199254740992.0;
}

double rng_range(struct rng *r, double low, double high)
{
	return low + (high - low) * rng_uniform(r);
}

double rng_normal(struct rng *r)
{
	double u = 1 - rng_uniform(r), v = rng_uniform(r);

	return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

void rng_shuffle(struct rng *r, uint32_t *items, uint32_t n)
{
	for (uint32_t i = n; i > 1; i--) {
		uint32_t j = rng_below(r, i), t = items[i - 1];
		items[i - 1] = items[j];
		items[j] = t;
	}
}
