#include "cmd/import/import.h"

#include "base/compare.h"
#include "base/mem.h"
#include "cmd/import/warping.h"
#include "mask/shrink.h"
#include "splat/render.h"

#include <math.h>

/* Views that are compared, their longer side in pixels, and how far a pixel's blurred self reaches. */
enum { VIEWS = 8, SIDE = 160, REACH = 8 };

/* Takes from each pixel the mean of those around it. */
static void sharpen(const float *grey, float *out, int height, int width)
{
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++) {
			double sum = 0;
			int n = 0;
			for (int i = y - REACH; i <= y + REACH; i++)
				for (int k = x - REACH; k <= x + REACH; k++) {
					if (i < 0 || k < 0 || i >= height || k >= width)
						continue;
					sum += grey[(size_t)i * (size_t)width + (size_t)k];
					n++;
				}
			const size_t at = (size_t)y * (size_t)width + (size_t)x;
			out[at] = grey[at] - (float)(sum / n);
		}
}

static double correlate(const float *a, const float *b, size_t n)
{
	double both = 0, squares_a = 0, squares_b = 0;

	for (size_t i = 0; i < n; i++) {
		both += (double)a[i] * (double)b[i];
		squares_a += (double)a[i] * (double)a[i];
		squares_b += (double)b[i] * (double)b[i];
	}
	return squares_a > 0 && squares_b > 0 ? both / sqrt(squares_a * squares_b) : 0;
}

/* One view: its photograph is rgb (height,width). */
static int compare(const struct scene *s, const struct camera *full, const uint8_t *rgb, int height,
	int width, double *correlation, struct err *e)
{
	const struct camera small = camera_within(full, SIDE);
	const int w = small.width, h = small.height;
	const size_t pixels = (size_t)w * (size_t)h;
	SCOPED float *room = mem_alloc(pixels, 6 * sizeof *room, "pictures", e);
	SCOPED uint8_t *shown = room ? shrink_picture(rgb, height, width, h, w, e) : NULL;
	struct render_view *view = shown ? render_prepare(&s->splats, &small, e) : NULL;
	const int bad = !view || render_colors(view, &s->splats, &small, (const float[3]){0}, room, e);
	render_free(view);
	if (bad)
		return -1;
	float *grey = room + 3 * pixels, *rendered = grey + pixels, *seen = rendered + pixels;
	for (size_t i = 0; i < pixels; i++)
		grey[i] = room[3 * i] + room[3 * i + 1] + room[3 * i + 2];
	sharpen(grey, rendered, h, w);
	for (size_t i = 0; i < pixels; i++)
		grey[i] = (float)(shown[3 * i] + shown[3 * i + 1] + shown[3 * i + 2]);
	sharpen(grey, seen, h, w);
	*correlation = correlate(rendered, seen, pixels);
	return 0;
}

/* The photograph after so many quarter turns. One that cannot be read is none: 1, and r says why. */
static int compare_file(struct resemblance *r, const struct scene *s, const struct camera *c,
	const char *folder, int turns, double *correlation, const struct report *to, struct err *e)
{
	SCOPED uint8_t *rgb = NULL;
	int height, width;
	struct err why;

	if (warping_read_photograph(c, folder, turns, &rgb, &height, &width, &why)) {
		report_note(to, 1, "%s: not compared: %s", c->name, why.message);
		if (!r->unread++)
			r->why = why;
		return 1;
	}
	if (!turns && !rle_has_shape(height, width, c->height, c->width) && !c->lens.model &&
		!r->misshapen++) {
		r->odd = c->name;
		r->height = height;
		r->width = width;
	}
	return compare(s, c, rgb, height, width, correlation, e);
}

/* As it is, and where it is not alike, turned: what is like the view then is not upright. */
static int compare_turned(struct resemblance *r, const struct scene *s, const struct camera *c,
	const char *folder, double *correlation, const struct report *to, struct err *e)
{
	int state = compare_file(r, s, c, folder, 0, correlation, to, e);

	if (!state)
		report_note(to, 1, "%s: resembles its photograph by %.2f", c->name, *correlation);
	for (int turns = 1; !state && turns < 4 && *correlation < RESEMBLANCE_LEAST; turns++) {
		double turned;
		state = compare_file(r, s, c, folder, turns, &turned, to, e);
		if (state || turned < RESEMBLANCE_LEAST)
			continue;
		*correlation = turned;
		if (!r->turned++) {
			r->first = c->name;
			r->degrees = 90 * turns;
		}
	}
	return state;
}

int resemblance_find(struct resemblance *r, const struct scene *s, const char *folder,
	const struct report *to, struct err *e)
{
	const struct cameras *c = &s->cameras;
	const size_t step = (c->n + VIEWS - 1) / VIEWS;
	double all[VIEWS];

	*r = (struct resemblance){0};
	for (size_t v = 0; v < c->n; v += step) {
		if (!c->views[v].image)
			continue;
		const int state = compare_turned(r, s, &c->views[v], folder, &all[r->views], to, e);
		if (state < 0)
			return -1;
		r->views += !state;
	}
	if (r->views)
		qsort(all, r->views, sizeof *all, compare_double);
	r->typical = r->views ? all[r->views / 2] : 0;
	return 0;
}
