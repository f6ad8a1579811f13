#include "lift/query_rules.h"

#include <math.h>
#include <string.h>

void query_unit(float *x, size_t n, size_t channels)
{
	for (size_t i = 0; i < n; i++) {
		float *row = x + i * channels;
		double sum = 0;
		for (size_t c = 0; c < channels; c++)
			sum += (double)row[c] * (double)row[c];
		const double factor = sum > 0 ? 1 / sqrt(sum) : 0;
		for (size_t c = 0; c < channels; c++)
			row[c] = (float)((double)row[c] * factor);
	}
}

/* The best cosine is the rival of all groups but its own, which have the best of the others. */
void query_cosine(const float *cosines, const size_t *group, size_t count, size_t queries, char *selected)
{
	float other = -INFINITY;
	size_t best = 0;

	for (size_t k = 1; k < count; k++)
		best = cosines[k] > cosines[best] ? k : best;
	for (size_t k = 0; k < count; k++)
		if (group[k] != group[best] && cosines[k] > other)
			other = cosines[k];
	for (size_t q = 0; q < queries; q++)
		selected[q] = cosines[q] > (group[q] == group[best] ? other : cosines[best]);
}

double query_relevancy(float cosine, const float *canonical, size_t count)
{
	double most = -INFINITY;

	for (size_t k = 0; k < count; k++)
		most = fmax(most, (double)canonical[k]);
	return 1 / (1 + exp(QUERY_TEMPERATURE * (most - (double)cosine)));
}

double query_relative_threshold(double threshold, double least, double most)
{
	return least + (threshold + 1) / 2 * (most - least);
}

void query_identity(const int32_t *labels, const float *weight, const char *inside, size_t n,
	double threshold, double *sums, size_t label_count, char *selected)
{
	memset(sums, 0, 2 * label_count * sizeof *sums);
	for (size_t i = 0; i < n; i++) {
		if (labels[i] <= 0)
			continue;
		sums[labels[i]] += (double)weight[i];
		sums[label_count + (size_t)labels[i]] += inside[i] ? (double)weight[i] : 0;
	}
	for (size_t i = 0; i < n; i++) {
		const size_t own = labels[i] > 0 ? (size_t)labels[i] : 0;
		selected[i] = own && sums[label_count + own] > threshold * sums[own];
	}
}
