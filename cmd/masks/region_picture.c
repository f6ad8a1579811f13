#include "cmd/masks/region_picture.h"

#include "base/mem.h"
#include "splat/render.h"

int region_picture_take(
	struct region_picture *p, const struct region_tree *t, const struct view_weights *rows, struct err *e)
{
	p->nodes = mem_alloc(rows->pixels, sizeof *p->nodes, "regions", e);
	return p->nodes ? region_tree_pixels(t, rows, p->nodes, e) : -1;
}

int region_picture_render(struct region_picture *p, const struct region_tree *t, const struct scene *scene,
	const struct camera *camera, double scale, struct err *e)
{
	SCOPED_BY(render_weights_free) struct render_weights w = {0};

	camera_scaled_size(camera, scale, &p->width, &p->height);
	const struct camera small = camera_resize(camera, p->width, p->height);
	struct render_view *view = scene_prepare(scene, &small, e);
	const int bad = !view || render_weights(view, &w, e);
	render_free(view);
	const struct view_weights rows = {
		(size_t)p->height * (size_t)p->width, scene->splats.n, w.indptr, w.index, w.weight};
	return bad ? -1 : region_picture_take(p, t, &rows, e);
}
