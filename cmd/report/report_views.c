#include "cmd/report/reporting.h"

#include "base/base64.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/images/jpeg.h"
#include "cmd/import/warping.h"
#include "mask/shrink.h"
#include "splat/render.h"

#include <math.h>

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
	SCOPED char *path = c->image ? file_join(r->scene.path, c->image, "", e) : NULL;
	int found = 0;

	if (path && file_exists(path)) {
		found = !warping_read_photograph(c, r->scene.path, 0, &p->rgb, &p->height, &p->width, e);
		if (!found)
			report_warn(to, "%s; the view is rendered instead", e->message);
	}
	return found;
}

static int render(const struct report_run *r, const struct camera *c, struct picture_rgb *p, struct err *e)
{
	const size_t n = 3 * (size_t)c->height * (size_t)c->width;
	SCOPED_BY(render_release) struct render_view *v = render_prepare(&r->scene.splats, c, e);
	SCOPED float *rgb = mem_alloc(n, sizeof *rgb, "picture", e);
	const float black[3] = {0};

	p->rgb = mem_alloc(n, 1, "picture", e);
	p->height = c->height;
	p->width = c->width;
	if (!v || !rgb || !p->rgb || render_colors(v, &r->scene.splats, c, black, rgb, e))
		return -1;
	for (size_t i = 0; i < n; i++)
		p->rgb[i] = (uint8_t)lrintf(255 * rgb[i]);
	return 0;
}

static char *picture_text(const struct picture_rgb *p, const char *name, struct err *e)
{
	SCOPED uint8_t *bytes = NULL;
	size_t n;

	if (jpeg_encode(name, p->rgb, p->height, p->width, QUALITY, &bytes, &n, e))
		return NULL;
	char *text = base64_text("data:image/jpeg;base64,", bytes, n, e);
	return text;
}

static int put_view(struct jsontext *to, const struct report_run *r, const struct camera *c,
	const struct report *told, struct err *e)
{
	struct picture_rgb p = {0};
	const int is_photograph = read_photograph(r, c, &p, told, e);
	const int bad = is_photograph ? shrink(&p, c->height, c->width, e) : render(r, c, &p, e);
	SCOPED char *text = bad ? NULL : picture_text(&p, c->name, e);

	free(p.rgb);
	if (!text)
		return -1;
	jsontext_open(to, NULL, '{');
	jsontext_string(to, "name", c->name);
	jsontext_string(to, "split", c->split == SPLIT_TEST ? "test" : "train");
	jsontext_number(to, "width", c->width);
	jsontext_number(to, "height", c->height);
	jsontext_flag(to, "photograph", is_photograph);
	jsontext_string(to, "picture", text);
	jsontext_close(to, '}');
	return 0;
}

int report_views(struct jsontext *to, const struct report_run *r, const struct report *told, struct err *e)
{
	jsontext_open(to, "views", '[');
	report_start(told, "pictures", (double)r->shown_count);
	for (size_t v = 0; v < r->shown_count; v++) {
		if (put_view(to, r, &r->shown[v], told, e))
			return -1;
		report_step(told, (double)v + 1, NULL);
	}
	report_end(told);
	jsontext_close(to, ']');
	return 0;
}
