#include "nn/lstm.h"

#include "nn/linear.h"

#include <math.h>
#include <string.h>

enum { TOGETHER = 4 }; /* sequences whose steps share one reading of the weights */

/* The clones give the machine's vector width; correctly rounded operations give the same bytes. */
#if defined(__x86_64__) && defined(__GLIBC__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

/* y (wide) += x (terms) matrix (terms,wide), term by term in order. */
CLONES static void add_product(
	float *restrict y, const float *restrict x, const float *restrict matrix, size_t terms, size_t wide)
{
	size_t k = 0;

	for (; k + 4 <= terms; k += 4) {
		const float *r = matrix + k * wide;
		for (size_t j = 0; j < wide; j++)
			y[j] = y[j] + x[k] * r[j] + x[k + 1] * r[wide + j] + x[k + 2] * r[2 * wide + j] +
			       x[k + 3] * r[3 * wide + j];
	}
	for (; k < terms; k++)
		for (size_t j = 0; j < wide; j++)
			y[j] += x[k] * matrix[k * wide + j];
}

/* The same of four rows. */
CLONES static void add_four(float *restrict a, float *restrict b, float *restrict c, float *restrict d,
	const float *const *x, const float *restrict matrix, size_t terms, size_t wide)
{
	for (size_t k = 0; k + 1 < terms; k += 2) {
		const float *r = matrix + k * wide, *next = r + wide;
		const float a0 = x[0][k], a1 = x[0][k + 1], b0 = x[1][k], b1 = x[1][k + 1], c0 = x[2][k],
			    c1 = x[2][k + 1], d0 = x[3][k], d1 = x[3][k + 1];
		for (size_t j = 0; j < wide; j++) {
			a[j] = a[j] + a0 * r[j] + a1 * next[j];
			b[j] = b[j] + b0 * r[j] + b1 * next[j];
			c[j] = c[j] + c0 * r[j] + c1 * next[j];
			d[j] = d[j] + d0 * r[j] + d1 * next[j];
		}
	}
	if (terms % 2) {
		const float *r = matrix + (terms - 1) * wide;
		for (size_t j = 0; j < wide; j++) {
			a[j] += x[0][terms - 1] * r[j];
			b[j] += x[1][terms - 1] * r[j];
			c[j] += x[2][terms - 1] * r[j];
			d[j] += x[3][terms - 1] * r[j];
		}
	}
}

/* Likewise of `count` rows, at most TOGETHER. */
static void add_products(
	float *const *y, const float *const *x, int count, const float *matrix, size_t terms, size_t wide)
{
	if (count == TOGETHER)
		add_four(y[0], y[1], y[2], y[3], x, matrix, terms, wide);
	else
		for (int k = 0; k < count; k++)
			add_product(y[k], x[k], matrix, terms, wide);
}

/* The row that sequence k reads in a step; -1: it has ended. */
static int row_at(const struct lstm_sequences *s, int k, int step)
{
	const int n = s->start[k + 1] - s->start[k];

	return step >= n ? -1 : s->is_reversed ? s->start[k + 1] - 1 - step : s->start[k] + step;
}

static int longest(const struct lstm_sequences *s)
{
	int most = 0;

	for (int k = 0; k < s->count; k++)
		most = s->start[k + 1] - s->start[k] > most ? s->start[k + 1] - s->start[k] : most;
	return most;
}

static float sigmoid(float x)
{
	return 1 / (1 + expf(-x));
}

/* tanh to 1e-7, for a quarter of tanhf's time. */
static float steep(float x)
{
	return 2 * sigmoid(2 * x) - 1;
}

/* One row's gates, of which z holds the sums, its cell and its h. */
static void open_gates(float *z, const float *cell_before, float *cell, float *h, size_t n)
{
	for (size_t j = 0; j < n; j++) {
		const float i = sigmoid(z[j]), f = sigmoid(z[n + j]), g = steep(z[2 * n + j]),
			    o = sigmoid(z[3 * n + j]);
		cell[j] = f * (cell_before ? cell_before[j] : 0) + i * g;
		h[j] = o * steep(cell[j]);
		z[j] = i;
		z[n + j] = f;
		z[2 * n + j] = g;
		z[3 * n + j] = o;
	}
}

/* One step of the sequences from `first` on that go on, at most TOGETHER: returns the next sequence. */
static int step_forward(const struct lstm *w, const struct lstm_sequences *s, const struct lstm_memory *m,
	float *out, size_t stride, int step, int first)
{
	const size_t n = w->units;
	int rows[TOGETHER], before[TOGETHER], count = 0, k = first;
	float *z[TOGETHER];
	const float *h[TOGETHER];

	for (; k < s->count && count < TOGETHER; k++) {
		const int row = row_at(s, k, step);
		if (row < 0)
			continue;
		rows[count] = row;
		before[count] = step ? row_at(s, k, step - 1) : -1;
		z[count] = m->gates + (size_t)row * 4 * n;
		h[count] = m->before + (size_t)row * n;
		if (step)
			memcpy(m->before + (size_t)row * n, out + (size_t)before[count] * stride,
				n * sizeof *out);
		else
			memset(m->before + (size_t)row * n, 0, n * sizeof *out);
		count++;
	}
	if (step)
		add_products(z, h, count, w->recurrent, n, 4 * n);
	for (int c = 0; c < count; c++)
		open_gates(z[c], step ? m->cell + (size_t)before[c] * n : NULL, m->cell + (size_t)rows[c] * n,
			out + (size_t)rows[c] * stride, n);
	return k;
}

void lstm_forward(const struct lstm *w, const struct lstm_sequences *s, const float *x,
	const struct lstm_memory *m, float *out, size_t stride)
{
	const int steps = longest(s);

	linear_forward(m->gates, x, w->input, w->bias, (size_t)s->start[s->count], w->in, 4 * w->units);
	for (int step = 0; step < steps; step++)
		for (int k = 0; k < s->count;)
			k = step_forward(w, s, m, out, stride, step, k);
}

size_t lstm_scratch(const struct lstm *w, int sequences)
{
	return 2 * (size_t)sequences * w->units + 4 * w->units * w->units;
}

/* What one row's gates get of the gradient, in place of their values. dh, dcell: of h and the cell as later
 * rows leave them; dcell becomes that of the cell before, dh is used up. */
static void close_gates(float *z, const float *cell_before, const float *cell, const float *dout, float *dh,
	float *dcell, size_t n)
{
	for (size_t j = 0; j < n; j++) {
		const float i = z[j], f = z[n + j], g = z[2 * n + j], o = z[3 * n + j], t = steep(cell[j]),
			    d = dout[j] + dh[j], dc = dcell[j] + d * o * (1 - t * t);
		z[j] = dc * g * i * (1 - i);
		z[n + j] = dc * (cell_before ? cell_before[j] : 0) * f * (1 - f);
		z[2 * n + j] = dc * i * (1 - g * g);
		z[3 * n + j] = d * t * o * (1 - o);
		dcell[j] = dc * f;
		dh[j] = 0;
	}
}

/* As step_forward, the other way. turned (4H,H): R turned; dh, dcell (sequences,H). */
static int step_backward(const struct lstm *w, const struct lstm_sequences *s, const struct lstm_memory *m,
	const float *dout, size_t stride, int step, int first, const float *turned, float *dh, float *dcell)
{
	const size_t n = w->units;
	int count = 0, k = first;
	float *to[TOGETHER];
	const float *dz[TOGETHER];

	for (; k < s->count && count < TOGETHER; k++) {
		const int row = row_at(s, k, step), before = step ? row_at(s, k, step - 1) : -1;
		if (row < 0)
			continue;
		to[count] = dh + (size_t)k * n;
		dz[count] = m->gates + (size_t)row * 4 * n;
		close_gates(m->gates + (size_t)row * 4 * n, step ? m->cell + (size_t)before * n : NULL,
			m->cell + (size_t)row * n, dout + (size_t)row * stride, to[count],
			dcell + (size_t)k * n, n);
		count++;
	}
	if (step)
		add_products(to, dz, count, turned, 4 * n, n);
	return k;
}

void lstm_backward(const struct lstm *w, const struct lstm *dw, const struct lstm_sequences *s,
	const float *x, const struct lstm_memory *m, const float *dout, size_t stride, float *dx,
	float *scratch)
{
	const size_t n = w->units, rows = (size_t)s->start[s->count];
	float *dh = scratch, *dcell = dh + (size_t)s->count * n, *turned = dcell + (size_t)s->count * n;

	memset(dh, 0, 2 * (size_t)s->count * n * sizeof *dh);
	for (size_t j = 0; j < 4 * n; j++)
		for (size_t k = 0; k < n; k++)
			turned[j * n + k] = w->recurrent[k * 4 * n + j];
	for (int step = longest(s); step-- > 0;)
		for (int k = 0; k < s->count;)
			k = step_backward(w, s, m, dout, stride, step, k, turned, dh, dcell);
	linear_backward(NULL, dw->input, dw->bias, m->gates, x, NULL, rows, w->in, 4 * n);
	const struct linear_matrix dz = {m->gates, 4 * n, 1}, before = {m->before, 1, n},
				   weight = {w->input, w->in, 1};
	linear_product(dw->recurrent, 4 * n, dw->recurrent, 4 * n, before, dz, n, 4 * n, rows);
	linear_product(dx, w->in, dx, w->in, dz, weight, rows, w->in, 4 * n);
}
