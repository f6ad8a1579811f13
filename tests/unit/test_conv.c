#include "unit.h"

#include "base/rng.h"
#include "nn/conv.h"

#include <omp.h>

enum { CHANNELS = 5, OUT = 7, STRIDE = 9, ROOM = 32 * 32 * STRIDE };

struct data {
	float in[ROOM], out[ROOM], weight[9 * CHANNELS * OUT], bias[OUT], scratch[ROOM * 9];
};

static void draw(struct rng *r, float *x, size_t n)
{
	for (size_t i = 0; i < n; i++)
		x[i] = (float)rng_normal(r);
}

/* A pixel of an image, 0 beyond its edge. */
static double at(const struct conv_image *x, long i, long j, size_t k)
{
	if (i < 0 || j < 0 || i >= (long)x->height || j >= (long)x->width)
		return 0;
	return (double)x->data[((size_t)i * x->width + (size_t)j) * x->stride + k];
}

static double convolved(
	const struct conv *c, const struct conv_image *in, size_t y, size_t x, size_t o, double leak)
{
	const long reach = ((long)c->side - 1) / 2;
	double sum = (double)c->bias[o];

	for (size_t i = 0; i < c->side; i++)
		for (size_t j = 0; j < c->side; j++)
			for (size_t k = 0; k < c->in; k++)
				sum += at(in, (long)(y * c->step + i) - reach,
					       (long)(x * c->step + j) - reach, k) *
				       (double)c->weight[((i * c->side + j) * c->in + k) * c->out + o];
	return sum > 0 ? sum : leak * sum;
}

/* Whether an image is what `wanted` says of each number, and nothing else was written. */
static double worst_of(const struct conv_image *out, const float *all, size_t before)
{
	double worst = 0;

	for (size_t i = 0; i < out->height * out->width; i++)
		for (size_t k = 0; k < STRIDE; k++)
			if (k < before || k >= before + out->channels)
				worst = fmax(worst, fabs((double)all[i * STRIDE + k] - 1e9));
	return worst;
}

static void convolutions(struct data *d, struct rng *r)
{
	static const size_t sizes[][4] = {{3, 1, 6, 8}, {3, 2, 6, 8}, {3, 2, 7, 5}, {1, 1, 6, 8},
		{3, 1, 1, 1}, {3, 2, 1, 2}, {3, 1, 2, 30}};

	for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
		const struct conv c = {sizes[s][0], sizes[s][1], CHANNELS, OUT, d->weight, d->bias};
		const struct conv_image in = {d->in + 2, sizes[s][2], sizes[s][3], CHANNELS, STRIDE},
					out = {d->out + 1, conv_size(in.height, c.step),
						conv_size(in.width, c.step), OUT, STRIDE};
		double worst = 0;
		draw(r, d->in, ROOM);
		draw(r, d->weight, c.side * c.side * CHANNELS * OUT);
		draw(r, d->bias, OUT);
		for (size_t i = 0; i < ROOM; i++)
			d->out[i] = 1e9f;
		CHECK(conv_scratch(&c, out.height * out.width) <= sizeof d->scratch / sizeof *d->scratch,
			"%zu", s);
		conv_forward(&c, out, in, 0.1f, d->scratch);
		for (size_t y = 0; y < out.height; y++)
			for (size_t x = 0; x < out.width; x++)
				for (size_t k = 0; k < OUT; k++)
					worst = fmax(worst, fabs(at(&out, (long)y, (long)x, k) -
								    convolved(&c, &in, y, x, k, 0.1)));
		CHECK(worst < 1e-5 && worst_of(&out, d->out, 1) == 0, "%zu: %g", s, worst);
	}
}

static void largest(struct data *d, struct rng *r)
{
	for (size_t size = 1; size < 9; size++) {
		const struct conv_image in = {d->in, size, size + 1, CHANNELS, STRIDE},
					out = {d->out, conv_size(size, 2), conv_size(size + 1, 2), CHANNELS,
						STRIDE};
		double worst = 0;
		draw(r, d->in, ROOM);
		for (size_t i = 0; i < ROOM; i++)
			d->in[i] -= 10; /* so that 0 beyond the edge would be the largest */
		conv_largest(out, in);
		for (long y = 0; y < (long)out.height; y++)
			for (long x = 0; x < (long)out.width; x++)
				for (size_t k = 0; k < CHANNELS; k++) {
					double most = -1e9;
					for (long n = 0; n < 9; n++) {
						const double v =
							at(&in, 2 * y + n / 3 - 1, 2 * x + n % 3 - 1, k);
						most = v != 0 ? fmax(most, v) : most;
					}
					worst = fmax(worst, fabs(at(&out, y, x, k) - most));
				}
		CHECK(worst == 0, "%zu: %g", size, worst);
	}
}

static void resized(struct data *d, struct rng *r)
{
	static const size_t sizes[][2] = {{13, 26}, {26, 13}, {1, 5}, {5, 1}, {4, 7}, {6, 6}};

	for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
		const size_t m = sizes[s][0], n = sizes[s][1];
		const struct conv_image in = {d->in, m, m, CHANNELS, STRIDE},
					out = {d->out, n, n, CHANNELS, STRIDE};
		double worst = 0;
		draw(r, d->in, ROOM);
		memset(d->out, 0, sizeof d->out);
		conv_add_resized(out, in);
		conv_add_resized(out, in);
		for (size_t y = 0; y < n; y++)
			for (size_t x = 0; x < n; x++)
				for (size_t k = 0; k < CHANNELS; k++) {
					double sum = 0;
					for (size_t i = 0; i < m * m;
						i++) { /* tents around the pixels' centres */
						const double scale = (double)m / (double)n;
						const double down = fmin(
								     fmax(((double)y + 0.5) * scale - 0.5, 0),
								     (double)m - 1),
							     right = fmin(
								     fmax(((double)x + 0.5) * scale - 0.5, 0),
								     (double)m - 1);
						sum += fmax(0, 1 - fabs(down - (double)(i / m))) *
						       fmax(0, 1 - fabs(right - (double)(i % m))) *
						       at(&in, (long)(i / m), (long)(i % m), k);
					}
					worst = fmax(worst, fabs(at(&out, (long)y, (long)x, k) - 2 * sum));
				}
		CHECK(worst < 1e-5, "%zu to %zu: %g", m, n, worst);
	}
}

static void same_for_threads(struct data *d, struct rng *r)
{
	static float first[ROOM];
	const struct conv c = {3, 1, CHANNELS, OUT, d->weight, d->bias};
	const struct conv_image in = {d->in, 32, 32, CHANNELS, STRIDE}, out = {d->out, 32, 32, OUT, STRIDE};

	draw(r, d->in, ROOM);
	for (int threads = 1; threads < 5; threads++) {
		memset(d->out, 0, sizeof d->out);
		omp_set_num_threads(threads);
		conv_forward(&c, out, in, 0.1f, d->scratch);
		conv_add_resized(out, in);
		if (threads == 1)
			memcpy(first, d->out, sizeof first);
		const void *a = first, *b = d->out;
		CHECK(!memcmp(a, b, sizeof first), "%d threads", threads);
	}
}

int main(void)
{
	static struct data d;
	struct rng r;

	rng_seed(&r, 1, 1);
	convolutions(&d, &r);
	largest(&d, &r);
	resized(&d, &r);
	same_for_threads(&d, &r);
	return unit_end();
}
