#include "propose/pieces.h"

#include "base/mem.h"
#include "lang/colours.h"
#include "propose/linkage.h"

#include <math.h>

/* Segments of the levels. Found on Ref-Synth and the desk's training views. */
static const int32_t level_segments[PIECES_LEVELS] = {12, 24, 48, 96, 192, 384};
#define PIECES_POWER 0.15   /* of linkage_make */
#define CONTRAST_UNIT 256.0 /* of an edge's length, to 1 of L*a*b* */
enum { SMOOTHING = 2 /* times that a pixel becomes the mean of 3x3 */ };

void pieces_free(struct pieces *p)
{
	mem_free_all(p->piece, p->segment);
	*p = (struct pieces){0};
}

static int within(int at, int size)
{
	return at < 0 ? 0 : at >= size ? size - 1 : at;
}

/* One channel, smoothed in place; last (width) is scratch. */
static void smooth(float *x, float *last, int height, int width)
{
	for (int r = 0; r < height; r++) {
		float before = x[(size_t)r * (size_t)width];
		for (int c = 0; c < width; c++) {
			float *at = x + (size_t)r * (size_t)width + c;
			const float here = *at, after = c + 1 < width ? at[1] : here;
			*at = (before + here + after) / 3;
			before = here;
		}
	}
	for (int c = 0; c < width; c++)
		last[c] = x[c];
	for (int r = 0; r < height; r++)
		for (int c = 0; c < width; c++) {
			float *at = x + (size_t)r * (size_t)width + c;
			const float here = *at, after = r + 1 < height ? at[width] : here;
			*at = (last[c] + here + after) / 3;
			last[c] = here;
		}
}

/* lab (3,height,width). */
static void take_lab(const uint8_t *rgb, size_t pixels, float *lab)
{
	for (size_t p = 0; p < pixels; p++) {
		const double of[3] = {rgb[3 * p] / 255.0, rgb[3 * p + 1] / 255.0, rgb[3 * p + 2] / 255.0};
		double to[3];
		colour_lab(of, to);
		for (size_t k = 0; k < 3; k++)
			lab[k * pixels + p] = (float)to[k];
	}
}

/* contrast (height,width) of lab, smoothed. */
static void find_contrast(const float *lab, int height, int width, float *contrast)
{
	const size_t pixels = (size_t)height * (size_t)width;

	for (int r = 0; r < height; r++)
		for (int c = 0; c < width; c++) {
			const size_t up = (size_t)within(r - 1, height), down = (size_t)within(r + 1, height),
				     left = (size_t)within(c - 1, width),
				     right = (size_t)within(c + 1, width), w = (size_t)width;
			float sum = 0;
			for (size_t k = 0; k < 3; k++) {
				const float *x = lab + k * pixels;
				const float across = x[(size_t)r * w + right] - x[(size_t)r * w + left],
					    along = x[down * w + (size_t)c] - x[up * w + (size_t)c];
				sum += across * across + along * along;
			}
			contrast[(size_t)r * w + (size_t)c] = sqrtf(sum);
		}
}

/* piece (height,width) becomes the number of the lowest pixel that each goes down to; ties go to the pixel
 * that comes first. number (height,width) is scratch. Returns how many there are. */
static int32_t flow(const float *contrast, int height, int width, int32_t *piece, int32_t *number)
{
	const int32_t pixels = height * width;
	int32_t count = 0;

	for (int32_t p = 0; p < pixels; p++) {
		int32_t lowest = p;
		for (int r = within(p / width - 1, height); r <= within(p / width + 1, height); r++)
			for (int c = within(p % width - 1, width); c <= within(p % width + 1, width); c++) {
				const int32_t q = r * width + c;
				if (contrast[q] < contrast[lowest] ||
					(contrast[q] == contrast[lowest] && q < lowest))
					lowest = q;
			}
		piece[p] = lowest;
	}
	for (int32_t p = 0; p < pixels; p++) {
		int32_t end = p;
		while (piece[end] != end)
			end = piece[end];
		for (int32_t q = p, next; q != end; q = next) {
			next = piece[q];
			piece[q] = end;
		}
	}
	for (int32_t p = 0; p < pixels; p++)
		if (piece[p] == p)
			number[p] = count++;
	for (int32_t p = 0; p < pixels; p++)
		piece[p] = number[piece[p]];
	return count;
}

/* An edge for each two neighbouring pixels of different pieces. Returns how many; edges may be NULL. */
static size_t find_edges(
	const float *contrast, const int32_t *piece, int height, int width, struct linkage_edge *edges)
{
	size_t n = 0;

	for (int r = 0; r < height; r++)
		for (int c = 0; c < width; c++)
			for (int side = 0; side < 2; side++) {
				const size_t p = (size_t)r * (size_t)width + (size_t)c;
				const size_t q = side ? p + (size_t)width : p + 1;
				if ((side ? r + 1 >= height : c + 1 >= width) || piece[p] == piece[q])
					continue;
				if (edges)
					edges[n] = (struct linkage_edge){piece[p], piece[q],
						llround(CONTRAST_UNIT * fmaxf(contrast[p], contrast[q]))};
				n++;
			}
	return n;
}

/* piece (height,width) has `count` pieces of the watershed: joins them. */
static int join_pieces(struct pieces *p, const float *contrast, int32_t count, struct err *e)
{
	const size_t pixels = (size_t)p->height * (size_t)p->width;
	const size_t edge_count = find_edges(contrast, p->piece, p->height, p->width, NULL);
	SCOPED_BY(linkage_free) struct linkage l = {0};
	SCOPED struct linkage_edge *edges = mem_alloc(edge_count, sizeof *edges, "pieces", e);
	SCOPED double *size = mem_zalloc((size_t)count, sizeof *size, "pieces", e);
	SCOPED int32_t *place = mem_alloc(2 * (size_t)count, sizeof *place, "pieces", e);
	SCOPED int32_t *fine = mem_alloc((size_t)count, sizeof *fine, "pieces", e);
	SCOPED int32_t *coarse = mem_alloc((size_t)count, sizeof *coarse, "pieces", e);

	if (!edges || !size || !place || !fine || !coarse)
		return -1;
	find_edges(contrast, p->piece, p->height, p->width, edges);
	for (size_t k = 0; k < pixels; k++)
		size[p->piece[k]]++;
	if (linkage_make(&l, count, size, edges, edge_count, PIECES_POWER, e) ||
		linkage_order(&l, place, e) || (p->count = linkage_cut(&l, place, PIECES_MOST, fine, e)) < 0)
		return -1;
	p->segment = mem_alloc(PIECES_LEVELS * (size_t)p->count, sizeof *p->segment, "pieces", e);
	if (!p->segment)
		return -1;
	for (int level = 0; level < PIECES_LEVELS; level++) {
		if (linkage_cut(&l, place, level_segments[level], coarse, e) < 0)
			return -1;
		for (int32_t k = 0; k < count; k++)
			p->segment[level * p->count + fine[k]] = coarse[k];
	}
	for (size_t k = 0; k < pixels; k++)
		p->piece[k] = fine[p->piece[k]];
	return 0;
}

int pieces_make(struct pieces *p, const uint8_t *rgb, int height, int width, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	SCOPED float *lab = mem_alloc(pixels, 3 * sizeof *lab, "photograph", e);
	SCOPED float *contrast = mem_alloc(pixels, sizeof *contrast, "photograph", e);
	SCOPED int32_t *number = mem_alloc(pixels, sizeof *number, "photograph", e);

	*p = (struct pieces){.height = height, .width = width};
	p->piece = mem_alloc(pixels, sizeof *p->piece, "pieces", e);
	int bad = !lab || !contrast || !number || !p->piece;
	if (!bad) {
		take_lab(rgb, pixels, lab);
		for (int k = 0; k < 3 * SMOOTHING; k++)
			smooth(lab + (size_t)(k % 3) * pixels, contrast, height, width);
		find_contrast(lab, height, width, contrast);
		bad = join_pieces(p, contrast, flow(contrast, height, width, p->piece, number), e);
	}
	return bad ? -1 : 0;
}
