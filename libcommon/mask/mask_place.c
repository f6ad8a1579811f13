#include "mask/mask_place.h"

#include "base/mem.h"

#include <math.h>

struct mask_place *mask_place_new(struct err *e)
{
	return mem_zalloc(1, sizeof(struct mask_place), "mask", e);
}

void mask_place_free(struct mask_place *p)
{
	if (p)
		free(p->boxes);
	free(p);
}

int mask_place_add_box(struct mask_place *p, const double box[4], struct err *e)
{
	if (mem_grow((void **)&p->boxes, &p->box_room, p->box_count + 1, sizeof *p->boxes, "boxes", e))
		return -1;
	double *to = p->boxes[p->box_count++];
	for (int k = 0; k < 2; k++) {
		to[k] = fmin(box[k], box[k + 2]);
		to[k + 2] = fmax(box[k], box[k + 2]);
	}
	return 0;
}

/* A pixel's centre stays where it is in the picture. */
static double scaled(double at, int from, int to)
{
	return from == to ? at : (at + 0.5) * to / from - 0.5;
}

/* The pixel that has it. */
static double scaled_pixel(double at, int from, int to)
{
	return floor(scaled(at, from, to) + 0.5);
}

int mask_place_bounds(const struct rle *r, double box[4])
{
	const size_t height = (size_t)r->height;
	size_t at = 0, left = SIZE_MAX, right = 0, top = height, bottom = 0;

	for (size_t i = 0; i < r->n; at += r->runs[i++]) {
		if (i % 2 == 0 || !r->runs[i])
			continue;
		const size_t last = at + r->runs[i] - 1;
		const int is_whole = at / height != last / height;
		left = left == SIZE_MAX ? at / height : left;
		right = last / height;
		top = is_whole ? 0 : at % height < top ? at % height : top;
		bottom = is_whole ? height - 1 : last % height > bottom ? last % height : bottom;
	}
	if (left == SIZE_MAX)
		return 0;
	memcpy(box, (double[4]){(double)left, (double)top, (double)right, (double)bottom}, 4 * sizeof *box);
	return 1;
}

static int is_within(double x, double y, const double box[4])
{
	return x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3];
}

int mask_place_in_box(
	const double peak[2], int height, int width, const struct rle *truth, const struct mask_place *boxes)
{
	const double x = scaled(peak[0], width, truth->width), y = scaled(peak[1], height, truth->height);
	double box[4];

	if (!boxes || !boxes->box_count)
		return mask_place_bounds(truth, box) &&
		       is_within(scaled_pixel(peak[0], width, truth->width),
			       scaled_pixel(peak[1], height, truth->height), box);
	for (size_t i = 0; i < boxes->box_count; i++)
		if (is_within(x, y, boxes->boxes[i]))
			return 1;
	return 0;
}

int mask_place_in_mask(const double peak[2], int height, int width, const struct rle *truth)
{
	const double x = scaled_pixel(peak[0], width, truth->width),
		     y = scaled_pixel(peak[1], height, truth->height);
	size_t at = 0, i = 0;

	if (!(x >= 0 && x < truth->width && y >= 0 && y < truth->height))
		return 0;
	const size_t pixel = (size_t)x * (size_t)truth->height + (size_t)y;
	while (at + truth->runs[i] <= pixel)
		at += truth->runs[i++];
	return i % 2 == 1;
}
