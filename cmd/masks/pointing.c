#include "cmd/masks/pointing.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/masks.h"
#include "formats/scene/weights.h"
#include "propose/region_pick.h"

#include <math.h>

#define POINTING_SCALE 0.3333 /* of views that are rendered */

void pointing_free(struct pointing *p)
{
	for (size_t v = 0; v < p->scene.cameras.n && p->views; v++)
		free(p->views[v].nodes);
	weights_room_free(&p->room);
	regions_file_free(&p->regions);
	scene_free(&p->scene);
	mem_free_all(p->views, p->clicks, p->is_in, p->area);
}

int pointing_look(struct pointing *p, size_t at, struct err *e)
{
	const char *folder = p->weights ? p->weights : "";
	struct region_picture *l = &p->views[at];
	SCOPED char *path = file_join(folder, p->scene.cameras.views[at].name, ".safetensors", e);
	SCOPED_BY(weights_close) struct weights w = {0};

	if (!path || l->nodes)
		return path ? 0 : -1;
	if (!*folder || !file_exists(path))
		return region_picture_render(
			l, &p->regions.tree, &p->scene, &p->scene.cameras.views[at], POINTING_SCALE, e);
	if (weights_open_in(&w, &p->room, WEIGHTS_ROWS, folder, &p->scene, at, e))
		return -1;
	l->height = w.height;
	l->width = w.width;
	const struct view_weights rows = weights_view(&w);
	return region_picture_take(l, &p->regions.tree, &rows, e);
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
	return 1;
}

int pointing_click(struct pointing *p, size_t view, const double at[2], int is_outside, struct err *e)
{
	const struct region_picture *l = &p->views[view];

	if (pointing_look(p, view, e) || mem_grow((void **)&p->clicks, &p->click_room, p->click_count + 1,
						 sizeof *p->clicks, "places", e))
		return -1;
	if (!p->click_count)
		region_tree_areas(&p->regions.tree, l->nodes, (size_t)l->height * (size_t)l->width, p->area);
	const size_t x = (size_t)(at[0] * l->width), y = (size_t)(at[1] * l->height);
	p->clicks[p->click_count++] = (struct region_click){l->nodes[y * (size_t)l->width + x], is_outside};
	return 0;
}

static int take_clicks(
	struct pointing *p, const char *text, const char *option, int is_outside, struct err *e)
{
	size_t view = 0;
	double at[2];
	int got = 0;

	while (text && (got = take_place(p, &text, option, 2, &view, at, e)) > 0)
		if (pointing_click(p, view, at, is_outside, e))
			return -1;
	return got;
}

static int nothing_there(struct err *e)
{
	return err_set(e, ERR_CHECK, "no region is there");
}

int pointing_choose(struct pointing *p, int larger, struct err *e)
{
	const struct region_tree *t = &p->regions.tree;

	return region_pick(t, p->regions.score, p->area, p->clicks, p->click_count, larger, p->is_in)
		       ? 0
		       : nothing_there(e);
}

int pointing_choose_boxed(struct pointing *p, size_t view, const double box[4], struct err *e)
{
	const struct region_tree *t = &p->regions.tree;
	const struct region_picture *l = &p->views[view];
	SCOPED struct region_shown *shown = mem_alloc((size_t)t->n, sizeof *shown, "regions", e);

	if (!shown || pointing_look(p, view, e) ||
		region_tree_measure(t, l->nodes, l->height, l->width, shown, e))
		return -1;
	const double pixels[4] = {fmin(box[0], box[2]) * l->width, fmin(box[1], box[3]) * l->height,
		fmax(box[0], box[2]) * l->width, fmax(box[1], box[3]) * l->height};
	const int32_t node = region_pick_box(t, shown, pixels);
	memset(p->is_in, 0, (size_t)t->n);
	for (int32_t k = node; node >= 0 && k < t->end[node]; k++)
		p->is_in[k] = 1;
	return node >= 0 ? 0 : nothing_there(e);
}

static int choose_boxed(struct pointing *p, const char *text, struct err *e)
{
	const char *rest = text;
	size_t view = 0;
	double box[4];
	const int got = take_place(p, &rest, "--box", 4, &view, box, e);

	if (got < 0)
		return -1;
	if (!got || rest[strspn(rest, " ")])
		return err_set(e, ERR_USAGE, "--box: '%s' is not VIEW:x0,y0,x1,y1", text);
	return pointing_choose_boxed(p, view, box, e);
}

/* Places that the regions cannot tell apart. */
static void warn_of_clicks(const struct pointing *p, const struct report *to)
{
	size_t wrong = 0;

	for (size_t k = 0; k < p->click_count; k++)
		wrong += p->clicks[k].node >= 0 && p->is_in[p->clicks[k].node] == p->clicks[k].is_outside;
	if (wrong)
		report_warn(to,
			"%zu of %zu places are not as was asked: no small region has them without the others; --larger and --smaller choose another to begin with",
			wrong, p->click_count);
}

static int choose(
	struct pointing *p, const struct pointing_options *o, const struct report *to, struct err *e)
{
	if (o->box)
		return choose_boxed(p, o->box, e);
	if (take_clicks(p, o->points, "--point", 0, e) || take_clicks(p, o->outside, "--outside", 1, e))
		return -1;
	if (!p->click_count)
		return err_set(e, ERR_USAGE, "--point: '%s' is not VIEW:x,y", o->points);
	if (pointing_choose(p, (int)(o->larger - o->smaller), e))
		return -1;
	warn_of_clicks(p, to);
	return 0;
}

int pointing_mask(struct pointing *p, size_t view, struct rle *mask, size_t *area, struct err *e)
{
	*mask = (struct rle){0};
	if (pointing_look(p, view, e))
		return -1;
	const struct region_picture *l = &p->views[view];
	const size_t pixels = (size_t)l->height * (size_t)l->width;
	SCOPED uint8_t *is_on = mem_alloc(pixels, 1, "masks", e);
	*area = 0;
	for (size_t k = 0; k < pixels && is_on; k++)
		*area += is_on[k] = l->nodes[k] >= 0 && p->is_in[l->nodes[k]];
	return is_on ? rle_encode(mask, is_on, l->height, l->width, e) : -1;
}

static int put_all(struct pointing *p, const char *name, FILE *out, size_t *masks, struct err *e)
{
	size_t area;

	for (size_t at = 0; at < p->scene.cameras.n; at++) {
		struct mask m = {.view = p->scene.cameras.views[at].name,
			.object = name,
			.score = NAN,
			.visible = NAN};
		const int bad = pointing_mask(p, at, &m.rle, &area, e) || (area && masks_put(out, &m, e));
		rle_free(&m.rle);
		if (bad)
			return -1;
		*masks += area > 0;
	}
	return 0;
}

int pointing_open(
	struct pointing *p, const char *scene, const char *regions, const char *weights, struct err *e)
{
	p->weights = weights;
	if (scene_read(&p->scene, scene, e) || regions_file_read(&p->regions, regions, e) ||
		fingerprint_check("scene", regions, &p->regions.scene, scene, &p->scene.fingerprint, e))
		return -1;
	if (p->regions.tree.gaussians != p->scene.splats.n)
		return err_file(e, regions, "is of %zu Gaussians, but %s has %zu", p->regions.tree.gaussians,
			scene, p->scene.splats.n);
	p->views = mem_zalloc(p->scene.cameras.n, sizeof *p->views, "views", e);
	p->is_in = mem_zalloc((size_t)p->regions.tree.n, 1, "regions", e);
	p->area = mem_zalloc((size_t)p->regions.tree.n, sizeof *p->area, "regions", e);
	return p->views && p->is_in && p->area ? 0 : -1;
}

int pointing_write(
	struct pointing *p, const struct pointing_options *options, const struct report *to, struct err *e)
{
	struct file_out out;
	size_t masks = 0;

	if (pointing_open(p, options->scene, options->tree, options->weights, e) ||
		choose(p, options, to, e) || file_out_open(&out, options->output, e))
		return -1;
	const int bad = file_out_end(&out, put_all(p, options->name, out.stream, &masks, e), e);
	report_note(to, 1, "%zu masks", masks);
	return bad;
}
