#include "field/image_loss.h"

#include "base/mem.h"
#include "field/panels.h"
#include "mask/bits.h"
#include "nn/loss.h"

enum { PART = 2048 }; /* pixels whose weights stay in cache from blending to blending back */

int image_loss_init(struct image_loss *s, size_t pixels, size_t rows, int most, int threads, struct err *e)
{
	const size_t group = most < VIEW_GROUP ? (size_t)most : VIEW_GROUP;
	const size_t width = most > 1 ? VIEW_GROUP : 1;

	*s = (struct image_loss){.pixels = pixels, .rows = rows, .threads = threads};
	s->image = mem_zalloc(pixels, 2 * group * sizeof(float), "images", e);
	s->slabs = mem_zalloc(rows, (VIEW_SLABS + 2) * width * sizeof(float), "responses", e);
	if (!s->image || !s->slabs)
		return -1;
	s->dimage = s->image + group * pixels;
	s->m = s->slabs + VIEW_SLABS * width * rows;
	s->dm = s->m + width * rows;
	return 0;
}

void image_loss_free(struct image_loss *s)
{
	mem_free_all(s->image, s->slabs);
	*s = (struct image_loss){0};
}

/* Pixels [from,to) of one response's loss, and of dimage. */
static double part_loss(
	struct image_loss *s, size_t pixels, size_t from, size_t to, int k, const uint8_t *mask, double share)
{
	const double of_all = (double)(to - from) / (double)pixels;
	uint8_t wanted[PART];

	bits_expand(mask, from, to, wanted);
	return of_all * loss_bce(s->image + (size_t)k * s->pixels + from, wanted, to - from,
				(float)(share * of_all), s->dimage + (size_t)k * s->pixels + from);
}

/* `count` responses m (rows,VIEW_GROUP), or one (rows) where it is alone; dm alike. */
static double group_loss(struct image_loss *s, const struct view_weights *view, const float *m, int count,
	int is_alone, const uint8_t *const *masks, double share, float *dm)
{
	const size_t pixels = view->pixels, floats = view->gaussians * (is_alone ? 1 : VIEW_GROUP);
	double sums[VIEW_SLABS] = {0}, sum = 0;

#pragma omp parallel for schedule(dynamic) num_threads(s->threads)
	for (size_t slab = 0; slab < VIEW_SLABS; slab++) {
		float *own = s->slabs + slab * floats;
		const size_t begin = pixels * slab / VIEW_SLABS, end = pixels * (slab + 1) / VIEW_SLABS;
		memset(own, 0, sizeof *own * floats);
		for (size_t from = begin; from < end; from += PART) {
			const size_t to = end - from > PART ? from + PART : end;
			if (is_alone)
				view_blend(view, m, from, to, s->image);
			else
				view_blend_group(view, m, count, from, to, s->image, s->pixels);
			for (int k = 0; k < count; k++)
				sums[slab] += part_loss(s, pixels, from, to, k, masks[k], share);
			if (is_alone)
				view_blend_back(view, s->dimage, from, to, own);
			else
				view_blend_back_group(view, s->dimage, s->pixels, count, from, to, own);
		}
	}
	view_join(s->slabs, floats, dm);
	for (size_t slab = 0; slab < VIEW_SLABS; slab++)
		sum += sums[slab];
	return sum;
}

double image_loss_run(struct image_loss *s, const struct view_weights *view, const float *m, int count,
	const uint8_t *const *masks, float *dm)
{
	const size_t rows = view->gaussians;
	double sum = 0;

	if (count == 1) /* a panel of one channel is an array */
		return group_loss(s, view, m, 1, 1, masks, 1, dm);
	for (int first = 0; first < count; first += VIEW_GROUP) {
		const int now = count - first < VIEW_GROUP ? count - first : VIEW_GROUP;
#pragma omp parallel for schedule(static) num_threads(s->threads)
		for (size_t i = 0; i < rows; i++)
			for (int k = 0; k < VIEW_GROUP; k++)
				s->m[i * VIEW_GROUP + (size_t)k] =
					k < now ? m[panels_index(i, count, first + k)] : 0;
		sum += group_loss(s, view, s->m, now, 0, masks + first, 1 / (double)count, s->dm);
#pragma omp parallel for schedule(static) num_threads(s->threads)
		for (size_t i = 0; i < rows; i++)
			for (int k = 0; k < now; k++)
				dm[panels_index(i, count, first + k)] = s->dm[i * VIEW_GROUP + (size_t)k];
	}
	return sum / count;
}
