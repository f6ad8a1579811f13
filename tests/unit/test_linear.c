#include "unit.h"

#include "base/half.h"
#include "base/rng.h"
#include "nn/linear.h"
#include "nn/linear_amx.h"
#include "nn/linear_tile.h"

#include <omp.h>

/* Through void, as floats are meant to be compared to the bit here. */
static int same_bytes(const void *a, const void *b, size_t n)
{
	return !memcmp(a, b, n);
}

static void fill(float *x, size_t n, struct rng *r)
{
	for (size_t i = 0; i < n; i++)
		x[i] = (float)rng_range(r, -1, 1);
}

/* The float64 twin of linear_forward. */
static void forward64(double *out, const float *in, const double *weight, const float *bias, size_t rows,
	size_t in_width, size_t out_width)
{
	for (size_t i = 0; i < rows; i++)
		for (size_t o = 0; o < out_width; o++) {
			double sum = bias ? bias[o] : 0;
			for (size_t k = 0; k < in_width; k++)
				sum += in[i * in_width + k] * weight[o * in_width + k];
			out[i * out_width + o] = sum;
		}
}

static const size_t shapes[][3] = {{1, 1, 1}, {1, 384, 7}, {130, 520, 413}, {13, 3, 16}, {12, 256, 32},
	{25, 257, 33}, {7, 600, 65}, {400, 16, 31}, {49, 40, 128}, {3, 5, 0}, {0, 4, 4}, {4, 0, 5}};

/* Every tile this processor runs, on whole and cut tiles, against float64; the order of sums is fixed, so
 * that the tiles with fma agree to the byte. */
static void product_all_tiles(void)
{
	struct rng r;

	for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
		size_t rows = shapes[s][0], in = shapes[s][1], out = shapes[s][2], count = rows * out;
		float *x = malloc((rows * in + 1) * 4), *w = malloc((out * in + 1) * 4),
		      *bias = malloc((out + 1) * 4);
		float *y = malloc((count + 1) * 4), *first = malloc((count + 1) * 4);
		float *z = malloc((count + 1) * 4);
		char *halves = malloc(1 + 2 * out * in); /* at an odd address */
		double *w64 = malloc((out * in + 1) * 8), *y64 = malloc((count + 1) * 8);
		rng_seed(&r, s, 1);
		fill(x, rows * in, &r);
		fill(w, out * in, &r);
		fill(bias, out, &r);
		for (size_t i = 0; i < out * in; i++) {
			if (i % 37 == 0) /* below normal halves, or 0 */
				w[i] *= i % 2 ? 1e-5f : 0;
			const uint16_t half = half_of_float(w[i]);
			memcpy(halves + 1 + 2 * i, &half, sizeof half);
			w64[i] = w[i] = half_to_float(half);
		}
		forward64(y64, x, w64, bias, rows, in, out);
		linear_forward(first, x, w, bias, rows, in, out);
		for (int t = 0; linear_tile_get(t); t++) {
			const struct linear_tile *tile = linear_tile_get(t);
			struct linear_matrix a = {x, in, 1}, b = {w, 1, in};
			double worst = 0;
			y[count] = 42;
			linear_product_with(tile, y, out, bias, 0, a, b, rows, out, in);
			for (size_t i = 0; i < count; i++)
				worst = fmax(worst, fabs(y[i] - y64[i]));
			CHECK(worst <= 3e-5, "%s, shape %zu: error %g", tile->name, s, worst);
			CHECK(y[count] == 42, "%s, shape %zu: wrote past the end", tile->name, s);
			CHECK(!strcmp(tile->name, "plain") || same_bytes(y, first, count * 4),
				"%s, shape %zu: other bytes than the best tile", tile->name, s);
			for (int is_half = 0; is_half < 2; is_half++) {
				struct linear_layer l = {z, x, {w, NULL}, bias, rows, in, out};
				if (is_half)
					l.weight = (struct linear_weight){.halves = halves + 1};
				z[count] = 42;
				linear_layer_with(tile, &l);
				CHECK(same_bytes(y, z, (count + 1) * 4), "%s, shape %zu, %s: other bytes",
					tile->name, s, is_half ? "halves" : "turned");
			}
		}
		free(x);
		free(w);
		free(bias);
		free(y);
		free(first);
		free(w64);
		free(y64);
		free(z);
		free(halves);
	}
}

/* Layers of half floats where the processor has AMX: the same bytes for any number of threads and whatever
 * other rows there are, at most three times as far from float64 as sums of floats. */
static void layers_of_halves(void)
{
	static const size_t widths[][2] = {{32, 32}, {96, 160}, {384, 384}, {384, 1536}, {1536, 384}};
	enum { ROWS = 300, WIDEST = 1536 };
	float *x = malloc(ROWS * WIDEST * 4), *w = malloc(384 * WIDEST * 4), *bias = malloc(WIDEST * 4);
	float *y = malloc(ROWS * WIDEST * 4), *z = malloc(ROWS * WIDEST * 4);
	double *w64 = malloc(384 * WIDEST * 8), *y64 = malloc(ROWS * WIDEST * 8);
	char *halves = malloc(1 + 2 * 384 * WIDEST); /* at an odd address */
	struct rng r;

	for (size_t s = 0; s < sizeof widths / sizeof *widths; s++) {
		const size_t in = widths[s][0], out = widths[s][1];
		struct linear_layer l = {y, x, {NULL, halves + 1}, bias, ROWS, in, out};
		double worst[2] = {0};
		rng_seed(&r, s, 1);
		fill(x, ROWS * in, &r);
		fill(w, in * out, &r);
		fill(bias, out, &r);
		for (size_t i = 0; i < in * out; i++) {
			if (i % 37 == 0) /* below normal halves, or 0 */
				w[i] *= i % 2 ? 1e-5f : 0;
			const uint16_t half = half_of_float(w[i]);
			memcpy(halves + 1 + 2 * i, &half, sizeof half);
			w64[i] = half_to_float(half);
		}
		if (!linear_amx_fits(&l))
			continue;
		forward64(y64, x, w64, bias, ROWS, in, out);
		for (int is_amx = 0; is_amx < 2; is_amx++) {
			if (is_amx)
				linear_amx_run(&l, 1);
			else
				linear_layer_with(linear_tile_get(0), &l);
			for (size_t i = 0; i < ROWS * out; i++)
				worst[is_amx] = fmax(worst[is_amx], fabs(y[i] - y64[i]));
		}
		CHECK(worst[1] < 3 * worst[0], "%zu to %zu: %g from float64, by vectors %g", in, out,
			worst[1], worst[0]);
		for (size_t rows = 1; rows <= 130; rows += rows < 34 ? 1 : 32) {
			l.out = z;
			l.in = x + (ROWS - rows) * in;
			l.rows = rows;
			z[rows * out] = 42;
			linear_amx_run(&l, rows % 9);
			CHECK(same_bytes(z, y + (ROWS - rows) * out, rows * out * 4),
				"%zu to %zu: other bytes of %zu rows", in, out, rows);
			CHECK(z[rows * out] == 42, "%zu to %zu: wrote past %zu rows", in, out, rows);
		}
	}
	free(x), free(w), free(bias), free(y), free(z), free(w64), free(y64), free(halves);
}

/* Results do not depend on how many threads there are. */
static void same_for_any_threads(void)
{
	enum { ROWS = 333, IN = 300, OUT = 200 };
	float *x = malloc(ROWS * IN * 4), *w = malloc(OUT * IN * 4), *y[2], *dx[2], *dw[2], *db[2];
	struct rng r;
	int threads = omp_get_max_threads();

	rng_seed(&r, 7, 1);
	fill(x, ROWS * IN, &r);
	fill(w, OUT * IN, &r);
	for (int pass = 0; pass < 2; pass++) {
		omp_set_num_threads(pass ? 3 : 1);
		y[pass] = malloc(ROWS * OUT * 4);
		dx[pass] = malloc(ROWS * IN * 4);
		dw[pass] = calloc(OUT * IN, 4);
		db[pass] = calloc(OUT, 4);
		linear_forward(y[pass], x, w, NULL, ROWS, IN, OUT);
		linear_backward(dx[pass], dw[pass], db[pass], y[pass], x, w, ROWS, IN, OUT);
	}
	omp_set_num_threads(threads);
	CHECK(same_bytes(y[0], y[1], ROWS * OUT * 4), "forward");
	CHECK(same_bytes(dx[0], dx[1], ROWS * IN * 4), "din");
	CHECK(same_bytes(dw[0], dw[1], OUT * IN * 4), "dweight");
	CHECK(same_bytes(db[0], db[1], OUT * 4), "dbias");
	for (int pass = 0; pass < 2; pass++) {
		free(y[pass]);
		free(dx[pass]);
		free(dw[pass]);
		free(db[pass]);
	}
	free(x);
	free(w);
}

/* The scalar whose gradient is checked: sum of c * forward(x, w, b), in float64 with one number moved. */
static double objective(const float *x, const float *w, const float *b, const float *c, size_t rows,
	size_t in, size_t out, int which, size_t index, double step)
{
	double total = 0;

	for (size_t i = 0; i < rows; i++)
		for (size_t o = 0; o < out; o++) {
			double sum = b[o] + (which == 2 && index == o ? step : 0);
			for (size_t k = 0; k < in; k++) {
				double xv = x[i * in + k] + (which == 0 && index == i * in + k ? step : 0);
				double wv = w[o * in + k] + (which == 1 && index == o * in + k ? step : 0);
				sum += xv * wv;
			}
			total += c[i * out + o] * sum;
		}
	return total;
}

static void backward_is_the_gradient(void)
{
	enum { ROWS = 29, IN = 17, OUT = 35 };
	float x[ROWS * IN], w[OUT * IN], b[OUT], c[ROWS * OUT], dx[ROWS * IN], dw[OUT * IN], db[OUT];
	struct {
		const char *name;
		const float *gradient;
		size_t n;
		float before; /* what the gradient is added to */
	} parts[3] = {{"din", dx, ROWS * IN, 0}, {"dweight", dw, OUT * IN, 0.5f}, {"dbias", db, OUT, -2}};
	struct rng r;

	rng_seed(&r, 3, 1);
	fill(x, ROWS * IN, &r);
	fill(w, OUT * IN, &r);
	fill(b, OUT, &r);
	fill(c, ROWS * OUT, &r);
	for (size_t i = 0; i < OUT * IN; i++)
		dw[i] = 0.5f;
	for (size_t i = 0; i < OUT; i++)
		db[i] = -2;
	linear_backward(dx, dw, db, c, x, w, ROWS, IN, OUT);
	for (int p = 0; p < 3; p++) {
		double worst = 0;
		for (size_t i = 0; i < parts[p].n; i++) {
			double high = objective(x, w, b, c, ROWS, IN, OUT, p, i, 1e-3);
			double low = objective(x, w, b, c, ROWS, IN, OUT, p, i, -1e-3);
			worst = fmax(
				worst, fabs((high - low) / 2e-3 + parts[p].before - parts[p].gradient[i]));
		}
		CHECK(worst < 1e-5, "%s is off by %g", parts[p].name, worst);
	}
}

/* 600 words through the widest layer of MLP_t: the float32 gradients against float64 sums. */
static void backward_against_float64(void)
{
	enum { ROWS = 600, IN = 384, OUT = 96 };
	float *x = malloc(ROWS * IN * 4), *w = malloc(OUT * IN * 4), *dy = malloc(ROWS * OUT * 4);
	float *dx = malloc(ROWS * IN * 4), *dw = calloc(OUT * IN, 4), *db = calloc(OUT, 4);
	double worst[3] = {0};
	struct rng r;

	rng_seed(&r, 5, 1);
	fill(x, ROWS * IN, &r);
	fill(w, OUT * IN, &r);
	fill(dy, ROWS * OUT, &r);
	linear_backward(dx, dw, db, dy, x, w, ROWS, IN, OUT);
	for (size_t k = 0; k < IN; k++) {
		for (size_t i = 0; i < ROWS; i++) {
			double sum = 0;
			for (size_t o = 0; o < OUT; o++)
				sum += (double)dy[i * OUT + o] * w[o * IN + k];
			worst[0] = fmax(worst[0], fabs(sum - dx[i * IN + k]));
		}
		for (size_t o = 0; o < OUT; o++) {
			double sum = 0;
			for (size_t i = 0; i < ROWS; i++)
				sum += (double)dy[i * OUT + o] * x[i * IN + k];
			worst[1] = fmax(worst[1], fabs(sum - dw[o * IN + k]));
		}
	}
	for (size_t o = 0; o < OUT; o++) {
		double sum = 0;
		for (size_t i = 0; i < ROWS; i++)
			sum += dy[i * OUT + o];
		worst[2] = fmax(worst[2], fabs(sum - db[o]));
	}
	for (int i = 0; i < 3; i++)
		CHECK(worst[i] < 5e-5, "gradient %d is off by %g", i, worst[i]);
	free(x);
	free(w);
	free(dy);
	free(dx);
	free(dw);
	free(db);
}

int main(void)
{
	product_all_tiles();
	layers_of_halves();
	same_for_any_threads();
	backward_is_the_gradient();
	backward_against_float64();
	return unit_end();
}
