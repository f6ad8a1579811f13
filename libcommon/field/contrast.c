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

/* The k-th largest key, by two counting passes of 16 bits; *above gets how many are larger. */
static uint32_t select_key(const float *m, size_t n, size_t k, size_t *above)
{
	uint32_t counts[65536], high = 65535, low = 65535;

	*above = 0;
	memset(counts, 0, sizeof counts);
	for (size_t i = 0; i < n; i++)
		counts[order_key(m[i]) >> 16]++;
	for (; *above + counts[high] < k; high--)
		*above += counts[high];
	memset(counts, 0, sizeof counts);
	for (size_t i = 0; i < n; i++) {
		uint32_t key = order_key(m[i]);
		if (key >> 16 == high)
			counts[key & 65535]++;
	}
	for (; *above + counts[low] < k; low--)
		*above += counts[low];
	return high << 16 | low;
}

void contrast_top_set(const float *m, size_t n, size_t k, float *top)
{
	size_t above;
	const uint32_t key = select_key(m, n, k, &above);
	const float share = 1 / (float)k;
	size_t ties = k - above;

	for (size_t i = 0; i < n; i++) {
		uint32_t own = order_key(m[i]);
		int is_in = own > key || (own == key && ties > 0);
		if (own == key && ties > 0)
			ties--;
		top[i] = is_in ? share : 0;
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

double contrast_loss(enum refer_contrast kind, double temperature, const double *fg, const float *e,
	const int *objects, size_t count, int object, double others, double scale, double *dfg, float *de,
	double *score)
{
	double length = 0, largest = -INFINITY, sum = 0, positive = 0;
	size_t positives = 0;

	for (int i = 0; i < D; i++)
		length += fg[i] * fg[i];
	length = kind == REFER_CONTRAST_COSINE ? fmax(sqrt(length), 1e-12) : 1;
	for (size_t r = 0; r < count; r++) {
		double own = kind == REFER_CONTRAST_COSINE ? norm(e + r * D) : 1;
		score[r] = dot(fg, e + r * D) / (length * own * temperature);
		largest = fmax(largest, score[r]);
	}
	for (size_t r = 0; r < count; r++) {
		sum += (objects[r] == object ? 1 : others) * exp(score[r] - largest);
		if (objects[r] == object) {
			positive += score[r];
			positives++;
		}
	}
	const double log_sum = largest + log(sum);
	memset(dfg, 0, sizeof *dfg * D);
	for (size_t r = 0; r < count; r++) {
		const float *row = e + r * D;
		double own = kind == REFER_CONTRAST_COSINE ? norm(row) : 1;
		double p = exp(score[r] - log_sum);
		double d = objects[r] == object ? p - 1 / (double)positives : others * p;
		double along = scale * d / (length * own * temperature), back = scale * d * score[r];
		for (int i = 0; i < D; i++) {
			double df = along * (double)row[i], dr = along * fg[i];
			if (kind == REFER_CONTRAST_COSINE) {
				df -= back * fg[i] / (length * length);
				dr -= back * (double)row[i] / (own * own);
			}
			dfg[i] += df;
			de[r * D + (size_t)i] += (float)dr;
		}
	}
	return log_sum - positive / (double)positives;
}
