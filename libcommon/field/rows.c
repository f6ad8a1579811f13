#include "field/rows.h"

#include "base/mem.h"

#include <math.h>

static int start(struct rows *r, size_t n, size_t gaussians, struct err *e)
{
	*r = (struct rows){.gaussians = gaussians, .n = n};
	r->of = mem_alloc(gaussians, sizeof *r->of, "rows", e);
	return r->of ? 0 : -1;
}

int rows_of_ids(struct rows *r, const int32_t *ids, size_t n, size_t gaussians, struct err *e)
{
	if (start(r, n, gaussians, e))
		return -1;
	memset(r->of, 0xff, sizeof *r->of * gaussians);
	for (size_t i = 0; i < n; i++)
		r->of[ids[i]] = (int32_t)i;
	return 0;
}

int rows_of_leaves(struct rows *r, const struct octree *t, const float *means, size_t gaussians,
	const int32_t *ids, size_t n, struct err *e)
{
	size_t next = 0;

	if (start(r, t->n, gaussians, e) || octree_find(t, means, gaussians, r->of, e))
		return -1;
	for (size_t i = 0; ids && i < gaussians; i++)
		if (next < n && (size_t)ids[next] == i)
			next++;
		else
			r->of[i] = -1;
	return 0;
}

void rows_free(struct rows *r)
{
	free(r->of);
	*r = (struct rows){0};
}

int rows_positions(const struct rows *r, const float *means, const double low[3], const double high[3],
	float *position, struct err *e)
{
	SCOPED double(*sum)[4] = mem_zalloc(r->n, sizeof *sum, "positions", e);

	if (!sum)
		return -1;
	for (size_t i = 0; i < r->gaussians; i++) {
		if (r->of[i] < 0)
			continue;
		double *to = sum[r->of[i]];
		for (size_t k = 0; k < 3; k++)
			to[k] += (double)means[3 * i + k];
		to[3]++;
	}
	for (size_t i = 0; i < r->n; i++)
		for (size_t k = 0; k < 3; k++) {
			double x = sum[i][3] > 0 ? sum[i][k] / sum[i][3] : (low[k] + high[k]) / 2;
			x = 2 * (x - low[k]) / (high[k] - low[k]) - 1;
			position[3 * i + k] = (float)fmax(-1, fmin(1, x));
		}
	return 0;
}

void rows_spread(const struct rows *r, const float *from, float *to)
{
	for (size_t i = 0; i < r->gaussians; i++)
		to[i] = r->of[i] < 0 ? 0 : from[r->of[i]];
}

/* Room for as many weights as there can be: one a pixel and Gaussian with a row. */
static int start_view(const struct rows *r, const struct view_weights *from, struct view_weights *to,
	int64_t **indptr, int32_t **index, float **weight, struct err *e)
{
	size_t most = 0;

	for (int64_t k = 0; k < from->indptr[from->pixels]; k++)
		most += r->of[from->index[k]] >= 0;
	*indptr = mem_alloc(from->pixels + 1, sizeof **indptr, "weights", e);
	*index = mem_alloc(most, sizeof **index, "weights", e);
	*weight = mem_alloc(most, sizeof **weight, "weights", e);
	*to = (struct view_weights){from->pixels, r->n, *indptr, *index, *weight};
	return *indptr && *index && *weight ? 0 : -1;
}

int rows_view(const struct rows *r, const struct view_weights *from, struct view_weights *to, struct err *e)
{
	SCOPED int64_t *place = mem_alloc(r->n, sizeof *place, "weights", e);
	int64_t *indptr = NULL, count = 0;
	int32_t *index = NULL;
	float *weight = NULL;

	if (!place || start_view(r, from, to, &indptr, &index, &weight, e)) {
		rows_view_free(to);
		return -1;
	}
	for (size_t i = 0; i < r->n; i++)
		place[i] = -1;
	for (size_t p = 0; p < from->pixels; p++) {
		indptr[p] = count;
		for (int64_t k = from->indptr[p]; k < from->indptr[p + 1]; k++) {
			const int32_t row = r->of[from->index[k]];
			if (row < 0)
				continue;
			if (place[row] >= indptr[p]) {
				weight[place[row]] += from->weight[k];
				continue;
			}
			place[row] = count;
			index[count] = row;
			weight[count++] = from->weight[k];
		}
	}
	indptr[from->pixels] = count;
	/* What merging saved goes back. */
	void *less = realloc(index, sizeof *index * (size_t)(count ? count : 1));
	to->index = less ? less : index;
	less = realloc(weight, sizeof *weight * (size_t)(count ? count : 1));
	to->weight = less ? less : weight;
	return 0;
}

void rows_view_free(struct view_weights *w)
{
	mem_free_all((void *)w->indptr, (void *)w->index, (void *)w->weight);
	*w = (struct view_weights){0};
}
