#include "answer/locate.h"

#include "base/mem.h"
#include "splat/sh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What an answer is painted with, and how thickly: what is under it still shows its shape. */
static const double paint[3] = {1, 0.25, 0.125};
static const double thickness = 0.65;

static int locate_one(struct located *to, const struct responses *a, size_t answer, const struct splats *s,
	const double up[3])
{
	struct err ignored;
	int32_t *ids = mem_alloc(s->n, sizeof *ids, "object", &ignored);
	float *responses = mem_alloc(s->n, sizeof *responses, "object", &ignored);
	double sum = 0;
	int bad = -1;

	if (ids && responses) {
		const size_t n = responses_gaussians(a, s->n, answer, ids, responses);
		for (size_t i = 0; i < n; i++)
			sum += 1 / (1 + exp(a->lifts[answer] - (double)responses[i]));
		to->sure = n ? sum / (double)n : 0;
		bad = extent_find(&to->extent, s, ids, responses, n, up, &ignored);
	}
	free(ids);
	free(responses);
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

int locate_show(struct splats *to, const struct splats *s, const struct extent *x, enum locate_show show,
	struct err *e)
{
	char *kept = mem_alloc(s->n, 1, "scene", e);

	*to = (struct splats){0};
	if (!kept)
		return -1;
	memset(kept, show != LOCATE_ISOLATED, s->n);
	for (size_t i = 0; i < x->n && show != LOCATE_COLOURED; i++)
		kept[x->ids[i]] = show == LOCATE_ISOLATED;
	int bad = splats_keep(to, s, kept, e);
	for (size_t i = 0; i < x->n && !bad && show == LOCATE_COLOURED; i++)
		paint_one(to->sh + 3 * (size_t)s->sh_coefficients * (size_t)x->ids[i], s->sh_coefficients);
	free(kept);
	return bad;
}
