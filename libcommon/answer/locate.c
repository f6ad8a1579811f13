#include "answer/locate.h"

#include "base/mem.h"
#include "lift/inside.h"
#include "splat/sh.h"

#include <math.h>

/* What an answer is painted with, and how thickly: what is under it still shows its shape. */
static const double paint[3] = {1, 0.25, 0.125};
static const double thickness = 0.65;

static int locate_one(struct located *to, const struct responses *a, size_t answer, const struct splats *s,
	const double up[3])
{
	struct err ignored;
	SCOPED int32_t *ids = mem_alloc(s->n, sizeof *ids, "object", &ignored);
	SCOPED float *responses = mem_alloc(s->n, sizeof *responses, "object", &ignored);
	double sum = 0;
	int bad = -1;

	if (ids && responses) {
		const size_t n = responses_gaussians(a, s->n, answer, ids, responses);
		for (size_t i = 0; i < n; i++)
			sum += 1 / (1 + exp(a->lifts[answer] - (double)responses[i]));
		to->sure = n ? sum / (double)n : 0;
		bad = extent_find(&to->extent, s, ids, responses, n, up, &ignored);
	}
	return bad;
}

int locate_all(struct located *all, const struct responses *a, const struct splats *s, const double up[3],
	struct err *e)
{
	int bad = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (size_t k = 0; k < a->answers; k++)
		bad |= locate_one(&all[k], a, k, s, up) != 0;
	return bad ? err_set(e, ERR_SYSTEM, "objects: out of memory") : 0;
}

/* Mixes the paint into the colour, and takes as much out of what changes with the direction. */
static void paint_one(float *sh, int coefficients)
{
	for (int c = 0; c < 3; c++) {
		const double own = 0.5 + SH_C0 * (double)sh[c];
		sh[c] = (float)(((1 - thickness) * own + thickness * paint[c] - 0.5) / SH_C0);
		for (int k = 1; k < coefficients; k++)
			sh[3 * k + c] *= (float)(1 - thickness);
	}
}

static void only_of_extent(char *own, const struct extent *x, size_t n)
{
	for (size_t i = 0; i < x->n; i++)
		own[x->ids[i]] *= 2;
	for (size_t i = 0; i < n; i++)
		own[i] = own[i] > 1;
}

/* What locate_things goes over. */
struct taking {
	const struct lifted *l;
	const struct splats *s;
	const float *most;
	float *best;	    /* (N) the largest share of each Gaussian */
	char *own, *others; /* (N) of one thing */
	enum locate_show show;
};

static int take_thing(char *of, const struct taking *t, size_t thing, const struct extent *x, struct err *e)
{
	const struct lifted *l = t->l;
	const size_t n = t->s->n;

	memset(t->own, 0, n);
	for (int64_t k = l->indptr[thing]; k < l->indptr[thing + 1]; k++)
		t->own[l->index[k]] =
			l->share[k] > lifted_cut_of(l, thing) && l->share[k] >= t->best[l->index[k]];
	if (t->show == LOCATE_ISOLATED)
		only_of_extent(t->own, x, n);
	for (size_t i = 0; i < n; i++)
		t->others[i] = !t->own[i] && t->best[i] > LIFTED_CUT;
	if (inside_take(t->own, x, t->s, t->most, t->others, e))
		return -1;
	for (size_t i = 0; i < n; i++)
		of[i] |= t->own[i];
	return 0;
}

int locate_things(char *of, const struct lifted *l, const struct extent *extents, const size_t *things,
	size_t count, enum locate_show show, const struct splats *s, const float *most, struct err *e)
{
	const struct taking t = {l, s, most, mem_zalloc(s->n, sizeof(float), "object", e),
		mem_alloc(s->n, 1, "object", e), mem_alloc(s->n, 1, "object", e), show};
	int bad = !t.best || !t.own || !t.others;

	memset(of, 0, s->n);
	for (int64_t k = 0; k < l->indptr[l->objects] && !bad; k++)
		t.best[l->index[k]] = fmaxf(t.best[l->index[k]], l->share[k]);
	for (size_t i = 0; i < count && !bad; i++)
		bad = take_thing(of, &t, things[i], &extents[things[i]], e);
	mem_free_all(t.best, t.own, t.others);
	return bad ? -1 : 0;
}

int locate_answer(char *of, const struct responses *a, size_t answer, const struct extent *x,
	enum locate_show show, const struct splats *s, const float *most, struct err *e)
{
	SCOPED int32_t *ids = mem_alloc(s->n, sizeof *ids, "object", e);
	SCOPED float *responses = mem_alloc(s->n, sizeof *responses, "object", e);
	const size_t n = ids && responses ? responses_gaussians(a, s->n, answer, ids, responses) : 0;
	int bad = !ids || !responses;

	memset(of, 0, s->n);
	for (size_t i = 0; i < n; i++)
		of[ids[i]] = 1;
	if (show == LOCATE_ISOLATED)
		only_of_extent(of, x, s->n);
	return bad || inside_take(of, x, s, most, NULL, e) ? -1 : 0;
}

int locate_show(
	struct splats *to, const struct splats *s, const char *of, enum locate_show show, struct err *e)
{
	SCOPED char *kept = mem_alloc(s->n, 1, "scene", e);

	*to = (struct splats){0};
	if (!kept)
		return -1;
	for (size_t i = 0; i < s->n; i++)
		kept[i] = show == LOCATE_COLOURED || (of[i] != 0) == (show == LOCATE_ISOLATED);
	int bad = splats_keep(to, s, kept, e);
	for (size_t i = 0; i < s->n && !bad && show == LOCATE_COLOURED; i++)
		if (of[i])
			paint_one(to->sh + 3 * (size_t)s->sh_coefficients * i, s->sh_coefficients);
	return bad;
}
