#include "nn/linear.h"

#include "base/half.h"
#include "nn/linear_amx.h"
#include "nn/linear_tile.h"

#include <omp.h>
#include <string.h>

enum {
	ROWS = 384, /* of a that share one packing of b, unless that leaves too few parts for the threads */
	ROWS_LEAST = 48,
	PARTS_A_THREAD = 4,
	TURNED_ROWS =
		96, /* of the input, and outputs, of a part of a layer: a multiple of every tile's sides */
	TURNED_OUT = 384,
	TURNED_OUT_LEAST = 48,
	SMALL = 1 << 20 /* below this many terms a parallel loop costs more than it saves */
};

static const float zeros[LINEAR_TILE_COLUMNS];

/* GCC has this from version 12 on. */
#ifdef __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define HAS_SHUFFLE
#endif
#endif

/* Four floats of each of four columns, `column` apart, to four rows, `width` apart. */
static void turn(float *out, size_t width, const float *from, size_t column)
{
#ifdef HAS_SHUFFLE
	typedef float four __attribute__((vector_size(16)));
	four a, b, c, d, rows[4];

	memcpy(&a, from, sizeof a);
	memcpy(&b, from + column, sizeof b);
	memcpy(&c, from + 2 * column, sizeof c);
	memcpy(&d, from + 3 * column, sizeof d);
	const four low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
		   low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5),
		   high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7),
		   high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
	rows[0] = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
	rows[1] = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
	rows[2] = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
	rows[3] = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
	for (int k = 0; k < 4; k++)
		memcpy(out + (size_t)k * width, &rows[k], sizeof rows[k]);
#else
	for (size_t k = 0; k < 4; k++)
		for (size_t j = 0; j < 4; j++)
			out[k * width + j] = from[j * column + k];
#endif
}

/* out (n,width) gets the first n of each of `count` columns, `column` apart. */
static void turn_all(float *out, size_t width, const float *from, size_t column, size_t n, size_t count)
{
	const size_t whole = n - n % 4, fours = count - count % 4;

	for (size_t j = 0; j < fours; j += 4)
		for (size_t t = 0; t < whole; t += 4)
			turn(out + t * width + j, width, from + t + j * column, column);
	for (size_t j = 0; j < count; j++)
		for (size_t t = j < fours ? whole : 0; t < n; t++)
			out[t * width + j] = from[t + j * column];
}

/* `terms` rows of b from `first` on, columns column to column+count, as (terms,width), then zeros. */
static void pack(float *out, struct linear_matrix b, size_t first, size_t terms, size_t column, size_t count,
	size_t width)
{
	const float *from = b.data + first * b.row + column * b.column;

	if (b.column == 1) {
		for (size_t t = 0; t < terms; t++)
			for (size_t j = 0; j < count; j++)
				out[t * width + j] = from[t * b.row + j];
	} else if (b.row == 1) {
		turn_all(out, width, from, b.column, terms, count);
	} else {
		for (size_t j = 0; j < count; j++)
			for (size_t t = 0; t < terms; t++)
				out[t * width + j] = from[t * b.row + j * b.column];
	}
	for (size_t t = 0; t < terms && count < width; t++)
		for (size_t j = count; j < width; j++)
			out[t * width + j] = 0;
}

/* A tile at the edge, of rows x columns within c: made in buffers, whose inside is copied. */
static void run_edge(const struct linear_tile *tile, float *c, size_t stride, const float *start,
	size_t start_stride, const float *a, size_t row, size_t column, const float *b, size_t terms,
	size_t rows, size_t columns)
{
	_Alignas(64) float whole[LINEAR_TILE_ROWS * LINEAR_TILE_COLUMNS];
	_Alignas(64) float padded[LINEAR_TILE_ROWS * LINEAR_BLOCK];

	for (size_t i = 0; i < tile->rows; i++)
		for (size_t j = 0; j < tile->columns; j++)
			whole[i * tile->columns + j] =
				i < rows && j < columns ? start[i * start_stride + j] : 0;
	if (rows < tile->rows) {
		for (size_t i = 0; i < tile->rows; i++)
			for (size_t t = 0; t < terms; t++)
				padded[t * tile->rows + i] = i < rows ? a[i * row + t * column] : 0;
		a = padded;
		row = 1;
		column = tile->rows;
	}
	tile->run(whole, tile->columns, whole, tile->columns, a, row, column, b, terms);
	for (size_t i = 0; i < rows; i++)
		for (size_t j = 0; j < columns; j++)
			c[i * stride + j] = whole[i * tile->columns + j];
}

static size_t least(size_t a, size_t b)
{
	return a < b ? a : b;
}

/* The part of c at (row,column) with `rows` rows, at most one tile wide. */
static void run_part(const struct linear_tile *tile, struct linear_matrix a, struct linear_matrix b, size_t k,
	float *c, size_t stride, const float *start, size_t start_stride, size_t row, size_t rows,
	size_t column, size_t columns)
{
	_Alignas(64) float panel[LINEAR_TILE_COLUMNS * LINEAR_BLOCK];

	for (size_t first = 0; first == 0 || first < k; first += LINEAR_BLOCK) {
		size_t terms = least(k - first, LINEAR_BLOCK);
		pack(panel, b, first, terms, column, columns, tile->columns);
		for (size_t i = row; i < row + rows; i += tile->rows) {
			size_t height = least(row + rows - i, tile->rows);
			const float *left = a.data + i * a.row + first * a.column;
			const float *from = start ? start + i * start_stride + column : zeros;
			float *to = c + i * stride + column;
			size_t from_stride = start_stride;
			if (first) {
				from = to;
				from_stride = stride;
			}
			if (height == tile->rows && columns == tile->columns)
				tile->run(to, stride, from, from_stride, left, a.row, a.column, panel, terms);
			else
				run_edge(tile, to, stride, from, from_stride, left, a.row, a.column, panel,
					terms, height, columns);
		}
	}
}

void linear_product_with(const struct linear_tile *tile, float *c, size_t stride, const float *start,
	size_t start_stride, struct linear_matrix a, struct linear_matrix b, size_t m, size_t n, size_t k)
{
	size_t panels = (n + tile->columns - 1) / tile->columns, rows = ROWS;
	size_t wanted = PARTS_A_THREAD * (size_t)omp_get_max_threads();

	if (!start)
		start_stride = 0;
	while (rows > ROWS_LEAST && panels * ((m + rows - 1) / rows) < wanted)
		rows /= 2;
#pragma omp parallel for collapse(2) schedule(dynamic) if ((double)m * (double)n * (double)k > SMALL)
	for (size_t i = 0; i < m; i += rows)
		for (size_t j = 0; j < n; j += tile->columns)
			run_part(tile, a, b, k, c, stride, start, start_stride, i, least(rows, m - i), j,
				least(tile->columns, n - j));
}

void linear_product(float *c, size_t stride, const float *start, size_t start_stride, struct linear_matrix a,
	struct linear_matrix b, size_t m, size_t n, size_t k)
{
	linear_product_with(linear_tile_best(m, n), c, stride, start, start_stride, a, b, m, n, k);
}

void linear_weight_take(float *to, const struct linear_weight *w, size_t first, size_t n)
{
	if (w->halves)
		half_to_floats((const char *)w->halves + 2 * first, n, to);
	else
		memcpy(to, w->floats + first, n * sizeof *to);
}

/* `rows` rows of halves that are wanted soon. */
static void prefetch_weights(
	const struct linear_layer *l, size_t row, size_t rows, size_t first, size_t terms)
{
	for (size_t i = row; i < row + rows && i < l->out_width; i++)
		for (size_t k = 0; k < terms; k += 32)
			__builtin_prefetch(
				(const char *)l->weight.halves + 2 * (i * l->in_width + first + k));
}

/* `rows` rows of a layer's weights, `terms` of each, and zeros to `padded` rows: (padded,terms). */
static void take_weights(float *to, const struct linear_layer *l, size_t row, size_t rows, size_t first,
	size_t terms, size_t padded)
{
	for (size_t i = 0; i < rows; i++)
		linear_weight_take(to + i * terms, &l->weight, (row + i) * l->in_width + first, terms);
	if (l->weight.halves)
		prefetch_weights(l, row + rows, rows, first, terms);
	memset(to + rows * terms, 0, (padded - rows) * terms * sizeof *to);
}

/* A part of a layer, turned: out^T = weight in^T. The weights are read where they lie, and the input, of
 * which there is less, is packed. */
static void run_turned(const struct linear_tile *tile, const struct linear_layer *l, size_t row, size_t rows,
	size_t output, size_t outputs)
{
	_Alignas(64) float panels[TURNED_ROWS * LINEAR_BLOCK], sums[TURNED_OUT * TURNED_ROWS];
	_Alignas(64) float left[LINEAR_TILE_ROWS * LINEAR_BLOCK];
	const struct linear_matrix in = {l->in, 1, l->in_width};
	const size_t padded = (rows + tile->columns - 1) / tile->columns * tile->columns;

	for (size_t i = 0; i < (outputs + tile->rows - 1) / tile->rows * tile->rows; i++)
		for (size_t j = 0; j < padded; j++)
			sums[i * TURNED_ROWS + j] = l->bias && i < outputs ? l->bias[output + i] : 0;
	for (size_t first = 0; first < l->in_width; first += LINEAR_BLOCK) {
		const size_t terms = least(l->in_width - first, LINEAR_BLOCK);
		for (size_t j = 0; j < rows; j += tile->columns)
			pack(panels + j * terms, in, first, terms, row + j, least(rows - j, tile->columns),
				tile->columns);
		for (size_t i = 0; i < outputs; i += tile->rows) {
			const size_t height = least(outputs - i, tile->rows);
			const float *weights = left;
			size_t stride = terms;
			if (l->weight.floats && height == tile->rows) {
				weights = l->weight.floats + (output + i) * l->in_width + first;
				stride = l->in_width;
			} else {
				take_weights(left, l, output + i, height, first, terms, tile->rows);
			}
			for (size_t j = 0; j < rows; j += tile->columns) {
				float *sum = sums + i * TURNED_ROWS + j;
				tile->run(sum, TURNED_ROWS, sum, TURNED_ROWS, weights, stride, 1,
					panels + j * terms, terms);
			}
		}
	}
	turn_all(l->out + row * l->out_width + output, l->out_width, sums, TURNED_ROWS, rows, outputs);
}

void linear_layer_with(const struct linear_tile *tile, const struct linear_layer *l)
{
	const size_t columns = (l->rows + TURNED_ROWS - 1) / TURNED_ROWS,
		     wanted = (size_t)omp_get_max_threads();
	size_t outputs = TURNED_OUT;

	while (outputs > TURNED_OUT_LEAST && columns * ((l->out_width + outputs - 1) / outputs) < wanted)
		outputs /= 2;
#pragma omp parallel for collapse(2)                                                                         \
	schedule(dynamic) if ((double)l->rows * (double)l->in_width * (double)l->out_width > SMALL)
	for (size_t j = 0; j < l->rows; j += TURNED_ROWS)
		for (size_t i = 0; i < l->out_width; i += outputs)
			run_turned(tile, l, j, least(TURNED_ROWS, l->rows - j), i,
				least(outputs, l->out_width - i));
}

void linear_layer_run(const struct linear_layer *l)
{
	if (linear_amx_fits(l))
		linear_amx_run(l, (size_t)omp_get_max_threads());
	else
		linear_layer_with(linear_tile_best(l->out_width, l->rows), l);
}

void linear_forward(float *out, const float *in, const float *weight, const float *bias, size_t rows,
	size_t in_width, size_t out_width)
{
	struct linear_matrix a = {in, in_width, 1}, b = {weight, 1, in_width};

	if (rows < out_width)
		linear_layer_run(
			&(struct linear_layer){out, in, {weight, NULL}, bias, rows, in_width, out_width});
	else
		linear_product(out, out_width, bias, 0, a, b, rows, out_width, in_width);
}

/* Sums of the columns, rows in order, in blocks as in a product. */
static void add_columns(float *sum, const float *x, size_t rows, size_t width)
{
#pragma omp parallel for schedule(static) if (rows * width > SMALL)
	for (size_t j = 0; j < width; j += LINEAR_TILE_COLUMNS) {
		size_t columns = least(width - j, LINEAR_TILE_COLUMNS);
		for (size_t first = 0; first < rows; first += LINEAR_BLOCK) {
			float block[LINEAR_TILE_COLUMNS] = {0};
			for (size_t i = first; i < rows && i < first + LINEAR_BLOCK; i++)
				for (size_t l = 0; l < columns; l++)
					block[l] += x[i * width + j + l];
			for (size_t l = 0; l < columns; l++)
				sum[j + l] += block[l];
		}
	}
}

void linear_backward(float *din, float *dweight, float *dbias, const float *dout, const float *in,
	const float *weight, size_t rows, size_t in_width, size_t out_width)
{
	struct linear_matrix by_row = {dout, out_width, 1}, by_column = {dout, 1, out_width};
	struct linear_matrix x = {in, in_width, 1}, w = {weight, in_width, 1};

	if (din)
		linear_product(din, in_width, NULL, 0, by_row, w, rows, in_width, out_width);
	if (dweight)
		linear_product(dweight, in_width, dweight, in_width, by_column, x, out_width, in_width, rows);
	if (dbias)
		add_columns(dbias, dout, rows, out_width);
}
