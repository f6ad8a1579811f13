#include "lift/shares.h"

#include "base/mem.h"
#include "lift/marks.h"
#include "splat/backproject.h"

#include <stdlib.h>

/* One thread's: sums of all Gaussians, and which of them are above 0. All 0 between images. */
struct sums {
	float *sum; /* (N) */
	uint64_t *marks;
};

/* Pixels in their order. Returns how many sums are above 0. */
static size_t add_image(struct sums *s, const struct view_weights *w, const float *image)
{
	size_t n = 0;

	for (size_t p = 0; p < w->pixels; p++) {
		if (!(image[p] > 0))
			continue;
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
			const size_t i = (size_t)w->index[k];
			const float before = s->sum[i];
			s->sum[i] += w->weight[k] * image[p];
			if (before > 0 || !(s->sum[i] > 0))
				continue;
			marks_add(s->marks, i);
			n++;
		}
	}
	return n;
}

/* Moves the sums into a row, in the order of the Gaussians. */
static void take(struct sums *s, size_t gaussians, struct shares *row)
{
	row->n = marks_take(s->marks, gaussians, row->index);
	for (size_t k = 0; k < row->n; k++) {
		row->share[k] = s->sum[row->index[k]];
		s->sum[row->index[k]] = 0;
	}
}

static int make_row(
	struct shares *row, struct sums *s, const struct view_weights *w, const float *image, struct err *e)
{
	const size_t n = add_image(s, w, image);

	*row = (struct shares){.index = mem_alloc(n, sizeof *row->index, "masks", e),
		.share = mem_alloc(n, sizeof *row->share, "masks", e)};
	if (!row->index || !row->share)
		return -1;
	take(s, w->gaussians, row);
	return 0;
}

int shares_make(
	struct shares *rows, const struct view_weights *w, const float *images, size_t count, struct err *e)
{
	int failed = 0;

	for (size_t k = 0; k < count; k++)
		rows[k] = (struct shares){0};
#pragma omp parallel reduction(| : failed) if (count > 1)
	{
		struct err mine;
		struct sums s = {mem_zalloc(w->gaussians, sizeof *s.sum, "masks", &mine),
			marks_make(w->gaussians, &mine)};
		failed = !s.sum || !s.marks;
#pragma omp for schedule(dynamic)
		for (size_t k = 0; k < count; k++)
			failed = failed || make_row(&rows[k], &s, w, images + k * w->pixels, &mine);
		if (failed) {
#pragma omp critical
			*e = mine;
		}
		free(s.sum);
		free(s.marks);
	}
	for (size_t k = 0; k < count && failed; k++)
		shares_free(&rows[k]);
	return failed ? -1 : 0;
}

void shares_free(struct shares *row)
{
	free(row->index);
	free(row->share);
	*row = (struct shares){0};
}

int shares_of_view(float *weight, const struct view_weights *w, struct err *e)
{
	double *sum = mem_zalloc(w->gaussians, sizeof *sum, "masks", e);

	if (!sum)
		return -1;
	backproject_weight(w, sum);
	for (size_t i = 0; i < w->gaussians; i++)
		weight[i] = (float)sum[i];
	free(sum);
	return 0;
}
