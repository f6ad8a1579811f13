#include "cmd/masks/pointing.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/masks.h"
#include "formats/scene/weights.h"
#include "propose/region_pick.h"
#include "splat/render.h"

#include <math.h>

#define POINTING_SCALE 0.3333 /* of views that are rendered */

void pointing_free(struct pointing *p)
{
	for (size_t v = 0; v < p->scene.cameras.n && p->views; v++)
		free(p->views[v].nodes);
	weights_room_free(&p->room);
	regions_file_free(&p->regions);
	scene_free(&p->scene);
	mem_free_all(p->views, p->clicks, p->is_in);
}

static int find_nodes(
	const struct pointing *p, struct pointing_view *l, const struct view_weights *w, struct err *e)
{
	l->nodes = mem_alloc(w->pixels, sizeof *l->nodes, "regions", e);
	return l->nodes ? region_tree_pixels(&p->regions.tree, w, l->nodes, e) : -1;
}

static int render(const struct pointing *p, size_t at, struct err *e)
{
	const struct camera *c = &p->scene.cameras.views[at];
	struct pointing_view *l = &p->views[at];
	SCOPED_BY(render_weights_free) struct render_weights w = {0};

	camera_scaled_size(c, POINTING_SCALE, &l->width, &l->height);
	const struct camera small = camera_resize(c, l->width, l->height);
	struct render_view *view = render_prepare(&p->scene.splats, &small, e);
	const int bad = !view || render_weights(view, &w, e);
	render_free(view);
	const struct view_weights rows = {
		(size_t)l->height * (size_t)l->width, p->scene.splats.n, w.indptr, w.index, w.weight};
	return bad ? -1 : find_nodes(p, l, &rows, e);
}

/* The nodes of a view, once. */
static int look(struct pointing *p, size_t at, struct err *e)
{
	const char *folder = p->options->weights ? p->options->weights : "";
	struct pointing_view *l = &p->views[at];
	SCOPED char *path = file_join(folder, p->scene.cameras.views[at].name, ".safetensors", e);
	SCOPED_BY(weights_close) struct weights w = {0};

	if (!path || l->nodes)
		return path ? 0 : -1;
	if (!*folder || !file_exists(path))
		return render(p, at, e);
	if (weights_open_in(&w, &p->room, WEIGHTS_ROWS, folder, &p->scene, at, e))
		return -1;
	l->height = w.height;
	l->width = w.width;
	const struct view_weights rows = weights_view(&w);
	return find_nodes(p, l, &rows, e);
}

/* The next of "VIEW:x,y VIEW:x,y", with so many numbers, in shares of the view: 1, 0 at the end, -1 with *e.
 */
static int take_place(struct pointing *p, const char **rest, const char *option, int count, size_t *view,
	double *at, struct err *e)
{
	const struct cameras *c = &p->scene.cameras;
	const char *from = *rest + strspn(*rest, " ");
	const size_t length = strcspn(from, " ");
	SCOPED char *text = mem_alloc(length + 1, 1, "places", e);

	*rest = from + length;
	if (!text || !length)
		return text ? 0 : -1;
	memcpy(text, from, length);
	text[length] = 0;
	char *end = strrchr(text, ':');
	for (int k = 0; k < count && end; k++) {
		char *number = end + 1;
		at[k] = strtod(number, &end);
		if (end == number || *end != (k + 1 < count ? ',' : 0))
			end = NULL;
	}
	if (!end)
		return err_set(e, ERR_USAGE, "%s: '%s' is not VIEW:%s", option, text,
			count == 2 ? "x,y" : "x0,y0,x1,y1");
	*strrchr(text, ':') = 0;
	for (*view = 0; *view < c->n && strcmp(c->views[*view].name, text) != 0;)
		++*view;
	if (*view == c->n)
		return err_set(e, ERR_USAGE, "%s: no view '%s'", option, text);
	for (int k = 0; k < count; k++) {
		const int size = k % 2 ? c->views[*view].height : c->views[*view].width;
		if (!(at[k] >= 0 && (count == 2 ? at[k] < size : at[k] <= size)))
			return err_set(e, ERR_USAGE, "%s: %g is outside of view '%s', which is %dx%d", option,
				at[k], text, c->views[*view].width, c->views[*view].height);
		at[k] /= size;
	}
	return look(p, *view, e) ? -1 : 1;
}

static int take_clicks(
	struct pointing *p, const char *text, const char *option, int is_outside, struct err *e)
{
	size_t view = 0;
	double at[2];
	int got = 0;

	while (text && (got = take_place(p, &text, option, 2, &view, at, e)) > 0) {
		const struct pointing_view *l = &p->views[view];
		const size_t x = (size_t)(at[0] * l->width), y = (size_t)(at[1] * l->height);
		if (mem_grow((void **)&p->clicks, &p->click_room, p->click_count + 1, sizeof *p->clicks,
			    "places", e))
			return -1;
		p->clicks[p->click_count++] =
			(struct region_click){l->nodes[y * (size_t)l->width + x], is_outside};
	}
	return got;
}

/* *node: the region whose box is nearest to the given one, -1 for none. */
static int find_boxed(struct pointing *p, int32_t *node, struct err *e)
{
	const char *text = p->options->box;
	SCOPED struct region_shown *shown = mem_alloc((size_t)p->regions.tree.n, sizeof *shown, "regions", e);
	size_t view = 0;
	double at[4];
	const int got = shown ? take_place(p, &text, "--box", 4, &view, at, e) : -1;

	if (got < 0)
		return -1;
	if (!got || text[strspn(text, " ")])
		return err_set(e, ERR_USAGE, "--box: '%s' is not VIEW:x0,y0,x1,y1", p->options->box);
	const struct pointing_view *l = &p->views[view];
	const double box[4] = {fmin(at[0], at[2]) * l->width, fmin(at[1], at[3]) * l->height,
		fmax(at[0], at[2]) * l->width, fmax(at[1], at[3]) * l->height};
	if (region_tree_measure(&p->regions.tree, l->nodes, l->height, l->width, shown, e))
		return -1;
	*node = region_pick_box(&p->regions.tree, shown, box);
	return 0;
}

/* What is meant: p->is_in. ERR_CHECK where nothing is. */
static int find_meant(struct pointing *p, struct err *e)
{
	const struct pointing_options *o = p->options;
	const struct region_tree *t = &p->regions.tree;
	int32_t boxed = -1, count = 0;

	p->is_in = mem_zalloc((size_t)t->n, 1, "regions", e);
	if (!p->is_in)
		return -1;
	if (o->box) {
		if (find_boxed(p, &boxed, e))
			return -1;
		for (int32_t k = boxed; boxed >= 0 && k < t->end[boxed]; k++)
			p->is_in[k] = 1;
		count = boxed >= 0;
	} else {
		if (take_clicks(p, o->points, "--point", 0, e) ||
			take_clicks(p, o->outside, "--outside", 1, e))
			return -1;
		if (!p->click_count)
			return err_set(e, ERR_USAGE, "--point: '%s' is not VIEW:x,y", o->points);
		count = region_pick(t, p->regions.score, p->clicks, p->click_count,
			(int)(o->larger - o->smaller), p->is_in);
	}
	return count ? 0
		     : err_set(e, ERR_CHECK,
			       "no region is there, or each that is has a place of --outside too");
}

static int put_view(struct pointing *p, size_t at, FILE *out, struct err *e)
{
	struct mask m = {.view = p->scene.cameras.views[at].name,
		.object = p->options->name,
		.score = NAN,
		.visible = NAN};
	size_t area = 0;

	if (look(p, at, e))
		return -1;
	const struct pointing_view *l = &p->views[at];
	const size_t pixels = (size_t)l->height * (size_t)l->width;
	SCOPED uint8_t *mask = mem_alloc(pixels, 1, "masks", e);
	for (size_t k = 0; k < pixels && mask; k++)
		area += mask[k] = l->nodes[k] >= 0 && p->is_in[l->nodes[k]];
	if (!mask || !area)
		return mask ? 0 : -1;
	p->masks++;
	const int bad = rle_encode(&m.rle, mask, l->height, l->width, e) || masks_put(out, &m, e);
	rle_free(&m.rle);
	return bad ? -1 : 0;
}

static int put_all(struct pointing *p, FILE *out, struct err *e)
{
	for (size_t at = 0; at < p->scene.cameras.n; at++)
		if (put_view(p, at, out, e))
			return -1;
	return 0;
}

int pointing_write(
	struct pointing *p, const struct pointing_options *options, const struct report *to, struct err *e)
{
	struct file_out out;

	p->options = options;
	if (scene_read(&p->scene, options->scene, e) || regions_file_read(&p->regions, options->tree, e) ||
		fingerprint_check(
			"scene", options->tree, &p->regions.scene, options->scene, &p->scene.fingerprint, e))
		return -1;
	if (p->regions.tree.gaussians != p->scene.splats.n)
		return err_file(e, options->tree, "is of %zu Gaussians, but %s has %zu",
			p->regions.tree.gaussians, options->scene, p->scene.splats.n);
	p->views = mem_zalloc(p->scene.cameras.n, sizeof *p->views, "views", e);
	if (!p->views || find_meant(p, e) || file_out_open(&out, options->output, e))
		return -1;
	const int bad = file_out_end(&out, put_all(p, out.stream, e), e);
	report_note(to, 1, "%zu masks", p->masks);
	return bad;
}
