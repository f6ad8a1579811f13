#include "cmd/report/report_views.h"

#include "base/base64.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/images/jpeg.h"
#include "cmd/import/warping.h"
#include "formats/images/png.h"
#include "mask/shrink.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>

enum { QUALITY = 78 };

struct picture_rgb {
	int height, width;
	uint8_t *rgb;
};

static int shrink(struct picture_rgb *p, int height, int width, struct err *e)
{
	uint8_t *to = shrink_picture(p->rgb, p->height, p->width, height, width, e);

	free(p->rgb);
	*p = (struct picture_rgb){height, width, to};
	return to ? 0 : -1;
}

/* 1 where the view has a photograph that can be read. */
static int read_photograph(const struct report_run *r, const struct camera *c, struct picture_rgb *p,
	const struct report *to, struct err *e)
{
	char *path = c->image ? file_join(r->scene.path, c->image, "", e) : NULL;
	int found = 0;

	if (path && file_exists(path)) {
		found = !warping_read_photograph(c, r->scene.path, 0, &p->rgb, &p->height, &p->width, e);
		if (!found)
			report_warn(to, "%s; the view is rendered instead", e->message);
	}
	free(path);
	return found;
}

static int render(const struct report_run *r, const struct camera *c, struct picture_rgb *p, struct err *e)
{
	const size_t n = 3 * (size_t)c->height * (size_t)c->width;
	struct render_view *v = render_prepare(&r->scene.splats, c, e);
	float *rgb = mem_alloc(n, sizeof *rgb, "picture", e);
	const float black[3] = {0};

	p->rgb = mem_alloc(n, 1, "picture", e);
	p->height = c->height;
	p->width = c->width;
	const int bad = !v || !rgb || !p->rgb || render_colors(v, &r->scene.splats, c, black, rgb, e);
	for (size_t i = 0; i < n && !bad; i++)
		p->rgb[i] = (uint8_t)lrintf(255 * rgb[i]);
	free(rgb);
	render_free(v);
	return bad ? -1 : 0;
}

static char *picture_text(const struct picture_rgb *p, const char *name, struct err *e)
{
	uint8_t *bytes;
	size_t n;

	if (jpeg_encode(name, p->rgb, p->height, p->width, QUALITY, &bytes, &n, e))
		return NULL;
	char *text = base64_text("data:image/jpeg;base64,", bytes, n, e);
	free(bytes);
	return text;
}

static cJSON *view_of(
	const struct report_run *r, const struct camera *c, const struct report *to, struct err *e)
{
	struct picture_rgb p = {0};
	const int is_photograph = read_photograph(r, c, &p, to, e);
	const int bad = is_photograph ? shrink(&p, c->height, c->width, e) : render(r, c, &p, e);
	char *text = bad ? NULL : picture_text(&p, c->name, e);
	cJSON *view = cJSON_CreateObject();

	free(p.rgb);
	int fine = text && cJSON_AddStringToObject(view, "name", c->name) &&
		   cJSON_AddStringToObject(view, "split", c->split == SPLIT_TEST ? "test" : "train") &&
		   cJSON_AddNumberToObject(view, "width", c->width) &&
		   cJSON_AddNumberToObject(view, "height", c->height) &&
		   cJSON_AddBoolToObject(view, "photograph", is_photograph) &&
		   cJSON_AddStringToObject(view, "picture", text);
	if (text && !fine)
		err_set(e, ERR_SYSTEM, "page: out of memory");
	free(text);
	if (fine)
		return view;
	cJSON_Delete(view);
	return NULL;
}

cJSON *report_views(const struct report_run *r, const struct report *to, struct err *e)
{
	cJSON *list = cJSON_CreateArray();

	report_start(to, "pictures", (double)r->shown_count);
	for (size_t v = 0; v < r->shown_count; v++) {
		cJSON *view = view_of(r, &r->shown[v], to, e);
		if (!view || !cJSON_AddItemToArray(list, view)) {
			cJSON_Delete(list);
			return NULL;
		}
		report_step(to, (double)v + 1, NULL);
	}
	report_end(to);
	return list;
}
