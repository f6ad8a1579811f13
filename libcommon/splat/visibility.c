#include "splat/visibility.h"

#include "base/mem.h"
#include "splat/render.h"

#include <math.h>

/* most (N): the largest weight of each Gaussian at any pixel, so far. */
static int look(struct render_view **v, struct render_weights *w, const struct splats *s,
	const struct camera *c, float *most, struct err *e)
{
	if (*v ? render_again(*v, s, c, e) : !(*v = render_prepare(s, c, e)))
		return -1;
	if (render_weights_again(*v, w, e))
		return -1;
	for (int64_t k = 0, end = w->indptr[(size_t)c->width * (size_t)c->height]; k < end; k++)
		most[w->index[k]] = fmaxf(most[w->index[k]], w->weight[k]);
	return 0;
}

int visibility_most(const struct splats *s, const struct cameras *cameras, float *most, struct err *e)
{
	SCOPED_BY(render_release) struct render_view *v = NULL;
	SCOPED_BY(render_weights_free) struct render_weights w = {0};
	struct camera views[VISIBILITY_VIEWS];
	const size_t n = cameras_spread(cameras, VISIBILITY_VIEWS, VISIBILITY_SIDE, views);

	for (size_t i = 0; i < s->n; i++)
		most[i] = n ? 0 : 1;
	for (size_t i = 0; i < n; i++)
		if (look(&v, &w, s, &views[i], most, e))
			return -1;
	return 0;
}

int visibility_find(const struct splats *s, const struct cameras *cameras, char *in_sight, struct err *e)
{
	SCOPED float *most = mem_alloc(s->n, sizeof *most, "weights", e);
	const int bad = !most || visibility_most(s, cameras, most, e);

	for (size_t i = 0; i < s->n && !bad; i++)
		in_sight[i] = most[i] > 0 && most[i] >= VISIBILITY_LEAST * s->opacities[i];
	return bad ? -1 : 0;
}
