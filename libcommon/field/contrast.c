#include "field/contrast.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { D = REFER_D };

size_t contrast_top_count(long iteration, size_t n)
{
	double tau = fmax(0.005, 0.1 * pow(0.6, (double)iteration / 1000));
	size_t k = (size_t)(tau * (double)n);

	return k ? k : 1;
}

/* Rises with the value; NaN above all. */
static uint32_t order_key(float x)
{
	uint32_t bits;

	memcpy(&bits, &x, 4);
	return bits & 0x80000000 ? ~bits : bits | 0x80000000;
}

static uint32_t times_of(const uint32_t *times, size_t i)
{
	return times ? times[i] : 1;
}

/* The key of the k-th largest, by two counting passes of 16 bits; *above gets how many are larger. */
static uint32_t select_key(const float *m, const uint32_t *times, size_t n, size_t k, size_t *above)
{
	uint32_t counts[65536], high = 65535, low = 65535;

	*above = 0;
	memset(counts, 0, sizeof counts);
	for (size_t i = 0; i < n; i++)
		counts[order_key(m[i]) >> 16] += times_of(times, i);
	for (; *above + counts[high] < k; high--)
		*above += counts[high];
	memset(counts, 0, sizeof counts);
	for (size_t i = 0; i < n; i++) {
		uint32_t key = order_key(m[i]);
		if (key >> 16 == high)
			counts[key & 65535] += times_of(times, i);
	}
	for (; *above + counts[low] < k; low--)
		*above += counts[low];
	return high << 16 | low;
}

void contrast_top_set(const float *m, const uint32_t *times, size_t n, size_t k, float *top)
{
	size_t above;
	const uint32_t key = select_key(m, times, n, k, &above);
	size_t ties = k - above;

	for (size_t i = 0; i < n; i++) {
		const uint32_t own = order_key(m[i]), all = own < key ? 0 : times_of(times, i);
		const size_t in = own == key && all > ties ? ties : all;
		if (own == key)
			ties -= in;
		top[i] = (float)in / (float)k;
	}
}

static double dot(const double *x, const float *y)
{
	double sum = 0;

	for (int i = 0; i < D; i++)
		sum += x[i] * (double)y[i];
	return sum;
}

static double norm(const float *x)
{
	double sum = 0;

	for (int i = 0; i < D; i++)
		sum += (double)x[i] * (double)x[i];
	return fmax(sqrt(sum), 1e-12);
}

/* The sentences of a contrast, with scores. */
struct scored {
	const double *score;
	const int *objects;
	size_t count;
	int object;
};

/* log sum times exp(sign s) over the sentences of the object, or of the others. */
static double log_sum(const struct scored *of, int is_own, double sign, double times)
{
	double largest = -INFINITY, sum = 0;

	for (size_t r = 0; r < of->count; r++)
		if ((of->objects[r] == of->object) == is_own)
			largest = fmax(largest, sign * of->score[r]);
	for (size_t r = 0; r < of->count; r++)
		if ((of->objects[r] == of->object) == is_own)
			sum += exp(sign * of->score[r] - largest);
	return sum > 0 ? largest + log(times * sum) : -INFINITY;
}

/* The mean of -log softmax over the positives. */
static double softmax_slopes(const struct scored *of, const double times[2], double *slope)
{
	const double others = log_sum(of, 0, 1, times[0]), own = log_sum(of, 1, 1, times[1]),
		     all = fmax(others, own) + log1p(exp(-fabs(others - own)));
	double positive = 0, positives = 0;

	for (size_t r = 0; r < of->count; r++)
		if (of->objects[r] == of->object) {
			positive += of->score[r];
			positives++;
		}
	for (size_t r = 0; r < of->count; r++) {
		const int is_own = of->objects[r] == of->object;
		slope[r] = times[is_own] * exp(of->score[r] - all) - (is_own ? 1 / positives : 0);
	}
	return all - positive / positives;
}

/* log(1 + sum over pairs of a negative and a positive of exp(s- - s+)). */
static double pair_slopes(const struct scored *of, const double times[2], double *slope)
{
	const double others = log_sum(of, 0, 1, times[0]), own = log_sum(of, 1, -1, times[1]),
		     z = others + own, share = 1 / (1 + exp(-z));

	for (size_t r = 0; r < of->count; r++)
		slope[r] = of->objects[r] != of->object ? share * times[0] * exp(of->score[r] - others)
							: -share * times[1] * exp(-of->score[r] - own);
	return fmax(z, 0) + log1p(exp(-fabs(z)));
}

double contrast_loss(enum refer_contrast kind, double temperature, const double *fg, const float *e,
	const int *objects, size_t count, int object, const double times[2], double scale, double *dfg,
	float *de, double *score)
{
	const int is_cosine = kind != REFER_CONTRAST_DOT;
	const struct scored of = {score, objects, count, object};
	double *slope = score + count, length = 0;

	for (int i = 0; i < D; i++)
		length += fg[i] * fg[i];
	length = is_cosine ? fmax(sqrt(length), 1e-12) : 1;
	for (size_t r = 0; r < count; r++)
		score[r] = dot(fg, e + r * D) / (length * (is_cosine ? norm(e + r * D) : 1) * temperature);
	const double loss = (kind == REFER_CONTRAST_PAIRS ? pair_slopes : softmax_slopes)(&of, times, slope);
	memset(dfg, 0, sizeof *dfg * D);
	for (size_t r = 0; r < count; r++) {
		const float *row = e + r * D;
		const double own = is_cosine ? norm(row) : 1,
			     along = scale * slope[r] / (length * own * temperature),
			     back = scale * slope[r] * score[r];
		for (int i = 0; i < D; i++) {
			double df = along * (double)row[i], dr = along * fg[i];
			if (is_cosine) {
				df -= back * fg[i] / (length * length);
				dr -= back * (double)row[i] / (own * own);
			}
			dfg[i] += df;
			de[r * D + (size_t)i] += (float)dr;
		}
	}
	return loss;
}
