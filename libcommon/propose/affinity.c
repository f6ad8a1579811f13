#include "propose/affinity.h"

#include "base/mem.h"
#include "geom/neighbours.h"
#include "lift/shares.h"
#include "mask/bits.h"

#include <math.h>

/* Of a dissimilarity, in which each affinity is taken from 1. Found on Ref-Synth and the desk's training
 * views. */
#define IMAGE_WEIGHT 0.3
#define BOX_WEIGHT 1.0
#define LENGTH_UNIT 1048576.0

void affinity_free(struct affinity *a)
{
	mem_free_all(a->ends, a->image, a->box);
	*a = (struct affinity){0};
}

int affinity_init(
	struct affinity *a, const float *points, const int32_t *kept, size_t n, int neighbours, struct err *e)
{
	const size_t k = (size_t)neighbours;
	SCOPED int32_t *near = mem_alloc(n, k * sizeof *near, "neighbours", e);

	*a = (struct affinity){0};
	if (!near || neighbours_list(points, n, neighbours, near, e))
		return -1;
	a->ends = mem_alloc(n, k * sizeof *a->ends, "neighbours", e);
	if (!a->ends)
		return -1;
	for (size_t i = 0; i < n; i++)
		for (size_t j = 0; j < k && near[i * k + j] >= 0; j++) {
			const size_t other = (size_t)near[i * k + j];
			int is_mutual = 0;
			for (size_t m = 0; m < k; m++)
				is_mutual |= near[other * k + m] == (int32_t)i;
			if (is_mutual && other < i)
				continue;
			a->ends[a->count][0] = kept ? kept[i] : (int32_t)i;
			a->ends[a->count++][1] = kept ? kept[other] : (int32_t)other;
		}
	a->image = mem_zalloc(a->count, sizeof *a->image, "neighbours", e);
	a->box = mem_zalloc(a->count, sizeof *a->box, "neighbours", e);
	return a->image && a->box ? 0 : -1;
}

/* What each Gaussian has of some masks: rows of shares.h the other way. */
struct parts {
	size_t *begin; /* (N+1) */
	int32_t *item; /* masks, rising for each Gaussian */
	float *share;  /* of the Gaussian's weight in the view */
};

static void parts_free(struct parts *p)
{
	mem_free_all(p->begin, p->item, p->share);
}

static int parts_of(struct parts *p, const struct shares *rows, size_t count, const float *weight, size_t n,
	struct err *e)
{
	p->begin = mem_zalloc(n + 2, sizeof *p->begin, "views", e);
	if (!p->begin)
		return -1;
	for (size_t k = 0; k < count; k++)
		for (size_t m = 0; m < rows[k].n; m++)
			p->begin[rows[k].index[m] + 2]++;
	for (size_t i = 2; i < n + 2; i++)
		p->begin[i] += p->begin[i - 1];
	p->item = mem_alloc(p->begin[n + 1], sizeof *p->item, "views", e);
	p->share = mem_alloc(p->begin[n + 1], sizeof *p->share, "views", e);
	if (!p->item || !p->share)
		return -1;
	for (size_t k = 0; k < count; k++)
		for (size_t m = 0; m < rows[k].n; m++) {
			const size_t i = (size_t)rows[k].index[m], at = p->begin[i + 1]++;
			p->item[at] = (int32_t)k;
			p->share[at] = rows[k].share[m] / weight[i];
		}
	return 0;
}

/* weight (N) gets that of each Gaussian in the view. bits (count,tiles) are the masks. */
static int parts_make(struct parts *p, const struct view_matrix *w, const uint64_t *bits, size_t count,
	float *weight, struct err *e)
{
	const size_t tiles = bits_tiles(w->height, w->width);
	SCOPED struct shares *rows = mem_zalloc(count, sizeof *rows, "masks", e);
	SCOPED struct shares_masks *masks = mem_alloc(count, sizeof *masks, "masks", e);

	if (!rows || !masks)
		return -1;
	for (size_t k = 0; k < count; k++)
		masks[k] = (struct shares_masks){bits + k * tiles, 1};
	if (shares_make(weight, rows, w, masks, count, e))
		return -1;
	const int bad = parts_of(p, rows, count, weight, w->gaussians, e);
	for (size_t k = 0; k < count; k++)
		shares_free(&rows[k]);
	return bad;
}

static uint64_t *piece_bits(const struct pieces *p, struct err *e)
{
	const size_t tiles = bits_tiles(p->height, p->width), across = ((size_t)p->width + 7) / 8;
	uint64_t *bits = mem_zalloc((size_t)p->count, tiles * sizeof *bits, "pieces", e);

	for (int r = 0; r < p->height && bits; r++)
		for (int c = 0; c < p->width; c++) {
			const size_t k = (size_t)p->piece[(size_t)r * (size_t)p->width + (size_t)c];
			bits[k * tiles + (size_t)(r / 8) * across + (size_t)(c / 8)] |=
				(uint64_t)1 << (r % 8 * 8 + c % 8);
		}
	return bits;
}

/* Pixels whose centres are in a box. */
static uint64_t *box_bits(
	const struct view_matrix *w, const struct affinity_box *boxes, size_t count, struct err *e)
{
	const size_t tiles = bits_tiles(w->height, w->width);
	SCOPED uint8_t *mask = mem_alloc((size_t)w->height, (size_t)w->width, "boxes", e);
	uint64_t *bits = mem_zalloc(count, tiles * sizeof *bits, "boxes", e);

	for (size_t k = 0; k < count && bits && mask; k++) {
		const struct affinity_box *b = &boxes[k];
		for (int r = 0; r < w->height; r++)
			for (int c = 0; c < w->width; c++)
				mask[(size_t)r * (size_t)w->width + (size_t)c] =
					c + 0.5 > b->left && c + 0.5 < b->right && r + 0.5 > b->top &&
					r + 0.5 < b->bottom;
		bits_pack_tiles(mask, w->height, w->width, bits + k * tiles);
	}
	if (!mask) {
		free(bits);
		bits = NULL;
	}
	return bits;
}

/* sum_s min(m_i(s), m_j(s)) over the segments of one level. */
static double in_common(const struct parts *p, const int32_t *segment, size_t i, size_t j)
{
	size_t a = p->begin[i], b = p->begin[j];
	double sum = 0;

	while (a < p->begin[i + 1] && b < p->begin[j + 1]) {
		const int32_t s = segment[p->item[a]], t = segment[p->item[b]];
		float mine = 0, other = 0;
		if (s <= t)
			for (; a < p->begin[i + 1] && segment[p->item[a]] == s; a++)
				mine += p->share[a];
		if (t <= s)
			for (; b < p->begin[j + 1] && segment[p->item[b]] == t; b++)
				other += p->share[b];
		sum += fminf(mine, other);
	}
	return sum;
}

static void add_image(struct affinity *a, const struct parts *p, const struct pieces *of, const float *weight)
{
#pragma omp parallel for schedule(dynamic, 4096)
	for (size_t k = 0; k < a->count; k++) {
		const size_t i = (size_t)a->ends[k][0], j = (size_t)a->ends[k][1];
		const double least = fminf(weight[i], weight[j]);
		double sum = 0;
		if (!(least > 0))
			continue;
		for (int level = 0; level < PIECES_LEVELS; level++)
			sum += in_common(p, of->segment + level * of->count, i, j);
		a->image[k][0] += least * sum / PIECES_LEVELS;
		a->image[k][1] += least;
	}
}

static void add_box(
	struct affinity *a, const struct parts *p, const struct affinity_box *boxes, const float *weight)
{
#pragma omp parallel for schedule(dynamic, 4096)
	for (size_t k = 0; k < a->count; k++) {
		const size_t i = (size_t)a->ends[k][0], j = (size_t)a->ends[k][1];
		size_t m = p->begin[i], n = p->begin[j];
		if (!(weight[i] > 0 && weight[j] > 0))
			continue;
		while (m < p->begin[i + 1] || n < p->begin[j + 1]) {
			const int32_t s = m < p->begin[i + 1] ? p->item[m] : INT32_MAX,
				      t = n < p->begin[j + 1] ? p->item[n] : INT32_MAX;
			const double mine = s <= t ? p->share[m] : 0, other = t <= s ? p->share[n] : 0;
			const double score = boxes[s < t ? s : t].score;
			a->box[k][0] += score * fmin(mine, other);
			a->box[k][1] += score * fmax(mine, other);
			m += s <= t;
			n += t <= s;
		}
	}
}

int affinity_view(struct affinity *a, const struct view_matrix *w, const struct pieces *p,
	const struct affinity_box *boxes, size_t box_count, struct err *e)
{
	SCOPED float *weight = mem_alloc(w->gaussians, sizeof *weight, "views", e);
	SCOPED uint64_t *bits = piece_bits(p, e);
	SCOPED uint64_t *box = box_bits(w, boxes, box_count, e);
	SCOPED_BY(parts_free) struct parts parts = {0};
	SCOPED_BY(parts_free) struct parts inside = {0};

	if (!weight || !bits || !box || parts_make(&parts, w, bits, (size_t)p->count, weight, e))
		return -1;
	add_image(a, &parts, p, weight);
	if (box_count && parts_make(&inside, w, box, box_count, weight, e))
		return -1;
	if (box_count)
		add_box(a, &inside, boxes, weight);
	return 0;
}

void affinity_edges(const struct affinity *a, struct linkage_edge *edges)
{
	for (size_t k = 0; k < a->count; k++) {
		const double *image = a->image[k], *box = a->box[k];
		const double apart = IMAGE_WEIGHT * (1 - (image[1] > 0 ? image[0] / image[1] : 0)) +
				     BOX_WEIGHT * (box[1] > 0 ? 1 - box[0] / box[1] : 0);
		edges[k] = (struct linkage_edge){
			a->ends[k][0], a->ends[k][1], llround(LENGTH_UNIT * fmax(apart, 0))};
	}
}
