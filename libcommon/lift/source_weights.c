#include "lift/source_weights.h"

#include "base/mem.h"
#include "base/threads.h"

void source_weights_free(struct source_weights *s)
{
	mem_free_all(s->indptr, s->source, s->weight, s->last, s->start, s->order);
	*s = (struct source_weights){0};
}

void source_cells(int32_t *to, int height, int width, size_t map_height, size_t map_width)
{
	const size_t h = (size_t)height, w = (size_t)width;

	for (size_t i = 0; i < h; i++) {
		const size_t row = (2 * i + 1) * map_height / (2 * h);
		for (size_t j = 0; j < w; j++)
			to[i * w + j] = (int32_t)(row * map_width + (2 * j + 1) * map_width / (2 * w));
	}
}

static int make_room(struct source_weights *s, size_t pixels, size_t gaussians, size_t sources, struct err *e)
{
	if (mem_room((void **)&s->order, &s->pixel_room, pixels, sizeof *s->order, "pixels", e) ||
		mem_room((void **)&s->start, &s->source_room, sources + 1, sizeof *s->start, "sources", e))
		return -1;
	if (s->gaussian_room > gaussians)
		return 0;
	mem_free_all(s->indptr, s->last);
	s->gaussian_room = gaussians + 1;
	s->indptr = mem_alloc(gaussians + 1, sizeof *s->indptr, "Gaussians", e);
	s->last = mem_alloc(gaussians + 1, sizeof *s->last, "Gaussians", e);
	return s->indptr && s->last ? 0 : -1;
}

/* Pixels that have a source, by source and in their order within it. Returns how many. */
static size_t order_pixels(struct source_weights *s, size_t pixels, const int32_t *source, size_t sources)
{
	int64_t at = 0;

	memset(s->start, 0, (sources + 1) * sizeof *s->start);
	for (size_t p = 0; p < pixels; p++)
		if (source[p] != SOURCE_NONE)
			s->start[source[p]]++;
	for (size_t k = 0; k <= sources; k++) {
		const int64_t count = s->start[k];
		s->start[k] = at;
		at += count;
	}
	for (size_t p = 0; p < pixels; p++)
		if (source[p] != SOURCE_NONE)
			s->order[s->start[source[p]]++] = (int32_t)p;
	return (size_t)at;
}

/* Gaussians [low,high): how many sources each has, in indptr[i+1]. */
static void count(struct source_weights *s, const struct view_weights *w, const int32_t *source,
	size_t pixels, int32_t low, int32_t high)
{
	for (int32_t i = low; i < high; i++) {
		s->indptr[i + 1] = 0;
		s->last[i] = SOURCE_NONE;
	}
	for (size_t n = 0; n < pixels; n++) {
		const int32_t p = s->order[n], own = source[p];
		for (int64_t k = w->indptr[p], end = w->indptr[p + 1]; k < end; k++) {
			const int32_t i = w->index[k];
			if (i < low || i >= high || s->last[i] == own)
				continue;
			s->last[i] = own;
			s->indptr[i + 1]++;
		}
	}
}

/* The same Gaussians' items; indptr[i] is then where the next Gaussian's begin. */
static void fill(struct source_weights *s, const struct view_weights *w, const int32_t *source, size_t pixels,
	int32_t low, int32_t high)
{
	for (int32_t i = low; i < high; i++)
		s->last[i] = SOURCE_NONE;
	for (size_t n = 0; n < pixels; n++) {
		const int32_t p = s->order[n], own = source[p];
		for (int64_t k = w->indptr[p], end = w->indptr[p + 1]; k < end; k++) {
			const int32_t i = w->index[k];
			if (i < low || i >= high)
				continue;
			if (s->last[i] != own) {
				s->last[i] = own;
				s->source[s->indptr[i]] = own;
				s->weight[s->indptr[i]++] = 0;
			}
			s->weight[s->indptr[i] - 1] += w->weight[k];
		}
	}
}

typedef void part_fn(struct source_weights *s, const struct view_weights *w, const int32_t *source,
	size_t pixels, int32_t low, int32_t high);

/* Each thread looks at all weights, and takes those of its Gaussians. */
static void each_part(part_fn *work, struct source_weights *s, const struct view_weights *w,
	const int32_t *source, size_t pixels)
{
	const int parts = threads_available();

#pragma omp parallel for schedule(static, 1)
	for (int t = 0; t < parts; t++)
		work(s, w, source, pixels, (int32_t)(s->gaussians * (size_t)t / (size_t)parts),
			(int32_t)(s->gaussians * ((size_t)t + 1) / (size_t)parts));
}

int source_weights_make(struct source_weights *s, const struct view_weights *w, const int32_t *source,
	size_t sources, struct err *e)
{
	const size_t n = w->gaussians;
	size_t room = s->room;

	if (make_room(s, w->pixels, n, sources, e))
		return -1;
	s->gaussians = n;
	const size_t pixels = order_pixels(s, w->pixels, source, sources);
	each_part(count, s, w, source, pixels);
	s->indptr[0] = 0;
	for (size_t i = 0; i < n; i++)
		s->indptr[i + 1] += s->indptr[i];
	const size_t items = (size_t)s->indptr[n];
	if (mem_room((void **)&s->source, &room, items, sizeof *s->source, "weights", e) ||
		mem_room((void **)&s->weight, &s->room, items, sizeof *s->weight, "weights", e))
		return -1;
	each_part(fill, s, w, source, pixels);
	memmove(s->indptr + 1, s->indptr, n * sizeof *s->indptr);
	s->indptr[0] = 0;
	return 0;
}
