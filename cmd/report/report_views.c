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

int report_photograph(const char *folder, const struct camera *c, uint8_t **bytes, size_t *n,
	const struct report *to, struct err *e)
{
	SCOPED char *path = c->image ? file_join(folder, c->image, "", e) : NULL;
	SCOPED uint8_t *whole = NULL;
	int height, width;

	if (!path || !file_exists(path))
		return 0;
	if (warping_read_photograph(c, folder, 0, &whole, &height, &width, e)) {
		report_warn(to, "%s; the view is rendered instead", e->message);
		return 0;
	}
	SCOPED uint8_t *rgb = shrink_picture(whole, height, width, c->height, c->width, e);
	return !rgb || jpeg_encode(c->name, rgb, c->height, c->width, QUALITY, bytes, n, e) ? -1 : 1;
}

int report_rendering(const struct scene *s, const struct camera *c, uint8_t **bytes, size_t *n, struct err *e)
{
	const size_t values = 3 * (size_t)c->height * (size_t)c->width;
	SCOPED float *rgb = mem_alloc(values, sizeof *rgb, "picture", e);
	SCOPED uint8_t *bits = mem_alloc(values, 1, "picture", e);
	const float black[3] = {0};
	struct splats shown;

	if (!rgb || !bits || scene_splats_shown(&shown, s, c, e))
		return -1;
	struct render_view *v = render_prepare(&shown, c, e);
	const int bad = !v || render_colors(v, &shown, c, black, rgb, e);
	render_free(v);
	scene_splats_release(&shown, s);
	if (bad)
		return -1;
	for (size_t i = 0; i < values; i++)
		bits[i] = (uint8_t)lrintf(255 * rgb[i]);
	return jpeg_encode(c->name, bits, c->height, c->width, QUALITY, bytes, n, e);
}

static int put_view(struct jsontext *to, const struct report_run *r, const struct camera *c,
	const struct report *told, struct err *e)
{
	SCOPED uint8_t *bytes = NULL;
	size_t n;
	const int is_photograph = report_photograph(r->scene.path, c, &bytes, &n, told, e);
	const int bad =
		is_photograph < 0 || (!is_photograph && report_rendering(&r->scene, c, &bytes, &n, e));
	SCOPED char *text = bad ? NULL : base64_text("data:image/jpeg;base64,", bytes, n, e);

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
