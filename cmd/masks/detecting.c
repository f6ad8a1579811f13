#include "cmd/masks/detecting.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/import/warping.h"
#include "formats/encoders/nanodet_model.h"
#include "formats/images/png.h"
#include "formats/records/detections.h"
#include "formats/scene/scene.h"
#include "geom/views.h"

#include <math.h>

/* Boxes of one class that share more than this are of one thing: NanoDet's own. */
static const double same_thing = 0.6;

/* The network and what it works in. */
struct detector {
	struct nanodet net;
	float *in, *out, *scratch;
	struct nanodet_boxes boxes;
};

static int open_detector(struct detector *y, const char *model, struct err *e)
{
	if (nanodet_model_read(&y->net, model, e))
		return -1;
	y->in = mem_alloc(3 * NANODET_SIDE * NANODET_SIDE, sizeof *y->in, "picture", e);
	y->out = mem_alloc(NANODET_CELLS * NANODET_OUT, sizeof *y->out, "boxes", e);
	y->scratch = mem_alloc(nanodet_scratch(&y->net), sizeof *y->scratch, "detector", e);
	return y->in && y->out && y->scratch ? 0 : -1;
}

static void close_detector(struct detector *y)
{
	nanodet_free(&y->net);
	mem_free_all(y->in, y->out, y->scratch, y->boxes.items);
}

static int detect_window(struct detector *y, const uint8_t *rgb, int width, const struct nanodet_window *w,
	float score, struct err *e)
{
	if (nanodet_picture(y->in, rgb, width, w, e))
		return -1;
	nanodet_forward(&y->net, y->out, y->in, y->scratch);
	return nanodet_add(&y->boxes, y->out, w, score, e);
}

/* Leaves out the boxes from `first` on that end at an edge of the window within the picture, to a pixel of
 * the network: they are of things that the edge cuts. */
static void drop_cut(
	struct nanodet_boxes *b, size_t first, const struct nanodet_window *w, int height, int width)
{
	const float across = (float)w->width / NANODET_SIDE, down = (float)w->height / NANODET_SIDE;
	const float least[2] = {w->left ? (float)w->left + across : -1, w->top ? (float)w->top + down : -1};
	const int right = w->left + w->width, bottom = w->top + w->height;
	const float most[2] = {
		(float)right + (right < width ? -across : 1), (float)bottom + (bottom < height ? -down : 1)};
	size_t n = first;

	for (size_t i = first; i < b->n; i++) {
		const float *side = b->items[i].side;
		if (side[0] > least[0] && side[1] > least[1] && side[2] < most[0] && side[3] < most[1])
			b->items[n++] = b->items[i];
	}
	b->n = n;
}

/* Six parts that overlap by half, three along the longer side. */
static int detect_parts(
	struct detector *y, const uint8_t *rgb, int height, int width, float score, struct err *e)
{
	const int across = width >= height ? 3 : 2, down = 5 - across;
	struct nanodet_window w = {
		.width = (2 * width + across) / (across + 1), .height = (2 * height + down) / (down + 1)};

	for (int i = 0; i < across * down; i++) {
		w.left = (int)((int64_t)(width - w.width) * (i % across) / (across - 1));
		w.top = (int)((int64_t)(height - w.height) * (i / across) / (down - 1));
		const size_t first = y->boxes.n;
		if (detect_window(y, rgb, width, &w, score, e))
			return -1;
		drop_cut(&y->boxes, first, &w, height, width);
	}
	return 0;
}

static int put_boxes(struct detector *y, const char *view, int height, int width, FILE *out, struct err *e)
{
	nanodet_thin(&y->boxes, same_thing);
	for (size_t i = 0; i < y->boxes.n; i++) {
		const struct nanodet_box *b = &y->boxes.items[i];
		struct detection d = {.view = view,
			.name = nanodet_classes[b->label],
			.score = round(1e4 * b->score) / 1e4,
			.height = height,
			.width = width};
		for (int k = 0; k < 4; k++)
			d.box[k] = round(100.0 * b->side[k]) / 100;
		if (d.box[0] < d.box[2] && d.box[1] < d.box[3] && detections_put(out, &d, e))
			return -1;
	}
	return 0;
}

/* Views of these names, whose images are the photographs' paths. */
static int name_pictures(struct cameras *c, const struct detecting *d, struct err *e)
{
	SCOPED char **names = mem_zalloc(d->count, sizeof *names, "pictures", e);
	int bad = !names || !(c->views = mem_zalloc(d->count, sizeof *c->views, "pictures", e)) ||
		  views_name(d->pictures, d->count, names, "the pictures", e);

	for (; c->n < d->count && !bad; c->n++)
		c->views[c->n].name = names[c->n];
	for (size_t i = 0; i < c->n && !bad; i++)
		bad = !(c->views[i].image = mem_strdup(d->pictures[i], e));
	return -bad;
}

/* What is looked at: views with a photograph each. */
static int find_photographs(
	struct cameras *c, const struct detecting *d, const struct report *to, struct err *e)
{
	SCOPED char *path = d->scene ? file_join(d->scene, "cameras.json", "", e) : NULL;
	size_t without = 0;

	if (!d->scene)
		return name_pictures(c, d, e);
	if (!path || scene_read_cameras_file(c, path, e))
		return -1;
	for (size_t i = 0; i < c->n; i++)
		without += !c->views[i].image;
	if (without == c->n)
		return err_file(
			e, path, "no view has a photograph: give 'gs-import --images DIR' their folder");
	if (without)
		report_warn(to, "%s: %zu of %zu views have no photograph", path, without, c->n);
	return 0;
}

static int detect_in(
	struct detector *y, const struct camera *c, const struct detecting *d, FILE *out, struct err *e)
{
	SCOPED uint8_t *rgb = NULL;
	int height, width;
	const int bad = d->scene ? warping_read_photograph(c, d->scene, 0, &rgb, &height, &width, e)
				 : image_read_rgb(c->image, &rgb, &height, &width, e);

	if (bad)
		return -1;
	const struct nanodet_window whole = {0, 0, width, height};
	y->boxes.n = 0;
	return -(detect_window(y, rgb, width, &whole, (float)d->score, e) ||
		 (d->crops && detect_parts(y, rgb, height, width, (float)d->score, e)) ||
		 put_boxes(y, c->name, height, width, out, e));
}

int detect(const struct detecting *d, const struct report *to, struct err *e)
{
	SCOPED_BY(cameras_free) struct cameras c = {0};
	SCOPED_BY(close_detector) struct detector y = {0};
	struct file_out out;

	if (find_photographs(&c, d, to, e) || open_detector(&y, d->model, e) ||
		file_out_open(&out, d->output, e))
		return -1;
	int bad = 0;
	report_start(to, "photographs", (double)c.n);
	for (size_t i = 0; i < c.n && !bad; i++) {
		bad = c.views[i].image && detect_in(&y, &c.views[i], d, out.stream, e);
		report_step(to, (double)i + 1, NULL);
	}
	report_end(to);
	return file_out_end(&out, bad, e);
}
