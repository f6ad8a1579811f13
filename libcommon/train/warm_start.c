#include "train/warm_start.h"

#include "base/dot.h"
#include "base/mem.h"
#include "base/names.h"
#include "base/rng.h"
#include "mask/bits.h"

#include <math.h>

enum { STREAM_DIRECTIONS = 5 };

static const float cut = 0.5f;
/* An object has at least this part of the rows' pixels. */
static const double least = 0.02;
/* The length of a feature of one object. Longer than what the networks' first weights expect (1): their rate
 * is low, and this makes the differences between objects large from the start. */
static const double length = 8;

/* In place of a sentence's object: it was not lifted; the sentence means nothing that is there. */
enum { UNKNOWN = -1, NOTHING = -2 };

/* numbers (sentences): sentence r is of the matched object numbers[r], UNKNOWN or NOTHING; lifted (matched):
 * its number among the lifted. */
static int match(struct warm_start *w, const struct warm_start_source *from, long *numbers, size_t *lifted,
	struct err *e)
{
	const size_t objects = from->lifted->objects;
	/* + 1; 0: not matched so far */
	SCOPED size_t *number = mem_zalloc(objects, sizeof *number, "warm start", e);
	SCOPED_BY(names_free) struct names names = {0};

	if (!number || names_make(&names, from->lifted->names, sizeof(char *), 0, objects, e))
		return -1;
	for (size_t r = 0; r < from->sentences; r++) {
		const size_t o = names_find(&names, from->names[r]);
		numbers[r] = *from->names[r] ? UNKNOWN : NOTHING;
		if (o == NAMES_NONE)
			continue;
		if (!number[o]) {
			lifted[w->objects++] = o;
			number[o] = w->objects;
		}
		numbers[r] = (long)number[o] - 1;
	}
	return 0;
}

/* share (rows) of an object; sum (rows). */
static void find_shares(
	const struct warm_start_source *from, size_t object, const double *all, double *sum, float *share)
{
	const struct rows *rows = from->rows;
	const struct lifted *l = from->lifted;

	memset(sum, 0, sizeof *sum * rows->n);
	for (int64_t k = l->indptr[object]; k < l->indptr[object + 1]; k++) {
		const int32_t i = l->index[k], row = rows->of[i];
		if (row >= 0)
			sum[row] += from->weight[i] * (double)l->share[k];
	}
	for (size_t r = 0; r < rows->n; r++)
		share[r] = all[r] > 0 ? (float)(sum[r] / all[r]) : 0;
}

static int make_shares(
	struct warm_start *w, const struct warm_start_source *from, const size_t *lifted, struct err *e)
{
	const struct rows *rows = from->rows;
	SCOPED double *all = mem_zalloc(rows->n, 2 * sizeof *all, "shares", e);

	w->share = mem_alloc(w->objects, rows->n * sizeof *w->share, "shares", e);
	if (!all || !w->share)
		return -1;
	for (size_t i = 0; i < rows->gaussians; i++)
		if (rows->of[i] >= 0)
			all[rows->of[i]] += from->weight[i];
	for (size_t k = 0; k < w->objects; k++)
		find_shares(from, lifted[k], all, all + rows->n, w->share + k * rows->n);
	return 0;
}

static size_t count_rows(const float *share, size_t rows)
{
	size_t count = 0;

	for (size_t i = 0; i < rows; i++)
		count += share[i] > cut;
	return count;
}

/* How many more pixels each row of an object of `count` gets. */
static size_t copies(size_t count, size_t rows)
{
	const size_t wanted = (size_t)(least * (double)rows);

	return count && wanted > count ? (wanted - count) / count : 0;
}

/* Every row, and the rows of small objects again. */
static int make_pixels(struct warm_start *w, size_t rows, struct err *e)
{
	size_t pixels = rows, p = rows;

	for (size_t k = 0; k < w->objects; k++) {
		const size_t count = count_rows(w->share + k * rows, rows);
		pixels += count * copies(count, rows);
	}
	w->indptr = mem_alloc(pixels + 1, sizeof *w->indptr, "warm start", e);
	w->index = mem_alloc(pixels, sizeof *w->index, "warm start", e);
	w->weight = mem_alloc(pixels, sizeof *w->weight, "warm start", e);
	if (!w->indptr || !w->index || !w->weight)
		return -1;
	for (size_t i = 0; i < rows; i++)
		w->index[i] = (int32_t)i;
	for (size_t k = 0; k < w->objects; k++) {
		const float *share = w->share + k * rows;
		const size_t times = copies(count_rows(share, rows), rows);
		for (size_t i = 0; i < rows && times; i++)
			for (size_t c = 0; c < times && share[i] > cut; c++)
				w->index[p++] = (int32_t)i;
	}
	for (size_t i = 0; i < pixels; i++) {
		w->indptr[i] = (int64_t)i;
		w->weight[i] = 1;
	}
	w->indptr[pixels] = (int64_t)pixels;
	w->view.weights = (struct view_weights){pixels, rows, w->indptr, w->index, w->weight};
	return 0;
}

static int make_masks(struct warm_start *w, const struct warm_start_source *from, size_t rows,
	const long *numbers, struct err *e)
{
	const size_t pixels = w->view.weights.pixels, bytes = bits_bytes(pixels);
	SCOPED uint8_t *mask = mem_alloc(pixels, 1, "warm start", e);

	w->bits = mem_zalloc(w->objects + 1, bytes, "warm start", e); /* the last of nothing */
	w->view.sentences = mem_alloc(from->sentences, sizeof *w->view.sentences, "warm start", e);
	w->view.masks = mem_alloc(from->sentences, sizeof *w->view.masks, "warm start", e);
	if (!mask || !w->bits || !w->view.sentences || !w->view.masks)
		return -1;
	for (size_t k = 0; k < w->objects; k++) {
		for (size_t i = 0; i < pixels; i++)
			mask[i] = w->share[k * rows + (size_t)w->index[i]] > cut;
		bits_pack(mask, pixels, w->bits + k * bytes);
	}
	for (size_t r = 0; r < from->sentences; r++)
		if (numbers[r] != UNKNOWN) {
			const size_t k = numbers[r] == NOTHING ? w->objects : (size_t)numbers[r];
			w->view.sentences[w->view.count] = (int)r;
			w->view.masks[w->view.count++] = w->bits + k * bytes;
		}
	return 0;
}

int warm_start_init(struct warm_start *w, const struct warm_start_source *from,
	const struct train_contrast *contrast, uint64_t seed, struct err *e)
{
	const size_t rows = from->rows->n;
	SCOPED long *numbers = mem_alloc(from->sentences, sizeof *numbers, "warm start", e);
	SCOPED size_t *lifted = mem_alloc(from->sentences, sizeof *lifted, "warm start", e);
	int bad = !numbers || !lifted;

	*w = (struct warm_start){0};
	bad = bad || match(w, from, numbers, lifted, e) || make_shares(w, from, lifted, e) ||
	      make_pixels(w, rows, e) || make_masks(w, from, rows, numbers, e) ||
	      train_order_init(&w->order, &w->view, 1, WARM_START_BATCH, contrast, seed, e);
	return bad ? -1 : 0;
}

void warm_start_free(struct warm_start *w)
{
	mem_free_all(w->share, w->indptr, w->index, w->weight, w->bits, w->view.sentences, w->view.masks);
	train_order_free(&w->order);
	*w = (struct warm_start){0};
}

/* A random direction at a right angle to those before it (before, width), fewer than width. */
static void draw_direction(struct rng *r, int width, const double *before, int count, double *direction)
{
	for (int c = 0; c < width; c++)
		direction[c] = rng_normal(r);
	for (int k = 0; k < count; k++) {
		const double *other = before + k * width, along = dot(direction, other, width);
		for (int c = 0; c < width; c++)
			direction[c] -= along * other[c];
	}
	const double size = sqrt(dot(direction, direction, width));
	for (int c = 0; c < width && size > 0; c++)
		direction[c] /= size;
}

int warm_start_features(const struct warm_start *w, int width, uint64_t seed, float *x, struct err *e)
{
	const size_t rows = w->view.weights.gaussians;
	SCOPED double *directions =
		mem_alloc((size_t)width, (size_t)width * sizeof *directions, "features", e);
	struct rng r;

	if (!directions)
		return -1;
	rng_seed(&r, seed, STREAM_DIRECTIONS);
	memset(x, 0, sizeof *x * rows * (size_t)width);
	for (size_t k = 0; k < w->objects; k++) {
		const int place = (int)(k % (size_t)width);
		double *direction = directions + place * width;
		draw_direction(&r, width, directions, place, direction);
		for (size_t i = 0; i < rows; i++)
			for (int c = 0; c < width; c++)
				x[i * (size_t)width + (size_t)c] +=
					(float)(length * (double)w->share[k * rows + i] * direction[c]);
	}
	return 0;
}
