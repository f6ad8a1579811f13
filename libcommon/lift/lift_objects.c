#include "lift/lift_objects.h"

#include "base/largest.h"
#include "base/mem.h"
#include "lift/lift_private.h"
#include "mask/bits.h"

/* What rounds to nothing in a file, formats/scene/lifted.md. */
static const float LEAST_SHARE = 0.5f / 255;

int lift_objects_init(struct lift_objects *l, size_t gaussians, size_t objects, size_t views, struct err *e)
{
	*l = (struct lift_objects){.gaussians = gaussians, .objects = objects};
	l->views = mem_zalloc(views, sizeof *l->views, "views", e);
	l->view_count = l->views ? views : 0;
	l->shares = mem_zalloc(objects, sizeof *l->shares, "shares", e);
	l->claims = mem_alloc(gaussians, sizeof *l->claims, "shares", e);
	l->agreement = mem_zalloc(objects, sizeof *l->agreement, "shares", e);
	l->masks = mem_zalloc(objects, sizeof *l->masks, "shares", e);
	l->cut = mem_alloc(objects, sizeof *l->cut, "shares", e);
	if (l->views && l->shares && l->claims && l->agreement && l->masks && l->cut)
		return 0;
	lift_objects_free(l);
	return -1;
}

static void view_free(struct lift_view *v)
{
	for (size_t k = 0; k < v->n && v->rows; k++)
		shares_free(&v->rows[k]);
	mem_free_all(v->objects, v->starts, v->bits, v->rows, v->vote, v->agreement, v->fit, v->weight);
}

void lift_objects_free(struct lift_objects *l)
{
	for (size_t v = 0; v < l->view_count; v++)
		view_free(&l->views[v]);
	for (size_t o = 0; o < l->objects && l->shares; o++)
		shares_free(&l->shares[o]);
	mem_free_all(l->views, l->shares, l->claims, l->agreement, l->masks, l->cut);
	*l = (struct lift_objects){0};
}

static int fill_bits(
	struct lift_view *v, const struct lift_mask *masks, size_t n, int height, int width, struct err *e)
{
	const size_t tiles = bits_tiles(height, width);
	int failed = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (size_t k = 0; k < n; k++) {
		struct err mine;
		SCOPED uint8_t *pixels = mem_alloc((size_t)height * (size_t)width, 1, "masks", &mine);
		if (!pixels || rle_decode_at(&masks[k].mask->rle, height, width, pixels, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		} else
			bits_pack_tiles(pixels, height, width, v->bits + k * tiles);
	}
	return failed ? -1 : 0;
}

/* What the view and each object's masks show. */
static int make_rows(struct lift_view *v, const struct view_matrix *w, struct err *e)
{
	SCOPED struct shares_masks *masks = mem_alloc(v->n, sizeof *masks, "masks", e);

	for (size_t k = 0; k < v->n && masks; k++)
		masks[k] = (struct shares_masks){v->bits + v->starts[k] * bits_tiles(w->height, w->width),
			v->starts[k + 1] - v->starts[k]};
	return !masks || shares_make(v->weight, v->rows, w, masks, v->n, e) ? -1 : 0;
}

int lift_objects_view(struct lift_objects *l, size_t at, const struct view_matrix *w,
	const struct lift_mask *masks, size_t n, struct err *e)
{
	struct lift_view *v = &l->views[at];

	v->objects = mem_alloc(n, sizeof *v->objects, "views", e);
	v->starts = mem_alloc(n + 1, sizeof *v->starts, "views", e);
	v->bits = mem_alloc(n, bits_tiles(w->height, w->width) * sizeof *v->bits, "masks", e);
	v->rows = mem_zalloc(n, sizeof *v->rows, "views", e);
	v->vote = mem_alloc(n, sizeof *v->vote, "views", e);
	v->agreement = mem_zalloc(n, sizeof *v->agreement, "views", e);
	v->fit = mem_zalloc(n, sizeof *v->fit, "views", e);
	v->weight = mem_alloc(w->gaussians, sizeof *v->weight, "views", e);
	if (!v->objects || !v->starts || !v->bits || !v->rows || !v->vote || !v->agreement || !v->fit ||
		!v->weight)
		return -1;
	for (size_t k = 0; k < n; k++) {
		if (k && masks[k].object == masks[k - 1].object)
			continue;
		v->objects[v->n] = masks[k].object;
		v->vote[v->n] = 1;
		v->starts[v->n++] = k;
	}
	v->starts[v->n] = n;
	return -(fill_bits(v, masks, n, w->height, w->width, e) || make_rows(v, w, e));
}

float lift_vote(double agreement)
{
	/* so that the masks of an object that another one has taken over still vote, all alike */
	const float least = 0.01f, squared = (float)(agreement * agreement);

	return squared > least ? squared : least;
}

int lift_objects_vote(struct lift_objects *l, size_t at, const struct view_matrix *w, struct err *e)
{
	struct lift_view *v = &l->views[at];

	if (lift_agreement(l, v, w, v->agreement, v->fit, e))
		return -1;
	for (size_t k = 0; k < v->n; k++)
		v->vote[k] = lift_vote(v->agreement[k]);
	return 0;
}

/* The mean of the last round, over an object's views. */
static void average_agreement(struct lift_objects *l)
{
	for (size_t at = 0; at < l->view_count; at++)
		for (size_t k = 0; k < l->views[at].n; k++) {
			l->agreement[l->views[at].objects[k]] += l->views[at].agreement[k];
			l->masks[l->views[at].objects[k]]++;
		}
	for (size_t o = 0; o < l->objects; o++)
		if (l->masks[o])
			l->agreement[o] /= (double)l->masks[o];
}

/* The cut of each object: the mean of IoU over its masks counts, each by its agreement. */
static void choose_cuts(struct lift_objects *l)
{
	for (size_t o = 0; o < l->objects; o++) {
		double fit[LIFT_CUTS] = {0}, all = 0;
		for (size_t at = 0; at < l->view_count; at++) {
			const struct lift_view *v = &l->views[at];
			const size_t k = lift_row(v, o);
			for (int cut = 0; k < v->n && cut < LIFT_CUTS; cut++)
				fit[cut] += v->agreement[k] * (double)v->fit[k][cut];
			all += k < v->n ? v->agreement[k] : 0;
		}
		const double best = largest(fit, LIFT_CUTS);
		int cut = 0;
		while (fit[cut] < best - LIFT_CUT_GAIN * all)
			cut++;
		l->cut[o] = LIFTED_CUT - (float)cut * (float)LIFT_CUT_STEP;
	}
}

int lift_objects_settle(struct lift_objects *l, struct err *e)
{
	const int is_last = ++l->round == LIFT_ROUNDS;

	if (lift_shares(l, is_last, e))
		return -1;
	if (is_last) {
		average_agreement(l);
		choose_cuts(l);
	}
	return 0;
}

int lift_objects_finish(const struct lift_objects *l, struct lifted *to, struct err *e)
{
	size_t count = 0, at = 0;

	for (size_t o = 0; o < l->objects; o++)
		for (size_t k = 0; k < l->shares[o].n; k++)
			count += l->shares[o].share[k] > LEAST_SHARE;
	to->gaussians = l->gaussians;
	to->objects = l->objects;
	to->confidence = mem_alloc(l->objects, sizeof *to->confidence, "shares", e);
	to->indptr = mem_zalloc(l->objects + 1, sizeof *to->indptr, "shares", e);
	to->index = mem_alloc(count, sizeof *to->index, "shares", e);
	to->share = mem_alloc(count, sizeof *to->share, "shares", e);
	to->cut = mem_alloc(l->objects, sizeof *to->cut, "shares", e);
	if (!to->confidence || !to->cut || !to->indptr || !to->index || !to->share)
		return -1;
	for (size_t o = 0; o < l->objects; o++) {
		const struct shares *row = &l->shares[o];
		to->confidence[o] = (float)l->agreement[o];
		to->cut[o] = l->cut[o];
		for (size_t k = 0; k < row->n; k++)
			if (row->share[k] > LEAST_SHARE) {
				to->index[at] = row->index[k];
				to->share[at++] = row->share[k];
			}
		to->indptr[o + 1] = (int64_t)at;
	}
	return 0;
}
