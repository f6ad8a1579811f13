/* The layer's products as sums of products of parts: a half float is exactly two numbers of eight bits
 * (bfloat16), a float three, and Intel's AMX adds products of such numbers in tiles of 16 x 16 sums. */
#include "nn/linear_amx.h"

#include "base/cpu.h"

#if defined __x86_64__ && defined __linux__ && (defined __clang__ || __GNUC__ >= 12)
#include <immintrin.h>
#include <stdint.h>
#include <string.h>

#define AMX __attribute__((target("amx-tile,amx-bf16,avx512f,avx512bw,avx512dq,avx512vl")))
#define AMX_INLINE __attribute__((always_inline)) AMX static inline

enum {
	SIDE = 16,	 /* of a tile: outputs by rows of the input */
	DEPTH = 32,	 /* terms of a tile */
	PAIR = 2 * SIDE, /* outputs, and rows of the input, that one loop makes */
	INPUTS = 3,	 /* parts of an input, and of a weight */
	WEIGHTS = 2,
	ROWS = 128,
	TERMS = 384, /* that are packed at a time */
	OUTPUTS = 768
};

/* 16 outputs by 32 terms, or 16 pairs of terms by 16 rows of the input. */
typedef uint16_t tile[SIDE * DEPTH];

/* What AMX reads of its tiles: all are whole. */
struct tile_config {
	uint8_t palette, start, zero[14];
	uint16_t bytes[16];
	uint8_t rows[16];
};

/* The next eight bits of 32 floats as bfloat16; the rest stays in the floats. */
AMX_INLINE __m512i take_part(__m512 x[2])
{
	static const uint16_t odd[] = {1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 37,
		39, 41, 43, 45, 47, 49, 51, 53, 55, 57, 59, 61, 63};
	const __m512i part = _mm512_permutex2var_epi16(
		_mm512_castps_si512(x[0]), _mm512_loadu_si512(odd), _mm512_castps_si512(x[1]));

	for (int i = 0; i < 2; i++)
		x[i] = _mm512_sub_ps(
			x[i], _mm512_and_ps(x[i], _mm512_castsi512_ps(_mm512_set1_epi32(-65536))));
	return part;
}

/* 16 rows of 16 numbers of 32 bits to their columns. */
AMX_INLINE void turn(__m512i x[SIDE])
{
	__m512i y[SIDE];

#pragma GCC unroll 8
	for (int i = 0; i < SIDE; i += 2) {
		y[i] = _mm512_unpacklo_epi32(x[i], x[i + 1]);
		y[i + 1] = _mm512_unpackhi_epi32(x[i], x[i + 1]);
	}
#pragma GCC unroll 8
	for (int i = 0; i < SIDE; i += 2) {
		const int from = i / 4 * 4 + i % 4 / 2;
		x[i] = _mm512_unpacklo_epi64(y[from], y[from + 2]);
		x[i + 1] = _mm512_unpackhi_epi64(y[from], y[from + 2]);
	}
#pragma GCC unroll 8
	for (int i = 0; i < 8; i++) {
		const int from = i / 4 * 8 + i % 4;
		y[from] = _mm512_shuffle_i32x4(x[from], x[from + 4], 0x88);
		y[from + 4] = _mm512_shuffle_i32x4(x[from], x[from + 4], 0xdd);
	}
#pragma GCC unroll 8
	for (int i = 0; i < 8; i++) {
		x[i] = _mm512_shuffle_i32x4(y[i], y[i + 8], 0x88);
		x[i + 8] = _mm512_shuffle_i32x4(y[i], y[i + 8], 0xdd);
	}
}

/* The input's rows, in blocks of 16 the steps' parts. Rows that are not there are zero. */
AMX static void take_input(tile *to, const float *in, size_t width, size_t rows, size_t steps)
{
	for (size_t j = 0; j < rows; j += SIDE)
		for (size_t s = 0; s < steps; s++, to += INPUTS) {
			__m512i part[INPUTS][SIDE] = {{{0}}};
			for (size_t i = 0; i < SIDE && j + i < rows; i++) {
				const float *row = in + (j + i) * width + s * DEPTH;
				__m512 x[] = {_mm512_loadu_ps(row), _mm512_loadu_ps(row + 16)};
				for (int k = 0; k < INPUTS; k++)
					part[k][i] = take_part(x);
			}
			for (int k = 0; k < INPUTS; k++) {
				turn(part[k]);
				memcpy(to[k], part[k], sizeof to[k]);
			}
		}
}

/* The two parts of 32 halves, of which none is 0, below the normal ones, or infinite: 0 where one is. By
 * integers, with half as many instructions as by floats: the first part is the half with the other exponent
 * and three bits fewer; the second one those bits, as a number of 0 to 7, with the half's sign and exponent.
 */
AMX_INLINE int split_halves(__m512i h, __m512i part[WEIGHTS])
{
	/* those numbers as bfloat16, 25 exponents lower: the bits weigh 2^-25 of the half's power; by the
	 * five lowest bits of the half */
	static const uint16_t rest[] = {0, 0x3300, 0x3380, 0x33c0, 0x3400, 0x3420, 0x3440, 0x3460};
	const __m512i sign = _mm512_set1_epi16((short)0x8000), power = _mm512_set1_epi16(0x7c00);
	const __m512i table = _mm512_broadcast_i32x4(_mm_loadu_si128((const void *)rest));
	const __m512i exponent = _mm512_and_si512(h, power);

	if (_mm512_cmple_epu16_mask(_mm512_sub_epi16(exponent, _mm512_set1_epi16(0x400)),
		    _mm512_set1_epi16(0x7400)) != UINT32_MAX)
		return 0;
	const __m512i size = _mm512_srli_epi16(_mm512_andnot_si512(sign, h), 3);
	const __mmask32 is = _mm512_test_epi16_mask(h, _mm512_set1_epi16(7));
	const __m512i low = _mm512_maskz_add_epi16(
		is, _mm512_permutexvar_epi16(h, table), _mm512_srli_epi16(exponent, 3));

	/* a or (b and sign) */
	part[0] =
		_mm512_ternarylogic_epi64(_mm512_add_epi16(size, _mm512_set1_epi16(112 << 7)), h, sign, 0xf8);
	part[1] = _mm512_ternarylogic_epi64(low, _mm512_maskz_mov_epi16(is, h), sign, 0xf8);
	return 1;
}

/* The weights of 32 outputs: of both blocks of 16 all steps' first parts, then their second ones. */
AMX static void take_weights(tile *to, const char *halves, size_t width, size_t steps)
{
	for (size_t i = 0; i < PAIR; i++)
		for (size_t s = 0; s < steps; s++) {
			const char *from = halves + 2 * (i * width + s * DEPTH);
			tile *step = to + i / SIDE * WEIGHTS * steps + s;
			__m512i part[WEIGHTS];
			if (!split_halves(_mm512_loadu_si512(from), part)) {
				__m512 x[] = {_mm512_cvtph_ps(_mm256_loadu_si256((const void *)from)),
					_mm512_cvtph_ps(_mm256_loadu_si256((const void *)(from + 32)))};
				part[0] = take_part(x);
				part[1] = take_part(x);
			}
			for (size_t k = 0; k < WEIGHTS; k++)
				_mm512_store_si512(step[k * steps] + i % SIDE * DEPTH, part[k]);
			__builtin_prefetch(from + 2 * PAIR * width);
		}
}

/* sum (32,ROWS) += weights input, of 32 rows of the input: the small products first, and of the smallest,
 * beside which a float's last bit is as large, none. */
AMX static void multiply_pair(float *sum, const tile *w, const tile *x, size_t steps)
{
	const tile *y = x + steps * INPUTS, *v = w + steps * WEIGHTS;
	float *const below = sum + SIDE * ROWS;

	_tile_loadd(0, sum, sizeof *sum * ROWS);
	_tile_loadd(1, sum + SIDE, sizeof *sum * ROWS);
	_tile_loadd(2, below, sizeof *sum * ROWS);
	_tile_loadd(3, below + SIDE, sizeof *sum * ROWS);
	for (size_t s = 0; s < steps; s++, w++, v++, x += INPUTS, y += INPUTS) {
#define LOAD_WEIGHTS(k)                                                                                      \
	_tile_loadd(4, w[(k)*steps], 64);                                                                    \
	_tile_loadd(5, v[(k)*steps], 64)
#define MULTIPLY(k)                                                                                          \
	_tile_loadd(6, x[k], 64);                                                                            \
	_tile_loadd(7, y[k], 64);                                                                            \
	_tile_dpbf16ps(0, 4, 6);                                                                             \
	_tile_dpbf16ps(1, 4, 7);                                                                             \
	_tile_dpbf16ps(2, 5, 6);                                                                             \
	_tile_dpbf16ps(3, 5, 7)
		LOAD_WEIGHTS(1);
		MULTIPLY(1);
		MULTIPLY(0);
		LOAD_WEIGHTS(0);
		MULTIPLY(2);
		MULTIPLY(1);
		MULTIPLY(0);
	}
	_tile_stored(0, sum, sizeof *sum * ROWS);
	_tile_stored(1, sum + SIDE, sizeof *sum * ROWS);
	_tile_stored(2, below, sizeof *sum * ROWS);
	_tile_stored(3, below + SIDE, sizeof *sum * ROWS);
}

/* The same of 16 rows, each sum in the same order. */
AMX static void multiply_last(float *sum, const tile *w, const tile *x, size_t steps)
{
	const tile *v = w + steps * WEIGHTS;

	_tile_loadd(0, sum, sizeof *sum * ROWS);
	_tile_loadd(2, sum + SIDE * ROWS, sizeof *sum * ROWS);
	for (size_t s = 0; s < steps; s++, w++, v++, x += INPUTS) {
#define MULTIPLY_LAST(k)                                                                                     \
	_tile_loadd(6, x[k], 64);                                                                            \
	_tile_dpbf16ps(0, 4, 6);                                                                             \
	_tile_dpbf16ps(2, 5, 6)
		LOAD_WEIGHTS(1);
		MULTIPLY_LAST(1);
		MULTIPLY_LAST(0);
		LOAD_WEIGHTS(0);
		MULTIPLY_LAST(2);
		MULTIPLY_LAST(1);
		MULTIPLY_LAST(0);
	}
	_tile_stored(0, sum, sizeof *sum * ROWS);
	_tile_stored(2, sum + SIDE * ROWS, sizeof *sum * ROWS);
}

/* out (rows,outputs) of the layer from sums (outputs,ROWS). */
AMX static void keep(const struct linear_layer *l, const float *sums, size_t row, size_t rows, size_t output,
	size_t outputs)
{
	for (size_t j = 0; j < rows; j += SIDE)
		for (size_t i = 0; i < outputs; i += SIDE) {
			__m512i x[SIDE];
			for (size_t k = 0; k < SIDE; k++)
				x[k] = _mm512_loadu_si512(sums + (i + k) * ROWS + j);
			turn(x);
			for (size_t k = 0; k < SIDE && j + k < rows; k++)
				_mm512_storeu_si512(l->out + (row + j + k) * l->out_width + output + i, x[k]);
		}
}

AMX static void run(const struct linear_layer *l, size_t row, size_t rows, size_t output, size_t outputs)
{
	_Alignas(64) tile x[ROWS / SIDE * (TERMS / DEPTH) * INPUTS], w[TERMS / DEPTH * 2 * WEIGHTS];
	_Alignas(64) float sums[OUTPUTS * ROWS];
	struct tile_config config = {.palette = 1};

	for (int i = 0; i < 8; i++) {
		config.bytes[i] = 64;
		config.rows[i] = SIDE;
	}
	_tile_loadconfig(&config);
	for (size_t i = 0; i < outputs; i++)
		for (size_t j = 0; j < ROWS; j++)
			sums[i * ROWS + j] = l->bias ? l->bias[output + i] : 0;
	for (size_t first = 0; first < l->in_width; first += TERMS) {
		const size_t left = l->in_width - first, steps = (left < TERMS ? left : TERMS) / DEPTH;
		take_input(x, l->in + row * l->in_width + first, l->in_width, rows, steps);
		for (size_t i = 0; i < outputs; i += PAIR) {
			take_weights(w,
				(const char *)l->weight.halves + 2 * ((output + i) * l->in_width + first),
				l->in_width, steps);
			for (size_t j = 0; j < rows; j += PAIR)
				(rows - j > SIDE ? multiply_pair : multiply_last)(
					sums + i * ROWS + j, w, x + j / SIDE * steps * INPUTS, steps);
		}
	}
	_tile_release();
	keep(l, sums, row, rows, output, outputs);
}

int linear_amx_fits(const struct linear_layer *l)
{
	return l->weight.halves && l->rows && !(l->in_width % DEPTH) && !(l->out_width % PAIR) &&
	       cpu_has_amx();
}

void linear_amx_run(const struct linear_layer *l, size_t parts)
{
	size_t outputs = OUTPUTS;

	while (outputs % (2 * PAIR) == 0 && (l->rows + ROWS - 1) / ROWS * (l->out_width / outputs) < parts)
		outputs /= 2;
#pragma omp parallel for collapse(2) schedule(dynamic)
	for (size_t j = 0; j < l->rows; j += ROWS)
		for (size_t i = 0; i < l->out_width; i += outputs)
			run(l, j, l->rows - j < ROWS ? l->rows - j : ROWS, i,
				l->out_width - i < outputs ? l->out_width - i : outputs);
}
#else
int linear_amx_fits(const struct linear_layer *l)
{
	(void)l;
	return 0;
}

void linear_amx_run(const struct linear_layer *l, size_t parts)
{
	(void)l, (void)parts;
}
#endif
