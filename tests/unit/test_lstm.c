#include "unit.h"

#include "base/rng.h"
#include "nn/lstm.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { IN = 7, UNITS = 6, SEQUENCES = 6, ROWS = 29, PARAMETERS = 4 * UNITS * (IN + UNITS + 1) };

static const int start[SEQUENCES + 1] = {0, 3, 4, 15, 15, 22, ROWS}; /* one is empty */

struct net {
	float slab[PARAMETERS];
	struct lstm w;
};

static void bind(struct net *n)
{
	n->w = (struct lstm){
		IN, UNITS, n->slab, n->slab + 4 * UNITS * IN, n->slab + 4 * UNITS * (IN + UNITS)};
}

struct run {
	float gates[ROWS * 4 * UNITS], cell[ROWS * UNITS], before[ROWS * UNITS], out[ROWS * 2 * UNITS];
};

static struct lstm_memory memory_of(struct run *r)
{
	return (struct lstm_memory){r->gates, r->cell, r->before};
}

/* The equations as they are printed, in double, of one row after the other: h of all rows. */
static void twin(const double *slab, const double *x, int is_reversed, double *h)
{
	const double *w = slab, *r = slab + 4 * UNITS * IN, *b = slab + 4 * UNITS * (IN + UNITS);

	for (int s = 0; s < SEQUENCES; s++) {
		double state[UNITS] = {0}, cell[UNITS] = {0};
		for (int t = 0; t < start[s + 1] - start[s]; t++) {
			const int row = is_reversed ? start[s + 1] - 1 - t : start[s] + t;
			double z[4 * UNITS];
			for (int j = 0; j < 4 * UNITS; j++) {
				z[j] = b[j];
				for (int k = 0; k < IN; k++)
					z[j] += w[j * IN + k] * x[row * IN + k];
				for (int k = 0; k < UNITS; k++)
					z[j] += r[k * 4 * UNITS + j] * state[k];
			}
			for (int j = 0; j < UNITS; j++) {
				const double i = 1 / (1 + exp(-z[j])), f = 1 / (1 + exp(-z[UNITS + j])),
					     g = tanh(z[2 * UNITS + j]), o = 1 / (1 + exp(-z[3 * UNITS + j]));
				cell[j] = f * cell[j] + i * g;
				h[row * UNITS + j] = o * tanh(cell[j]);
			}
			memcpy(state, h + row * UNITS, sizeof state);
		}
	}
}

static void draw(struct rng *r, float *x, int n, double size)
{
	for (int i = 0; i < n; i++)
		x[i] = (float)(size * rng_normal(r));
}

static void widen(double *to, const float *from, int n)
{
	for (int i = 0; i < n; i++)
		to[i] = (double)from[i];
}

static void follows_twin(int is_reversed, double size)
{
	static struct net n;
	static struct run run;
	static float x[ROWS * IN];
	static double slab[PARAMETERS], x64[ROWS * IN], h[ROWS * UNITS];
	const struct lstm_sequences s = {start, SEQUENCES, is_reversed};
	const struct lstm_memory m = memory_of(&run);
	struct rng r;
	double worst = 0;

	rng_seed(&r, 5, (uint64_t)is_reversed);
	bind(&n);
	draw(&r, n.slab, PARAMETERS, size);
	draw(&r, x, ROWS * IN, 1);
	widen(slab, n.slab, PARAMETERS);
	widen(x64, x, ROWS * IN);
	twin(slab, x64, is_reversed, h);
	lstm_forward(&n.w, &s, x, &m, run.out + UNITS, (size_t)2 * UNITS);
	for (int i = 0; i < ROWS; i++)
		for (int j = 0; j < UNITS; j++)
			worst = fmax(
				worst, fabs((double)run.out[(2 * i + 1) * UNITS + j] - h[i * UNITS + j]));
	printf("lstm: worst difference to float64 %.2e\n", worst);
	CHECK(worst < 5e-6, "weights of size %g: worst difference %g", size, worst);
}

/* The gradient of sum dout h, by central differences of the twin. */
static void gradient_is_right(int is_reversed)
{
	static struct net n, dn;
	static struct run run;
	static float x[ROWS * IN], dout[ROWS * UNITS], dx[ROWS * IN];
	static double slab[PARAMETERS], x64[ROWS * IN], h[ROWS * UNITS];
	const struct lstm_sequences s = {start, SEQUENCES, is_reversed};
	const struct lstm_memory m = memory_of(&run);
	struct rng r;

	rng_seed(&r, 6, (uint64_t)is_reversed);
	bind(&n);
	bind(&dn);
	draw(&r, n.slab, PARAMETERS, 0.5);
	draw(&r, x, ROWS * IN, 1);
	draw(&r, dout, ROWS * UNITS, 1);
	memset(dn.slab, 0, sizeof dn.slab);
	memset(dx, 0, sizeof dx);
	widen(slab, n.slab, PARAMETERS);
	widen(x64, x, ROWS * IN);
	float *scratch = malloc(lstm_scratch(&n.w, SEQUENCES) * sizeof *scratch);
	lstm_forward(&n.w, &s, x, &m, run.out, UNITS);
	for (int twice = 0; twice < 2; twice++) { /* gradients are added */
		lstm_forward(&n.w, &s, x, &m, run.out, UNITS);
		lstm_backward(&n.w, &dn.w, &s, x, &m, dout, UNITS, dx, scratch);
	}
	free(scratch);
	for (int i = 0; i < PARAMETERS + ROWS * IN; i++) {
		double *at = i < PARAMETERS ? &slab[i] : &x64[i - PARAMETERS], side[2];
		const double was = *at, got = (double)(i < PARAMETERS ? dn.slab[i] : dx[i - PARAMETERS]) / 2;
		for (int k = 0; k < 2; k++) {
			*at = was + (k ? -1e-5 : 1e-5);
			twin(slab, x64, is_reversed, h);
			side[k] = 0;
			for (int j = 0; j < ROWS * UNITS; j++)
				side[k] += (double)dout[j] * h[j];
		}
		*at = was;
		const double expected = (side[0] - side[1]) / 2e-5;
		CHECK(fabs(got - expected) < 2e-5 * (1 + fabs(expected)), "number %d: %g, by differences %g",
			i, got, expected);
	}
}

/* Sequences alone, together and by many threads: the same bytes. */
static void alone_is_together(int is_reversed)
{
	static struct net n;
	static struct run all, one;
	static float x[ROWS * IN];
	const struct lstm_memory m = memory_of(&all), own = memory_of(&one);
	const int threads = omp_get_max_threads();
	struct rng r;

	rng_seed(&r, 7, 1);
	bind(&n);
	draw(&r, n.slab, PARAMETERS, 1);
	draw(&r, x, ROWS * IN, 1);
	lstm_forward(&n.w, &(struct lstm_sequences){start, SEQUENCES, is_reversed}, x, &m, all.out, UNITS);
	for (int s = 0; s < SEQUENCES; s++) {
		const int own_start[2] = {0, start[s + 1] - start[s]}, count = own_start[1] * UNITS;
		omp_set_num_threads(s + 1);
		lstm_forward(&n.w, &(struct lstm_sequences){own_start, 1, is_reversed}, x + start[s] * IN,
			&own, one.out, UNITS);
		CHECK(!memcmp(one.out, all.out + start[s] * UNITS, (size_t)count * sizeof(float)),
			"sequence %d", s);
	}
	omp_set_num_threads(threads);
}

int main(void)
{
	for (int is_reversed = 0; is_reversed < 2; is_reversed++) {
		follows_twin(is_reversed, 0.5);
		follows_twin(is_reversed, 20); /* gates that are shut or open, and sums past exp's range */
		gradient_is_right(is_reversed);
		alone_is_together(is_reversed);
	}
	return unit_end();
}
