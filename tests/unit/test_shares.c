/* What masks show of each Gaussian: against the sum by its definition, for masks of all kinds, from rows of
 * pixels and from tiles. */
#include "unit.h"

#include "base/rng.h"
#include "lift/seen.h"
#include "lift/shares.h"
#include "mask/bits.h"
#include "pack_whole.h"

#include <omp.h>

enum { H = 11, W = 18, P = H * W, TILES = 6, N = 140, PER_PIXEL = 6, MASKS = 12, IMAGES = 9 };

struct view {
	int64_t indptr[P + 1];
	int32_t index[P * PER_PIXEL];
	float weight[P * PER_PIXEL];
};

/* Some pixels have no weights, some Gaussians none; a weight may be 0. */
static struct view_matrix make_view(struct view *v, struct rng *r)
{
	int64_t n = 0;

	for (int p = 0; p < P; p++) {
		v->indptr[p] = n;
		for (uint32_t left = rng_below(r, PER_PIXEL + 1); left; left--, n++) {
			/* near pixels see the same Gaussians */
			v->index[n] = (int32_t)(((uint32_t)(p % W) * 5 + rng_below(r, 30)) % (N - 9));
			v->weight[n] = rng_below(r, 5) ? (float)rng_uniform(r) : 0;
		}
	}
	v->indptr[P] = n;
	return (struct view_matrix){H, W, N, {P, N, v->indptr, v->index, v->weight}, NULL};
}

static void check_row(const struct view_weights *w, const double *image, const struct shares *row)
{
	double sums[N] = {0};
	size_t n = 0;

	for (size_t p = 0; p < P; p++)
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++)
			sums[w->index[k]] += (double)w->weight[k] * image[p];
	for (int i = 0; i < N; i++) {
		if (!(sums[i] > 0))
			continue;
		if (!CHECK(n < row->n && row->index[n] == i, "Gaussian %d is not in place %zu of %zu", i, n,
			    row->n))
			return;
		CHECK(fabs((double)row->share[n] - sums[i]) < 1e-5, "Gaussian %d has %g, expected %g", i,
			(double)row->share[n], sums[i]);
		n++;
	}
	CHECK(n == row->n, "%zu Gaussians, expected %zu", row->n, n);
}

/* A view's weights that are kept where they are above 0 are all of them. */
static void test_seen(const struct view_weights *w, const float *weight)
{
	double sum[N] = {0}, expected[N] = {0};
	struct seen seen, none = {0};
	struct err e;
	int unseen = 0;

	for (int64_t k = 0; k < w->indptr[P]; k++)
		expected[w->index[k]] += (double)w->weight[k];
	CHECK(!seen_make(&seen, weight, N, &e), "%s", e.message);
	seen_add(&none, N, sum);
	seen_add(&seen, N, sum);
	for (size_t i = 0; i < N; i++) {
		CHECK(seen_weight(&seen, i) == weight[i] && (float)sum[i] == weight[i] &&
				fabs(sum[i] - expected[i]) < 1e-5,
			"Gaussian %zu has %g, in the sum %g, expected %g", i, (double)seen_weight(&seen, i),
			sum[i], expected[i]);
		unseen += weight[i] == 0;
	}
	CHECK(unseen >= 9 && unseen < N / 2, "%d are not seen", unseen);
	seen_free(&seen);
}

/* Masks 0 to MASKS - 1: one empty, one full, one of whole tiles, the others ragged. */
static uint8_t pixels[MASKS][P];
static uint64_t bits[MASKS][TILES];

static void make_masks(struct rng *r)
{
	for (uint32_t k = 1; k < MASKS; k++)
		for (int p = 0; p < P; p++)
			pixels[k][p] = k == 1	? 1
				       : k == 2 ? p / W / 8 == 0 && p % W / 8 == 1
						: !rng_below(r, k);
	for (int k = 0; k < MASKS; k++)
		bits_pack_tiles(pixels[k], H, W, bits[k]);
}

/* Image k is mask k alone, but for the last, which is the mean of the masks left. */
static struct shares_masks masks_of(int image)
{
	return (struct shares_masks){bits[image], image < IMAGES - 1 ? 1 : MASKS - IMAGES + 1};
}

static void fill_image(int image, double mean[P])
{
	const size_t n = masks_of(image).count;

	for (int p = 0; p < P; p++) {
		mean[p] = 0;
		for (size_t k = 0; k < n; k++)
			mean[p] += pixels[(size_t)image + k][p];
		mean[p] /= (double)n;
	}
}

/* rows: what the matrix says, as rows of pixels. */
static void test_matrix(const struct view_matrix *w, const struct view_weights *rows)
{
	struct shares_masks masks[IMAGES];
	struct shares got[IMAGES], again[IMAGES];
	float weight[N], same[N];
	struct err e;

	for (int k = 0; k < IMAGES; k++)
		masks[k] = masks_of(k);
	omp_set_num_threads(1);
	CHECK(!shares_make(weight, got, w, masks, IMAGES, &e), "%s", e.message);
	omp_set_num_threads(7);
	CHECK(!shares_make(same, again, w, masks, IMAGES, &e), "%s", e.message);
	CHECK(!memcmp(weight, same, sizeof weight), "threads differ in the view's weight");
	for (int k = 0; k < IMAGES; k++) {
		double image[P];
		fill_image(k, image);
		check_row(rows, image, &got[k]);
		CHECK(got[k].n == again[k].n &&
				!memcmp(got[k].index, again[k].index, got[k].n * sizeof *got[k].index),
			"image %d: threads differ", k);
		for (size_t i = 0; i < got[k].n; i++)
			CHECK(got[k].share[i] == again[k].share[i], "image %d: threads differ", k);
		shares_free(&got[k]);
		shares_free(&again[k]);
	}
	CHECK(!shares_make(weight, got, w, masks, 0, &e), "no mask");
	test_seen(rows, weight);
}

int main(void)
{
	static struct view v;
	struct weights_room room = {0};
	struct weights_pack pack;
	struct rng r;
	struct err e;

	rng_seed(&r, 11, 1);
	const struct view_matrix w = make_view(&v, &r);
	make_masks(&r);
	test_matrix(&w, &w.rows);
	CHECK(!pack_whole(&pack, W, H, N, v.indptr, v.index, v.weight, &e) &&
			!weights_unpack(&pack, W, H, N, "w", &room, &e),
		"%s", e.message);
	const struct view_weights rows = {P, N, room.indptr, room.index, room.weight};
	const struct view_matrix tiles = {H, W, N, {P, N, NULL, NULL, NULL}, &room.tiles};
	test_matrix(&tiles, &rows);
	weights_pack_free(&pack);
	weights_room_free(&room);
	return unit_end();
}
