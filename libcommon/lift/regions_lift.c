#include "lift/regions_private.h"

#include "base/mem.h"
#include "mask/bits.h"

/* Intersection over union from which masks of a view are one candidate. Of 0.9, 0.95 and every mask by
 * itself, the mIoU of the masks that come of it in training views, mean of the eight scenes of
 * pipelines/ablation.md: 66.5, 66.7, 66.8. */
#define ALIKE 0.95

/* Masks of one view as bits at its size, by tiles. */
struct shapes {
	size_t n, tiles;
	uint64_t *bits; /* (n,tiles) */
	size_t *area;	/* (n) */
};

static void shapes_free(struct shapes *s)
{
	mem_free_all(s->bits, s->area);
}

/* Pixels in common. */
static size_t common(const struct shapes *s, size_t a, size_t b)
{
	return bits_common((const uint8_t *)(s->bits + a * s->tiles),
		(const uint8_t *)(s->bits + b * s->tiles), s->tiles * sizeof *s->bits);
}

static int fill_shape(
	struct shapes *s, size_t k, const struct rle *mask, int height, int width, struct err *e)
{
	SCOPED uint8_t *mine = mem_alloc((size_t)height * (size_t)width, 1, "masks", e);
	const int bad = !mine || rle_decode_at(mask, height, width, mine, e);

	if (!bad) {
		bits_pack_tiles(mine, height, width, s->bits + k * s->tiles);
		s->area[k] = common(s, k, k);
	}
	return bad;
}

static int shapes_make(
	struct shapes *s, const struct regions_witness *w, size_t n, int height, int width, struct err *e)
{
	int failed = 0;

	*s = (struct shapes){.n = n, .tiles = bits_tiles(height, width)};
	s->bits = mem_alloc(n, s->tiles * sizeof *s->bits, "masks", e);
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
	const size_t all = s->area[a] + s->area[b], both = common(s, a, b);

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

/* The shares of n candidates of a view, whose masks are from[]. */
static int lift(struct seen *seen, struct regions_candidate *c, size_t n, const struct view_matrix *w,
	const struct shapes *s, const size_t *from, struct err *e)
{
	SCOPED float *weight = mem_alloc(w->gaussians, sizeof *weight, "views", e);
	SCOPED struct shares *rows = mem_alloc(n, sizeof *rows, "masks", e);
	SCOPED struct shares_masks *masks = mem_alloc(n, sizeof *masks, "masks", e);
	int bad = !weight || !rows || !masks;

	for (size_t k = 0; k < n && !bad; k++)
		masks[k] = (struct shares_masks){s->bits + from[k] * s->tiles, 1};
	bad = bad || shares_make(weight, rows, w, masks, n, e);
	for (size_t k = 0; k < n && !bad; k++) {
		c[k].shares = rows[k];
		for (size_t i = 0; i < rows[k].n; i++)
			c[k].mass += (double)rows[k].share[i];
	}
	return bad || seen_make(seen, weight, w->gaussians, e) ? -1 : 0;
}

static int lift_masks(struct regions *r, size_t view, const struct view_matrix *w, const struct shapes *s,
	size_t first, size_t *n, struct err *e)
{
	SCOPED size_t *from = mem_alloc(s->n, sizeof *from, "masks", e);

	*n = from ? add_candidates(r, first, r->witnesses + first, s, from) : 0;
	return !from || lift(&r->seen[view], &r->candidates[first], *n, w, s, from, e) ? -1 : 0;
}

int regions_lift(struct regions *r, size_t view, const struct view_matrix *w, struct err *e)
{
	SCOPED_BY(shapes_free) struct shapes s = {0};
	size_t begin = 0, end, n = 0;

	while (begin < r->witness_count && r->witnesses[begin].view < view)
		begin++;
	for (end = begin; end < r->witness_count && r->witnesses[end].view == view;)
		end++;
	const int bad = shapes_make(&s, r->witnesses + begin, end - begin, w->height, w->width, e) ||
			lift_masks(r, view, w, &s, begin, &n, e);
	r->ranges[view] = (struct regions_range){begin, begin + n};
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
