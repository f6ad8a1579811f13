#include "lift/regions_private.h"

#include "base/mem.h"
#include "mask/bits.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = 16 }; /* masks that are images at a time */
/* Intersection over union from which masks of a view are one candidate. Of 0.9, 0.95 and every mask by
 * itself, the mIoU of the masks that come of it in training views, mean of the eight scenes of
 * pipelines/ablation.md: 66.5, 66.7, 66.8. */
#define ALIKE 0.95

/* Masks of one view as bits at its size. */
struct shapes {
	size_t n, bytes;
	uint8_t *bits; /* (n,bytes) */
	size_t *area;  /* (n) */
};

static void shapes_free(struct shapes *s)
{
	free(s->bits);
	free(s->area);
}

static int fill_shape(
	struct shapes *s, size_t k, const struct rle *mask, int height, int width, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	uint8_t *mine = mem_alloc(pixels, 1, "masks", e), *bits = s->bits + k * s->bytes;
	int bad = !mine || rle_decode_at(mask, height, width, mine, e);

	if (!bad) {
		bits_pack(mine, pixels, bits);
		s->area[k] = bits_common(bits, bits, s->bytes);
	}
	free(mine);
	return bad;
}

static int shapes_make(
	struct shapes *s, const struct regions_witness *w, size_t n, int height, int width, struct err *e)
{
	int failed = 0;

	*s = (struct shapes){.n = n, .bytes = bits_bytes((size_t)height * (size_t)width)};
	s->bits = mem_alloc(n, s->bytes, "masks", e);
	s->area = mem_alloc(n, sizeof *s->area, "masks", e);
	if (!s->bits || !s->area)
		return -1;
#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t k = 0; k < n; k++) {
		struct err mine;
		if (fill_shape(s, k, &w[k].mask->rle, height, width, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

/* Intersection over union; two empty ones agree. */
static double agreement(const struct shapes *s, size_t a, size_t b)
{
	const size_t all = s->area[a] + s->area[b];
	const size_t both = bits_common(s->bits + a * s->bytes, s->bits + b * s->bytes, s->bytes);

	return all ? (double)both / (double)(all - both) : 1;
}

static int is_alike(const struct shapes *s, size_t a, size_t b)
{
	const size_t x = s->area[a], y = s->area[b];

	return (double)(x < y ? x : y) >= ALIKE * (double)(x < y ? y : x) && agreement(s, a, b) >= ALIKE;
}

/* Gives each mask of a view its candidate: that of the first mask like it. Returns how many there are. */
static size_t group(struct regions_witness *w, const struct shapes *s, size_t first, size_t *from)
{
	size_t n = 0;

	for (size_t k = 0; k < s->n; k++) {
		size_t c = 0;
		while (c < n && !is_alike(s, from[c], k))
			c++;
		w[k].candidate = first + c;
		if (c == n)
			from[n++] = k;
	}
	return n;
}

/* The mask of a candidate: of those that it stands for, the one that the others agree with best, by their
 * confidence. from[] has the first of each. */
static void choose_masks(
	const struct regions_witness *w, const struct shapes *s, size_t first, size_t n, size_t *from)
{
#pragma omp parallel for schedule(dynamic)
	for (size_t c = 0; c < n; c++) {
		double most = 0;
		for (size_t k = from[c], begin = k; k < s->n; k++) {
			double sum = 0;
			for (size_t i = begin; i < s->n && w[k].candidate == first + c; i++)
				if (i != k && w[i].candidate == first + c)
					sum += mask_confidence(w[i].mask) * agreement(s, k, i);
			if (sum > most) {
				most = sum;
				from[c] = k;
			}
		}
	}
}

/* The view's candidates begin in the place of its first witness. Returns how many there are. */
static size_t add_candidates(
	struct regions *r, size_t first, struct regions_witness *w, const struct shapes *s, size_t *from)
{
	const size_t n = group(w, s, first, from);

	choose_masks(w, s, first, n, from);
	for (size_t c = 0; c < n; c++)
		r->candidates[first + c] =
			(struct regions_candidate){.mask = w[from[c]].mask, .view = w[from[c]].view};
	return n;
}

/* The shares of `now` candidates. */
static int lift(struct regions_candidate *c, size_t now, const struct view_weights *w, const struct shapes *s,
	const size_t *from, float *image, struct err *e)
{
	struct shares rows[BATCH];

	memset(image, 0, now * w->pixels * sizeof *image);
#pragma omp parallel for schedule(dynamic)
	for (size_t k = 0; k < now; k++)
		bits_place(s->bits + from[k] * s->bytes, w->pixels, image + k * w->pixels);
	if (shares_make(rows, w, image, now, e))
		return -1;
	for (size_t k = 0; k < now; k++) {
		c[k].shares = rows[k];
		for (size_t i = 0; i < rows[k].n; i++)
			c[k].mass += (double)rows[k].share[i];
	}
	return 0;
}

static int lift_masks(struct regions *r, const struct view_weights *w, const struct shapes *s, size_t first,
	size_t *n, struct err *e)
{
	size_t *from = mem_alloc(s->n, sizeof *from, "masks", e);
	float *image = mem_alloc(w->pixels, BATCH * sizeof *image, "masks", e);
	int bad = !from || !image;

	*n = bad ? 0 : add_candidates(r, first, r->witnesses + first, s, from);
	for (size_t at = 0; at < *n && !bad; at += BATCH)
		bad = lift(&r->candidates[first + at], *n - at < BATCH ? *n - at : BATCH, w, s, from + at,
			image, e);
	free(from);
	free(image);
	return bad ? -1 : 0;
}

int regions_lift(
	struct regions *r, size_t view, const struct view_weights *w, int height, int width, struct err *e)
{
	struct shapes s = {0};
	size_t begin = 0, end, n = 0;

	while (begin < r->witness_count && r->witnesses[begin].view < view)
		begin++;
	for (end = begin; end < r->witness_count && r->witnesses[end].view == view;)
		end++;
	int bad = seen_make(&r->seen[view], w, e) ||
		  shapes_make(&s, r->witnesses + begin, end - begin, height, width, e) ||
		  lift_masks(r, w, &s, begin, &n, e);
	r->ranges[view] = (struct regions_range){begin, begin + n};
	shapes_free(&s);
	return bad ? -1 : 0;
}

void regions_settle(struct regions *r)
{
	size_t w = 0;

	r->count = 0;
	for (size_t view = 0; view < r->views; view++) {
		const struct regions_range at = r->ranges[view];
		const size_t n = at.end - at.begin;
		while (w < r->witness_count && r->witnesses[w].view < view)
			w++;
		for (; w < r->witness_count && r->witnesses[w].view == view; w++)
			if (r->witnesses[w].candidate != REGIONS_NONE)
				r->witnesses[w].candidate -= at.begin - r->count;
		memmove(r->candidates + r->count, r->candidates + at.begin, n * sizeof *r->candidates);
		r->ranges[view] = (struct regions_range){r->count, r->count + n};
		r->count += n;
	}
}
