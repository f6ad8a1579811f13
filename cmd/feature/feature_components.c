#include "cmd/feature/feature_lifting.h"

#include "base/half.h"
#include "base/mem.h"
#include "nn/linear.h"

#include <math.h>

/* Of more Gaussians so many are looked at, evenly over all, or fewer of wide features: 128 MiB. */
enum { SAMPLE = 32768, SAMPLE_NUMBERS = 1 << 25 };

void feature_components_free(struct feature_components *c)
{
	components_free(&c->of);
	free(c->values);
	*c = (struct feature_components){0};
}

/* rows (room,C) of seen Gaussians, evenly over all; returns how many. */
static size_t take_sample(const struct features *f, size_t seen, size_t room, float *rows)
{
	size_t at = 0, taken = 0;

	for (size_t i = 0; i < f->gaussians && taken < room; i++) {
		if (!(f->weight[i] > 0))
			continue;
		if (at++ * room / seen >= taken)
			features_floats(f, i, 1, rows + taken++ * f->channels);
	}
	return taken;
}

static int find(struct feature_components *c, const struct features *f, size_t count, struct err *e)
{
	const size_t widest = SAMPLE_NUMBERS / f->channels, most = widest < SAMPLE ? widest : SAMPLE;
	size_t seen = 0;

	for (size_t i = 0; i < f->gaussians; i++)
		seen += f->weight[i] > 0;
	const size_t room = seen < most ? seen : most;
	SCOPED float *rows = mem_alloc(room, f->channels * sizeof *rows, "features", e);
	if (!rows)
		return -1;
	const size_t n = take_sample(f, seen, room, rows);
	return components_find(&c->of, rows, n, f->channels, count, e);
}

/* Gaussians are told in blocks of so many. */
enum { BLOCK = 256 };

/* Row i's numbers y (K) are kept, and become what is kept of them. */
static void keep(struct feature_components *c, int is_half, size_t i, float *y)
{
	const size_t count = c->of.count;

	for (size_t k = 0; k < count; k++) {
		if (is_half) {
			const uint16_t half = half_of_float(y[k]);
			((uint16_t *)c->values)[i * count + k] = half;
			y[k] = half_to_float(half);
		} else {
			((float *)c->values)[i * count + k] = y[k];
		}
	}
}

/* n Gaussians from `first` on; sums[0] grows by the squares of their features, sums[1] by those of the
 * errors. x has room for BLOCK times C, C and K. */
static void tell(struct feature_components *c, const struct features *f, size_t first, size_t n, float *x,
	double *sums)
{
	const size_t channels = f->channels, count = c->of.count;
	const struct linear_matrix basis = {c->of.basis, channels, 1};
	float *back = x + BLOCK * channels, *y = back + BLOCK * channels;

	features_floats(f, first, n, x);
	for (size_t i = 0; i < n * channels; i++)
		sums[0] += (double)x[i] * (double)x[i];
	components_of(&c->of, x, n, y);
	for (size_t i = 0; i < n; i++)
		if (f->weight[first + i] > 0)
			keep(c, f->is_half, first + i, y + i * count);
	linear_product(
		back, channels, NULL, 0, (struct linear_matrix){y, count, 1}, basis, n, channels, count);
	for (size_t i = 0; i < n * channels; i++) {
		const double d = f->weight[first + i / channels] > 0 ? (double)x[i] - (double)back[i] : 0;
		sums[1] += d * d;
	}
}

static int tell_all(struct feature_components *c, const struct features *f, struct err *e)
{
	const size_t n = f->gaussians, blocks = (n + BLOCK - 1) / BLOCK,
		     width = 2 * c->of.channels + c->of.count;
	SCOPED double *sums = mem_zalloc(blocks, 2 * sizeof *sums, "components", e);
	double square = 0, off = 0;
	int is_out = 0;

	if (!sums)
		return -1;
#pragma omp parallel reduction(| : is_out)
	{
		struct err own;
		SCOPED float *x = mem_alloc(BLOCK * width, sizeof *x, "features", &own);
		is_out = !x;
#pragma omp for schedule(dynamic)
		for (size_t b = 0; b < blocks; b++)
			if (x)
				tell(c, f, BLOCK * b, n - BLOCK * b < BLOCK ? n - BLOCK * b : BLOCK, x,
					sums + 2 * b);
	}
	for (size_t b = 0; b < blocks; b++) {
		square += sums[2 * b];
		off += sums[2 * b + 1];
	}
	c->error = square > 0 ? sqrt(off / square) : 0;
	return is_out ? err_set(e, ERR_SYSTEM, "components: out of memory") : 0;
}

int feature_components_make(
	struct feature_components *c, const struct features *f, size_t count, struct err *e)
{
	const size_t bytes = count * (f->is_half ? sizeof(uint16_t) : sizeof(float));

	*c = (struct feature_components){0};
	return -(find(c, f, count, e) || !(c->values = mem_zalloc(f->gaussians, bytes, "components", e)) ||
		 tell_all(c, f, e));
}
