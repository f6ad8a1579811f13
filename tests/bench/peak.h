/* The processor's peak rate of float32 multiply-adds, measured: independent chains of them, as wide as it has
 * them. */
#ifndef BENCH_PEAK_H
#define BENCH_PEAK_H

#include <time.h>
#if defined __x86_64__
#include <immintrin.h>
#endif

static inline double clock_seconds(clockid_t clock)
{
	struct timespec t;

	clock_gettime(clock, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Each function returns how many multiply-adds it did. */
enum { CHAINS = 12, ROUNDS = 1000000 };

#if defined __x86_64__
__attribute__((target("avx512f"))) static double chains_avx512(void)
{
	__m512 sums[CHAINS], x = _mm512_set1_ps(0.5f);

	for (int c = 0; c < CHAINS; c++)
		sums[c] = _mm512_set1_ps((float)c);
	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = _mm512_fmadd_ps(sums[c], x, x);
	for (int c = 1; c < CHAINS; c++)
		sums[0] = _mm512_add_ps(sums[0], sums[c]);
	volatile float sink = _mm512_cvtss_f32(sums[0]);
	(void)sink;
	return 16.0 * CHAINS * ROUNDS;
}

__attribute__((target("avx2,fma"))) static double chains_avx2(void)
{
	__m256 sums[CHAINS], x = _mm256_set1_ps(0.5f);

	for (int c = 0; c < CHAINS; c++)
		sums[c] = _mm256_set1_ps((float)c);
	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = _mm256_fmadd_ps(sums[c], x, x);
	for (int c = 1; c < CHAINS; c++)
		sums[0] = _mm256_add_ps(sums[0], sums[c]);
	volatile float sink = _mm256_cvtss_f32(sums[0]);
	(void)sink;
	return 8.0 * CHAINS * ROUNDS;
}
#endif

static double chains_plain(void)
{
	float __attribute__((vector_size(16))) sums[CHAINS] = {{0}}, x = {0.5f, 0.5f, 0.5f, 0.5f};

	for (long i = 0; i < ROUNDS; i++)
		for (int c = 0; c < CHAINS; c++)
			sums[c] = sums[c] * x + x;
	for (int c = 1; c < CHAINS; c++)
		sums[0] += sums[c];
	volatile float sink = sums[0][0];
	(void)sink;
	return 4.0 * CHAINS * ROUNDS;
}

/* Multiply-adds a second of one thread; the best of five, in the thread's own time. */
static double measure_peak(void)
{
	double (*chains)(void) = chains_plain;
	double best = 0;

#if defined __x86_64__
	if (__builtin_cpu_supports("avx512f"))
		chains = chains_avx512;
	else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
		chains = chains_avx2;
#endif
	for (int i = 0; i < 5; i++) {
		const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID), done = chains();
		const double rate = done / (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
		best = rate > best ? rate : best;
	}
	return best;
}

#endif
