/* Products on panels of Gaussians (field/block.h): W x, and the sums of outer products that give the
 * gradients of W. Included by block_forward.h, for each instruction set. */
#include "field/block.h"

#include "base/vecmath.h"

#include <math.h>
#include <string.h>

enum {
	L = BLOCK_LANES,
	/* Tiles whose sums stay in registers: of a product, rows x vectors of Gaussians, and of an outer
	   product. */
	ROWS = VEC_LANES == 4 ? 4 : 6,
	TILE = VEC_LANES == 16 ? 4 : 2,
	OUTER_ROWS = VEC_LANES == 16 ? 8 : 4,
	OUTER_COLUMNS = VEC_LANES == 4 ? 2 : 3,
	AHEAD = 3, /* panels that a product fetches meanwhile */
};

/* Where part i of `parts` nearly equal ones of n begins. */
VEC_INLINE int part_start(int n, int i, int parts)
{
	return n * i / parts;
}

VEC_INLINE vecn vec_sqrt(vecn x)
{
#if VEC_LANES == 16
	return (vecn)_mm512_sqrt_ps((__m512)x);
#elif VEC_LANES == 8
	return (vecn)_mm256_sqrt_ps((__m256)x);
#else
	for (int i = 0; i < VEC_LANES; i++)
		x[i] = sqrtf(x[i]);
	return x;
#endif
}

/* x in the first `count` lanes, `fill` in the others. */
VEC_INLINE vecn vec_first(vecn x, int count, float fill)
{
	static const float lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

	return vec_choose(vec_lt(vec_load(lanes), vec_splat((float)count)), x, vec_splat(fill));
}

/* sum += W in, for `rows` rows of W and TILE vectors of Gaussians. */
VEC_INLINE void tile_add(
	const int rows, vecn sum[ROWS][TILE], const float *w, int stride, int columns, const float *in)
{
	for (int c = 0; c < columns; c++) {
		vecn x[TILE];
#pragma GCC unroll 4
		for (int v = 0; v < TILE; v++)
			x[v] = vec_load(in + c * L + VEC_LANES * v);
#pragma GCC unroll 6
		for (int r = 0; r < rows; r++) {
			vecn scale = vec_splat(w[r * stride + c]);
#pragma GCC unroll 4
			for (int v = 0; v < TILE; v++)
				sum[r][v] = vec_fma(scale, x[v], sum[r][v]);
		}
	}
}

/* A term of a product: w in, with w's rows `stride` apart, and in (columns,L) of one panel. */
struct term {
	const float *w;
	int stride, columns;
	const float *in;
};

enum base { FROM_ZERO, FROM_PANEL, FROM_BIAS };

/* `rows` rows, from row r on, of out = base + the terms, over TILE vectors from v on: the base is 0, a panel
 * or a bias. */
VEC_INLINE void product_tile(const int rows, float *out, int r, int v, const struct term *terms, int count,
	const float *from, const enum base base, const int relu)
{
	vecn sum[ROWS][TILE];

#pragma GCC unroll 6
	for (int i = 0; i < rows; i++)
#pragma GCC unroll 4
		for (int w = 0; w < TILE; w++)
			sum[i][w] = base == FROM_PANEL ? vec_load(from + (r + i) * L + v + VEC_LANES * w)
						       : vec_splat(base == FROM_BIAS ? from[r + i] : 0);
	for (int t = 0; t < count; t++)
		tile_add(rows, sum, terms[t].w + r * terms[t].stride, terms[t].stride, terms[t].columns,
			terms[t].in + v);
#pragma GCC unroll 6
	for (int i = 0; i < rows; i++)
#pragma GCC unroll 4
		for (int w = 0; w < TILE; w++)
			vec_store(out + (r + i) * L + v + VEC_LANES * w,
				relu ? vec_max(sum[i][w], vec_splat(0)) : sum[i][w]);
}

/* Part i of `parts` of fetching a panel of BLOCK_G channels into the second cache, ahead of its use. NULL:
 * none. The processor's own prefetching stops at every page and falls behind. */
VEC_INLINE void fetch_part(const float *panel, int i, int parts)
{
	enum { LINE = 16, LINES = BLOCK_G * L / LINE };

	if (panel)
		for (int line = part_start(LINES, i, parts); line < part_start(LINES, i + 1, parts); line++)
			__builtin_prefetch(panel + line * LINE, 0, 2);
}

/* out (rows,L) = base + the terms, for one panel; meanwhile fetches the panels `ahead`. */
VEC_INLINE void product(float *out, int rows, const struct term *terms, int count, const float *from,
	const enum base base, const int relu, const float *const ahead[AHEAD])
{
	const int parts = (rows + ROWS - 1) / ROWS;

	for (int v = 0; v < L; v += TILE * VEC_LANES)
		for (int i = 0; i < parts; i++) {
			const int r = part_start(rows, i, parts);
			for (int k = 0; v == 0 && k < AHEAD; k++)
				fetch_part(ahead[k], i, parts);
			switch (part_start(rows, i + 1, parts) - r) {
			case 1:
				product_tile(1, out, r, v, terms, count, from, base, relu);
				break;
			case 2:
				product_tile(2, out, r, v, terms, count, from, base, relu);
				break;
			case 3:
				product_tile(3, out, r, v, terms, count, from, base, relu);
				break;
			case 4:
				product_tile(4, out, r, v, terms, count, from, base, relu);
				break;
#if VEC_LANES > 4
			case 5:
				product_tile(5, out, r, v, terms, count, from, base, relu);
				break;
			case 6:
				product_tile(6, out, r, v, terms, count, from, base, relu);
				break;
#endif
			}
		}
}

static const float *const no_panels[AHEAD];

/* out = from + the terms; `from` NULL: 0. */
static void product_sum(float *out, const float *from, int rows, const struct term *terms, int count,
	const float *const ahead[AHEAD])
{
	if (from)
		product(out, rows, terms, count, from, FROM_PANEL, 0, ahead);
	else
		product(out, rows, terms, count, NULL, FROM_ZERO, 0, ahead);
}

static void product_set(float *out, const float *w, int rows, int columns, int stride, const float *in)
{
	const struct term term = {w, stride, columns, in};

	product_sum(out, NULL, rows, &term, 1, no_panels);
}

static void product_relu(float *out, const float *w, int rows, int columns, const float *in,
	const float *bias, const float *ahead)
{
	const struct term term = {w, columns, columns, in};

	product(out, rows, &term, 1, bias, FROM_BIAS, 1, (const float *const[AHEAD]){ahead});
}

/* A sum over the lanes of panels is one of 16 partial sums, added in the order that AVX-512 has. AVX2 makes
 * eight of them in one pass over the panels and eight in another, and gives the same bits. */
enum { PASSES = VEC_LANES == 8 ? 2 : 1 };

/* Four such sums, each in two parts (plain: one). */
#if VEC_LANES == 4
typedef vecn vecq;
#else
typedef float vecq __attribute__((vector_size(32)));
#endif

/* What one pass gives of them; the passes' are added. */
VEC_INLINE vecq sum_lanes_4(vecn a, vecn b, vecn c, vecn d)
{
#if VEC_LANES == 16
	__m512 ab = _mm512_add_ps(
		_mm512_unpacklo_ps((__m512)a, (__m512)b), _mm512_unpackhi_ps((__m512)a, (__m512)b));
	__m512 cd = _mm512_add_ps(
		_mm512_unpacklo_ps((__m512)c, (__m512)d), _mm512_unpackhi_ps((__m512)c, (__m512)d));
	__m512 all = _mm512_add_ps(_mm512_shuffle_ps(ab, cd, 0x44), _mm512_shuffle_ps(ab, cd, 0xee));
	return (vecq)_mm256_add_ps(_mm512_castps512_ps256(all), _mm512_extractf32x8_ps(all, 1));
#elif VEC_LANES == 8
	__m256 ab = _mm256_add_ps(
		_mm256_unpacklo_ps((__m256)a, (__m256)b), _mm256_unpackhi_ps((__m256)a, (__m256)b));
	__m256 cd = _mm256_add_ps(
		_mm256_unpacklo_ps((__m256)c, (__m256)d), _mm256_unpackhi_ps((__m256)c, (__m256)d));
	return (vecq)_mm256_add_ps(_mm256_shuffle_ps(ab, cd, 0x44), _mm256_shuffle_ps(ab, cd, 0xee));
#else
	return (vecq){(a[0] + a[2]) + (a[1] + a[3]), (b[0] + b[2]) + (b[1] + b[3]),
		(c[0] + c[2]) + (c[1] + c[3]), (d[0] + d[2]) + (d[1] + d[3])};
#endif
}

VEC_INLINE void store_sums_4(float out[4], vecq sums)
{
#if VEC_LANES == 4
	vec_store(out, sums);
#else
	_mm_storeu_ps(out,
		_mm_add_ps(_mm256_castps256_ps128((__m256)sums), _mm256_extractf128_ps((__m256)sums, 1)));
#endif
}

/* A value that is kept in a register: the compiler would load it again for each of its uses. */
VEC_INLINE vecn in_register(vecn x)
{
#if VEC_LANES == 16
	__asm__("" : "+v"(x));
#endif
	return x;
}

/* sum[r * columns + c]: the products of a_r and b_c over every panel, of the lanes of one pass. */
VEC_INLINE void outer_pass(const int rows, const int columns, vecn *sum, const float *a, int a_panel,
	const float *b, int b_panel, int panels, int first)
{
	enum { MOST = OUTER_ROWS * OUTER_COLUMNS };

#pragma GCC unroll 27
	for (int i = 0; i < MOST + 3; i++)
		sum[i] = vec_splat(0);
	for (int p = 0; p < panels; p++, a += a_panel, b += b_panel) {
#pragma GCC unroll 1
		for (int v = first; v < L; v += PASSES * VEC_LANES) { /* unrolled, the sums would move between
									 registers */
			vecn y[OUTER_COLUMNS];
#pragma GCC unroll 3
			for (int c = 0; c < columns; c++)
				y[c] = in_register(vec_load(b + c * L + v));
#pragma GCC unroll 8
			for (int r = 0; r < rows; r++) {
				vecn x = in_register(vec_load(a + r * L + v));
#pragma GCC unroll 3
				for (int c = 0; c < columns; c++)
					sum[r * columns + c] = vec_fma(x, y[c], sum[r * columns + c]);
			}
		}
	}
}

/* Sums of products over the lanes of every panel: out[r][c] += sum a_r b_c. */
VEC_INLINE void outer_tile(const int rows, const int columns, float *out, int stride, const float *a,
	int a_panel, const float *b, int b_panel, int panels)
{
	enum { MOST = OUTER_ROWS * OUTER_COLUMNS, QUADS = (MOST + 3) / 4 };
	vecq quads[QUADS];
	float total[4 * QUADS];

#pragma GCC unroll 2
	for (int pass = 0; pass < PASSES; pass++) {
		vecn sum[MOST + 3];
		outer_pass(rows, columns, sum, a, a_panel, b, b_panel, panels, pass * VEC_LANES);
#pragma GCC unroll 8
		for (int i = 0; i < (rows * columns + 3) / 4; i++) {
			const vecq quad =
				sum_lanes_4(sum[4 * i], sum[4 * i + 1], sum[4 * i + 2], sum[4 * i + 3]);
			quads[i] = pass ? quads[i] + quad : quad;
		}
	}
#pragma GCC unroll 8
	for (int i = 0; i < (rows * columns + 3) / 4; i++)
		store_sums_4(total + 4 * i, quads[i]);
#pragma GCC unroll 8
	for (int r = 0; r < rows; r++)
#pragma GCC unroll 3
		for (int c = 0; c < columns; c++)
			out[r * stride + c] += total[r * columns + c];
}

VEC_INLINE void outer_rows(const int rows, float *out, int columns, int stride, const float *a, int a_panel,
	const float *b, int b_panel, int panels)
{
	const int parts = (columns + OUTER_COLUMNS - 1) / OUTER_COLUMNS;

	for (int i = 0; i < parts; i++) {
		const int c = part_start(columns, i, parts), width = part_start(columns, i + 1, parts) - c;
		const float *from = b + (size_t)c * L;
		switch (width) {
		case 1:
			outer_tile(rows, 1, out + c, stride, a, a_panel, from, b_panel, panels);
			break;
		case 2:
			outer_tile(rows, 2, out + c, stride, a, a_panel, from, b_panel, panels);
			break;
#if VEC_LANES > 4
		case 3:
			outer_tile(rows, 3, out + c, stride, a, a_panel, from, b_panel, panels);
			break;
#endif
		}
	}
}

VEC_INLINE void outer_any(float *out, int rows, int columns, int stride, const float *a, int a_channels,
	const float *b, int b_channels, int panels, const int is_lower)
{
	const int parts = (rows + OUTER_ROWS - 1) / OUTER_ROWS, a_panel = a_channels * L,
		  b_panel = b_channels * L;

	for (int i = 0; i < parts; i++) {
		const int r = part_start(rows, i, parts), end = part_start(rows, i + 1, parts);
		const int width = is_lower && end < columns ? end : columns;
		float *to = out + (size_t)r * (size_t)stride;
		const float *from = a + (size_t)r * L;
		switch (end - r) {
		case 1:
			outer_rows(1, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 2:
			outer_rows(2, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 3:
			outer_rows(3, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 4:
			outer_rows(4, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
#if VEC_LANES == 16
		case 5:
			outer_rows(5, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 6:
			outer_rows(6, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 7:
			outer_rows(7, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
		case 8:
			outer_rows(8, to, width, stride, from, a_panel, b, b_panel, panels);
			break;
#endif
		}
	}
}

/* out (rows,columns; rows `stride` apart) += sum over the lanes of `panels` panels of a (rows) times b
 * (columns); a_channels and b_channels are the channels in a panel of each. */
static void outer(float *out, int rows, int columns, int stride, const float *a, int a_channels,
	const float *b, int b_channels, int panels)
{
	outer_any(out, rows, columns, stride, a, a_channels, b, b_channels, panels, 0);
}

/* The same where only the lower triangle is wanted, with the rows below it: above the diagonal anything. */
static void outer_lower(float *out, int rows, int columns, int stride, const float *a, int a_channels,
	const float *b, int b_channels, int panels)
{
	outer_any(out, rows, columns, stride, a, a_channels, b, b_channels, panels, 1);
}

/* The lanes of one pass. */
VEC_INLINE vecn channel_sum(const float *row, int panel, int panels, int first)
{
	vecn sum = vec_splat(0);

	for (int p = 0; p < panels; p++, row += panel)
		for (int v = first; v < L; v += PASSES * VEC_LANES)
			sum += vec_load(row + v);
	return sum;
}

/* out (rows) += sums of a's channels over the lanes. */
static void sum_channels(float *out, int rows, const float *a, int channels, int panels)
{
	for (int r = 0; r < rows; r += 4) {
		const int left = rows - r < 4 ? rows - r : 4;
		vecq quad = {0};
		float total[4];
		for (int pass = 0; pass < PASSES; pass++) {
			vecn sum[4];
			for (int i = 0; i < 4; i++)
				sum[i] = i < left ? channel_sum(a + (r + i) * L, channels * L, panels,
							    pass * VEC_LANES)
						  : vec_splat(0);
			const vecq own = sum_lanes_4(sum[0], sum[1], sum[2], sum[3]);
			quad = pass ? quad + own : own;
		}
		store_sums_4(total, quad);
		for (int i = 0; i < left; i++)
			out[r + i] += total[i];
	}
}

/* Zeroes the gradient where the layer's output was not positive. */
static void relu_back(float *d, const float *value, int channels)
{
	for (int i = 0; i < channels * L; i += VEC_LANES)
		vec_store(d + i, vec_keep(vec_lt(vec_splat(0), vec_load(value + i)), vec_load(d + i)));
}
