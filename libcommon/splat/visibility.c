#include "splat/visibility.h"

#include "base/mem.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct camera reduce(const struct camera *c)
{
	const int side = c->width > c->height ? c->width : c->height;
	int width, height;

	camera_scaled_size(c, fmin(1, (double)VISIBILITY_SIDE / side), &width, &height);
	return camera_resize(c, width, height);
}

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

int visibility_find(const struct splats *s, const struct cameras *cameras, char *in_sight, struct err *e)
{
	struct render_view *v = NULL;
	struct render_weights w = {0};
	size_t all = 0, at = 0, taken = 0;
	float *most = mem_zalloc(s->n, sizeof *most, "weights", e);
	int bad = most ? 0 : -1;

	for (size_t i = 0; i < cameras->n; i++)
		all += cameras->views[i].split == SPLIT_TRAIN;
	const int any = !all;
	if (any)
		all = cameras->n;
	const size_t take = all < VISIBILITY_VIEWS ? all : VISIBILITY_VIEWS;
	for (size_t i = 0; i < cameras->n && !bad; i++) {
		if (!any && cameras->views[i].split != SPLIT_TRAIN)
			continue;
		if (taken == take || at++ != taken * all / take)
			continue;
		const struct camera c = reduce(&cameras->views[i]);
		bad = look(&v, &w, s, &c, most, e);
		taken++;
	}
	for (size_t i = 0; i < s->n && !bad; i++)
		in_sight[i] = !take || (most[i] > 0 && most[i] >= VISIBILITY_LEAST * s->opacities[i]);
	render_weights_free(&w);
	render_free(v);
	free(most);
	return bad;
}
