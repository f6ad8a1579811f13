/* What a label means: regions that clicks or a box point at, or an outline. */
#include "cmd/serve/serving.h"

#include "base/mem.h"
#include "formats/records/json.h"
#include "mask/polygon.h"

#include <math.h>

enum { OUTLINE_POINTS = 20000, CLICKS = 1000 };
#define OUTLINE_SCALE 0.5 /* of the view: no weights are finer */

int serving_faulty(struct err *e, const char *key, const char *why)
{
	return err_set(e, ERR_FORMAT, "request: key '%s' %s", key, why);
}

/* One of "points" or "outside". */
static int take_click(
	struct serving *s, const cJSON *click, const char *key, struct serving_label *l, struct err *e)
{
	double at[2];
	size_t view;

	if (!cJSON_IsObject(click))
		return serving_faulty(e, key, "is no list of {\"view\",\"x\",\"y\"}");
	if (serving_view(s, click, "view", &view, e) || json_number(click, "x", 1, at, "request", e) < 0 ||
		json_number(click, "y", 1, at + 1, "request", e) < 0)
		return -1;
	const struct camera *c = &s->cameras.views[view];
	if (!(at[0] >= 0 && at[1] >= 0 && at[0] < c->width && at[1] < c->height))
		return err_set(e, ERR_FORMAT,
			"request: key '%s': %g, %g is outside of view '%s', which is %dx%d", key, at[0],
			at[1], c->name, c->width, c->height);
	if (!s->pointing.click_count)
		l->view = view;
	at[0] /= c->width;
	at[1] /= c->height;
	return pointing_click(&s->pointing, view, at, !strcmp(key, "outside"), e);
}

static int take_clicks(
	struct serving *s, const cJSON *body, const char *key, struct serving_label *l, struct err *e)
{
	const cJSON *list = json_member(body, key), *click;

	if (list && (!cJSON_IsArray(list) || cJSON_GetArraySize(list) > CLICKS))
		return serving_faulty(e, key, "is no list of at most 1000 places");
	cJSON_ArrayForEach(click, list)
	{
		if (take_click(s, click, key, l, e))
			return -1;
	}
	return 0;
}

static int take_box(struct serving *s, const cJSON *box, struct serving_label *l, struct err *e)
{
	double at[4];

	if (serving_view(s, box, "view", &l->view, e) || json_matrix(box, "box", 4, 0, at, "request", e))
		return -1;
	for (int k = 0; k < 4; k++)
		at[k] /= k % 2 ? s->cameras.views[l->view].height : s->cameras.views[l->view].width;
	return pointing_choose_boxed(&s->pointing, l->view, at, e);
}

static int take_outline(struct serving *s, const cJSON *outline, struct serving_label *l, struct err *e)
{
	const cJSON *points = json_member(outline, "points"), *point;
	const int n = cJSON_GetArraySize(points);
	int height, width;
	size_t k = 0;

	if (serving_view(s, outline, "view", &l->view, e))
		return -1;
	if (!cJSON_IsArray(points) || n < 3 || n > OUTLINE_POINTS)
		return serving_faulty(e, "points", "is no list of 3 to 20000 [x,y]");
	const struct camera *c = &s->cameras.views[l->view];
	camera_scaled_size(c, OUTLINE_SCALE, &width, &height);
	const size_t pixels = (size_t)height * (size_t)width;
	SCOPED double *x = mem_alloc((size_t)n, 2 * sizeof *x, "outline", e);
	SCOPED uint8_t *mask = mem_zalloc(pixels, 1, "outline", e),
		       *flips = mem_zalloc(pixels, 1, "outline", e);
	if (!x || !mask || !flips)
		return -1;
	cJSON_ArrayForEach(point, points)
	{
		if (json_numbers(point, 2, x + k))
			return serving_faulty(e, "points", "is no list of 3 to 20000 [x,y]");
		x[k] = fmin(fmax(x[k], -1e6), 1e6) * width / c->width;
		x[k + 1] = fmin(fmax(x[k + 1], -1e6), 1e6) * height / c->height;
		k += 2;
	}
	polygon_fill(mask, flips, height, width, x, (size_t)n);
	if (!memchr(mask, 1, pixels))
		return serving_faulty(e, "points", "go around no pixel of the view");
	return rle_encode(&l->outline, mask, height, width, e);
}

/* What is meant: the outline, or s->pointing's regions. */
int serving_take_place(struct serving *s, const cJSON *body, struct serving_label *l, struct err *e)
{
	const cJSON *box = json_member(body, "box"), *outline = json_member(body, "outline");
	double size = 0;

	if (!s->weights)
		return err_set(e, ERR_CHECK,
			"%s: no weights in it, which labels need: 'make -f pipelines/lift.mk regions SCENE=%s ...' makes them",
			s->options->run, s->options->run);
	if (outline)
		return take_outline(s, outline, l, e);
	if (!s->can_click)
		return err_set(e, ERR_CHECK,
			"%s: no regions in it, which clicks need: 'make -f pipelines/lift.mk regions SCENE=%s ...' finds them; an outline needs none",
			s->options->run, s->options->run);
	s->pointing.click_count = 0;
	if (box)
		return take_box(s, box, l, e);
	if (take_clicks(s, body, "points", l, e) || take_clicks(s, body, "outside", l, e) ||
		json_number(body, "size", 0, &size, "request", e) < 0)
		return -1;
	if (!s->pointing.click_count)
		return serving_faulty(
			e, "points", "is missing: points, a box or an outline say what is meant");
	return pointing_choose(&s->pointing, (int)fmin(fmax(size, -CLICKS), CLICKS), e);
}

/* *area 0 where the view shows nothing of it. */
int serving_find_mask(struct serving *s, const struct serving_label *l, size_t view, struct rle *mask,
	size_t *area, struct err *e)
{
	*mask = (struct rle){0};
	*area = 0;
	if (!l->outline.runs)
		return pointing_mask(&s->pointing, view, mask, area, e);
	if (view != l->view)
		return 0;
	*area = rle_area(&l->outline);
	return rle_from_runs(mask, l->outline.runs, l->outline.n, l->outline.height, l->outline.width, e);
}

static int put_preview(
	struct serving *s, const struct serving_label *l, struct jsontext *to, size_t view, struct err *e)
{
	SCOPED_BY(rle_free) struct rle mask = {0};
	size_t area;

	if (serving_find_mask(s, l, view, &mask, &area, e))
		return -1;
	if (area)
		serving_put_mask(to, s->cameras.views[view].name, &mask);
	return 0;
}

int serving_preview(struct serving *s, const struct serving_label *l, struct serving_reply *to, struct err *e)
{
	struct serving_text text;
	const cJSON *name;
	int bad = 0;

	if (serving_text_open(&text, e))
		return -1;
	struct jsontext json = {.out = text.out};
	jsontext_open(&json, NULL, '{');
	jsontext_open(&json, "masks", '[');
	if (!l->views)
		bad = put_preview(s, l, &json, l->view, e);
	cJSON_ArrayForEach(name, l->views)
	{
		for (size_t v = 0; v < s->cameras.n && !bad; v++)
			if (json_is(name, s->cameras.views[v].name))
				bad = put_preview(s, l, &json, v, e);
	}
	jsontext_close(&json, ']');
	jsontext_close(&json, '}');
	fputc('\n', text.out);
	return serving_text_end(&text, bad, to, e);
}
