#include "cmd/import/warping.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "formats/images/png.h"
#include "formats/scene/scene.h"
#include "geom/lens.h"
#include "mask/mask.h"

#include <math.h>

int warping_open(struct warping *w, enum warp way, const char *scene, struct err *e)
{
	*w = (struct warping){.way = way};
	return way == WARP_NONE ? 0 : scene_read_cameras(&w->cameras, scene, e);
}

void warping_free(struct warping *w)
{
	cameras_free(&w->cameras);
	mem_free_all(w->map, w->from, w->to);
}

/* A mask that was undistorted already has the other's size. */
static int check_shape(const struct warping *w, const struct camera *c, const struct rle *mask, struct err *e)
{
	const int is_back = w->way == WARP_TO_PHOTOGRAPH;
	const int height[2] = {c->lens.height, c->height}, width[2] = {c->lens.width, c->width};
	const int is_other = mask->height == height[!is_back] && mask->width == width[!is_back] &&
			     (mask->height != height[is_back] || mask->width != width[is_back]);

	if ((int64_t)mask->height * mask->width > INT32_MAX)
		return err_set(e, ERR_FORMAT, "view '%s': a mask of %dx%d has more than %d pixels", c->name,
			mask->width, mask->height, INT32_MAX);
	if (is_other)
		return err_set(e, ERR_FORMAT,
			"view '%s': a mask of %dx%d, but its %s is %dx%d: it is %s already", c->name,
			mask->width, mask->height, is_back ? "pinhole" : "photograph", width[is_back],
			height[is_back], is_back ? "distorted" : "undistorted");
	return mask_check_shape(c->name, mask, is_back ? "its pinhole" : "its photograph", height[is_back],
		width[is_back], e);
}

/* Cameras with one lens share a map. */
static int make_map(struct warping *w, const struct camera *c, int rows, int columns, struct err *e)
{
	const int is_back = w->way == WARP_TO_PHOTOGRAPH;
	const size_t height = (size_t)(is_back ? c->lens.height : c->height),
		     width = (size_t)(is_back ? c->lens.width : c->width);

	if (w->of && w->rows == rows && w->columns == columns && lens_is_same(&w->of->lens, &c->lens) &&
		w->of->width == c->width && w->of->height == c->height && w->of->fx == c->fx &&
		w->of->fy == c->fy && w->of->cx == c->cx && w->of->cy == c->cy)
		return 0;
	w->of = NULL;
	if (mem_room((void **)&w->map, &w->map_room, height * width, sizeof *w->map, "masks", e) ||
		mem_room((void **)&w->to, &w->to_room, height * width, 1, "masks", e))
		return -1;
	lens_map(&c->lens, c, is_back, rows, columns, w->map);
	w->of = c;
	w->rows = rows;
	w->columns = columns;
	return 0;
}

static int refuse_view(const struct warping *w, const char *view, struct err *e)
{
	const struct cameras *c = &w->cameras;
	SCOPED_BY(names_free) struct names names = {0};
	char few[NAMES_FEW];

	if (names_make(&names, c->views, sizeof *c->views, offsetof(struct camera, name), c->n, e))
		return -1;
	err_set(e, ERR_FORMAT, "view '%s' is not in the scene%s", view, names_few(&names, few));
	return -1;
}

int warping_mask(struct warping *w, const char *view, struct rle *mask, struct err *e)
{
	const struct camera *c = w->way == WARP_NONE ? NULL : cameras_find(&w->cameras, view);
	struct rle made;

	if (w->way == WARP_NONE)
		return 0;
	if (!c)
		return refuse_view(w, view, e);
	if (!c->lens.model)
		return mask_check_shape(view, mask, "the view", c->height, c->width, e);
	if (check_shape(w, c, mask, e) || make_map(w, c, mask->height, mask->width, e) ||
		mem_room((void **)&w->from, &w->from_room, (size_t)mask->height * (size_t)mask->width, 1,
			"masks", e))
		return -1;
	const int height = w->way == WARP_TO_VIEW ? c->height : c->lens.height,
		  width = w->way == WARP_TO_VIEW ? c->width : c->lens.width;
	rle_decode(mask, w->from);
	for (size_t p = 0; p < (size_t)height * (size_t)width; p++)
		w->to[p] = w->map[p] >= 0 && w->from[w->map[p]];
	if (rle_encode(&made, w->to, height, width, e))
		return -1;
	rle_free(mask);
	*mask = made;
	return 0;
}

/* Of the four pixels around a place, the nearer the more; pixel i has its centre at i + 0.5. */
static void sample(const uint8_t *rgb, int height, int width, double x, double y, uint8_t *to)
{
	const double left = fmin(fmax(x - 0.5, 0), width - 1), top = fmin(fmax(y - 0.5, 0), height - 1);
	const size_t x0 = (size_t)left, y0 = (size_t)top, w = (size_t)width, x1 = x0 + (x0 + 1 < w),
		     y1 = y0 + (y0 + 1 < (size_t)height);
	const double right = left - (double)x0, below = top - (double)y0;

	for (size_t k = 0; k < 3; k++) {
		const double a = rgb[3 * (y0 * w + x0) + k], b = rgb[3 * (y0 * w + x1) + k],
			     c = rgb[3 * (y1 * w + x0) + k], d = rgb[3 * (y1 * w + x1) + k];
		const double high = a + right * (b - a), low = c + right * (d - c);
		to[k] = (uint8_t)(high + below * (low - high) + 0.5);
	}
}

static int undistort(const struct camera *c, uint8_t **rgb, int *height, int *width, struct err *e)
{
	const struct lens *l = &c->lens;
	const double across = (double)*width / l->width, down = (double)*height / l->height;
	uint8_t *to = mem_zalloc((size_t)c->height * (size_t)c->width, 3, "photograph", e);

#pragma omp parallel for schedule(static)
	for (int y = 0; y < (to ? c->height : 0); y++)
		for (int x = 0; x < c->width; x++) {
			const double ray[2] = {(x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy};
			double at[2];
			if (!lens_project(l, ray, at) && at[0] >= 0 && at[0] < l->width && at[1] >= 0 &&
				at[1] < l->height)
				sample(*rgb, *height, *width, at[0] * across, at[1] * down,
					to + 3 * ((size_t)y * (size_t)c->width + (size_t)x));
		}
	free(*rgb);
	*rgb = to;
	*height = c->height;
	*width = c->width;
	return to ? 0 : -1;
}

/* A quarter turn clockwise. */
static int turn(uint8_t **rgb, int *height, int *width, struct err *e)
{
	const size_t h = (size_t)*height, w = (size_t)*width;
	uint8_t *to = mem_alloc(h * w, 3, "photograph", e);

	for (size_t y = 0; to && y < h; y++)
		for (size_t x = 0; x < w; x++)
			memcpy(to + 3 * (x * h + h - 1 - y), *rgb + 3 * (y * w + x), 3);
	free(*rgb);
	*rgb = to;
	*height = (int)w;
	*width = (int)h;
	return to ? 0 : -1;
}

int warping_read_photograph(const struct camera *c, const char *folder, int turns, uint8_t **rgb, int *height,
	int *width, struct err *e)
{
	SCOPED char *path = file_join(folder, c->image, "", e);
	int bad = !path || image_read_rgb(path, rgb, height, width, e);

	for (; !bad && turns; turns--)
		bad = turn(rgb, height, width, e);
	return bad || (c->lens.model && undistort(c, rgb, height, width, e)) ? -1 : 0;
}
