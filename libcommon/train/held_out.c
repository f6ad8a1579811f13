#include "train/held_out.h"

#include "base/mem.h"
#include "base/rng.h"
#include "mask/bits.h"
#include "nn/loss.h"

#include <math.h>
#include <omp.h>

enum { STREAM_HELD = 6 };

/* Pairs of a view and an object, in the order of views and of sentences: *n of them; where out is not NULL,
 * the numbers (views,sentences) get the pair of each of a view's sentences. seen (sentences). */
static size_t number_pairs(const struct train_view *views, size_t view_count, const int *objects,
	size_t sentences, uint32_t *seen, uint32_t *out)
{
	size_t n = 0;

	for (size_t v = 0; v < view_count; v++) {
		memset(seen, 0xff, sizeof *seen * sentences);
		for (int k = 0; k < views[v].count; k++) {
			uint32_t *own = &seen[objects[views[v].sentences[k]]];
			if (*own == UINT32_MAX)
				*own = (uint32_t)n++;
			out[v * sentences + (size_t)k] = *own;
		}
	}
	return n;
}

/* Moves the held-out sentences of a view behind the others; either keep their order. */
static void part_view(struct train_view *v, const uint32_t *pairs, const char *is_held, int *sentences,
	const uint8_t **masks)
{
	int to = 0;

	for (int held = 0; held < 2; held++) {
		for (int k = 0; k < v->count; k++)
			if (is_held[pairs[k]] == held) {
				sentences[to] = v->sentences[k];
				masks[to++] = v->masks[k];
			}
		if (!held)
			v->held = v->count - to;
	}
	memcpy(v->sentences, sentences, sizeof *sentences * (size_t)v->count);
	memcpy(v->masks, masks, sizeof *masks * (size_t)v->count);
	v->count -= v->held;
}

/* is_held (n) gets `count` random ones. */
static int draw(char *is_held, size_t n, size_t count, uint64_t seed, struct err *e)
{
	SCOPED uint32_t *order = mem_alloc(n, sizeof *order, "held-out pairs", e);
	struct rng r;

	if (!order)
		return -1;
	for (size_t k = 0; k < n; k++)
		order[k] = (uint32_t)k;
	rng_seed(&r, seed, STREAM_HELD);
	rng_shuffle(&r, order, (uint32_t)n);
	for (size_t k = 0; k < count; k++)
		is_held[order[k]] = 1;
	return 0;
}

int held_out_choose(struct train_view *views, size_t view_count, const int *objects, size_t sentences,
	double share, uint64_t seed, struct err *e)
{
	SCOPED uint32_t *seen = mem_alloc(sentences, sizeof *seen, "held-out pairs", e);
	SCOPED uint32_t *pairs = mem_alloc(view_count, sentences * sizeof *pairs, "held-out pairs", e);
	SCOPED char *is_held = mem_zalloc(view_count, sentences, "held-out pairs", e);
	SCOPED int *kept = mem_alloc(sentences, sizeof *kept, "held-out pairs", e);
	SCOPED const uint8_t **masks = mem_alloc(sentences, sizeof *masks, "held-out pairs", e);
	int bad = !seen || !pairs || !is_held || !kept || !masks;

	if (!bad) {
		const size_t n = number_pairs(views, view_count, objects, sentences, seen, pairs);
		const double wanted = fmin(fmax(1, round(share * (double)n)), (double)n - 1);
		bad = n < 2 ? err_set(e, ERR_FORMAT, "one pair of a view and an object, none to hold out")
			    : draw(is_held, n, (size_t)wanted, seed, e);
	}
	for (size_t v = 0; v < view_count && !bad; v++)
		part_view(&views[v], pairs + v * sentences, is_held, kept, masks);
	return bad ? -1 : 0;
}

/* The sentences with held-out masks, by object, so that those of one object, which are held out in the same
 * views, are blended together. */
static void make_order(struct held_out *h, const int *objects, size_t sentences, char *is_held)
{
	for (size_t v = 0; v < h->views.n; v++) {
		const struct train_view *view = &h->views.views[v];
		for (int k = view->count; k < view->count + view->held; k++)
			is_held[view->sentences[k]] = 1;
		h->pairs += (size_t)view->held;
		h->pixels = view->held && view->weights.pixels > h->pixels ? view->weights.pixels : h->pixels;
	}
	for (size_t first = 0; first < sentences; first++)
		for (size_t r = first; r < sentences; r++)
			if (is_held[r] && objects[r] == objects[first]) {
				h->order[h->count++] = r;
				is_held[r] = 0;
			}
}

int held_out_init(struct held_out *h, const struct view_source *views, const int *objects, size_t sentences,
	size_t rows, struct err *e)
{
	SCOPED char *is_held = mem_zalloc(sentences, 1, "held-out pairs", e);

	*h = (struct held_out){.views = *views, .rows = rows, .threads = omp_get_max_threads()};
	h->order = mem_alloc(sentences, sizeof *h->order, "held-out pairs", e);
	if (is_held && h->order) {
		make_order(h, objects, sentences, is_held);
		h->response = mem_alloc(rows, (1 + VIEW_GROUP) * sizeof(float), "held-out pairs", e);
		h->images = mem_alloc(
			h->pixels, (size_t)h->threads * VIEW_GROUP * sizeof(float), "held-out pairs", e);
		h->masks = mem_alloc(h->pixels, (size_t)h->threads, "held-out pairs", e);
		h->scores = mem_alloc(views->n, sizeof *h->scores, "held-out pairs", e);
	}
	if (!h->response || !h->images || !h->masks || !h->scores) {
		held_out_free(h);
		return -1;
	}
	h->grouped = h->response + rows;
	return 0;
}

void held_out_free(struct held_out *h)
{
	mem_free_all(h->order, h->response, h->images, h->masks, h->scores);
	*h = (struct held_out){0};
}

static struct held_out_score score_image(const float *image, const uint8_t *mask, size_t pixels)
{
	size_t both = 0, either = 0;

	for (size_t p = 0; p < pixels; p++) {
		both += mask[p] && image[p] > 0;
		either += mask[p] || image[p] > 0;
	}
	return (struct held_out_score){
		loss_bce(image, mask, pixels, 1, NULL), either ? (double)both / (double)either : 1};
}

/* Whether one of `count` sentences is held out in a view. */
static int has_any(const struct train_view *v, const size_t *sentences, int count)
{
	for (int g = 0; g < count; g++)
		for (int k = v->count; k < v->count + v->held; k++)
			if ((size_t)v->sentences[k] == sentences[g])
				return 1;
	return 0;
}

/* The held-out pairs of one view with `count` sentences, whose responses are in grouped. */
static struct held_out_score score_pairs(const struct held_out *h, const struct train_view *v,
	const struct view_weights *w, const size_t *sentences, int count)
{
	const size_t thread = (size_t)omp_get_thread_num(), pixels = w->pixels;
	float *image = h->images + thread * VIEW_GROUP * h->pixels;
	uint8_t *mask = h->masks + thread * h->pixels;
	struct held_out_score sum = {0};

	view_blend_group(w, h->grouped, VIEW_GROUP, 0, pixels, image, h->pixels);
	for (int g = 0; g < count; g++)
		for (int k = v->count; k < v->count + v->held; k++) {
			if ((size_t)v->sentences[k] != sentences[g])
				continue;
			bits_expand(v->masks[k], 0, pixels, mask);
			const struct held_out_score one =
				score_image(image + (size_t)g * h->pixels, mask, pixels);
			sum.bce += one.bce;
			sum.iou += one.iou;
		}
	return sum;
}

static int score_view(struct held_out *h, size_t view, const size_t *sentences, int count, struct err *e)
{
	const struct train_view *v = &h->views.views[view];
	struct view_weights w;

	h->scores[view] = (struct held_out_score){0};
	if (!has_any(v, sentences, count))
		return 0;
	if (view_source_open(&h->views, view, &w, e))
		return -1;
	h->scores[view] = score_pairs(h, v, &w, sentences, count);
	view_source_close(&h->views, view);
	return 0;
}

/* Scores the views with `count` sentences. */
static int score_views(struct held_out *h, const size_t *sentences, int count, struct err *e)
{
	int bad = 0;

#pragma omp parallel for schedule(dynamic) num_threads(h->threads) reduction(| : bad)
	for (size_t v = 0; v < h->views.n; v++) {
		struct err own;
		if (!score_view(h, v, sentences, count, &own))
			continue;
		bad = 1;
#pragma omp critical(held_out_failed)
		*e = own;
	}
	return bad ? -1 : 0;
}

int held_out_evaluate(struct held_out *h, struct step *s, const float *parameters, const float *x,
	struct held_out_score *score, struct err *e)
{
	*score = (struct held_out_score){0};
	memset(h->grouped, 0, sizeof(float) * VIEW_GROUP * h->rows);
	for (size_t first = 0; first < h->count; first += VIEW_GROUP) {
		const int now = h->count - first < VIEW_GROUP ? (int)(h->count - first) : VIEW_GROUP;
		for (int g = 0; g < now; g++) {
			step_respond(s, parameters, x, h->order[first + (size_t)g], h->response);
			for (size_t i = 0; i < h->rows; i++)
				h->grouped[i * VIEW_GROUP + (size_t)g] = h->response[i];
		}
		if (score_views(h, h->order + first, now, e))
			return -1;
		for (size_t v = 0; v < h->views.n; v++) {
			score->bce += h->scores[v].bce / (double)h->pairs;
			score->iou += h->scores[v].iou / (double)h->pairs;
		}
	}
	return 0;
}
