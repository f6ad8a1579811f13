/* NanoDet-g (Lyu 2021, github.com/RangiLyu/nanodet): boxes of everyday things in a picture, by a network of
 * 34 convolutions.
 *
 * The picture is stretched to 416 x 416. A convolution and a maximum make it 104 x 104 of 32 channels; then
 * four stages of w = 32, 64, 128, 256 channels, from the second on with half the sides of the one before:
 *
 *   x = conv(in); y = x; one, two, two and three times y = (conv(h), h) with h = conv(y) of w / 2
 *   channels; the stage is (conv(y), x), of 2 w channels
 *
 * The last three, as 128 channels each, are added to each other from the coarsest to the finest and back
 * (PANet), and two more convolutions give each cell of 52 x 52, 26 x 26 and 13 x 13 a number for each class,
 * whose logistic function is the score, and for each of a box's four sides the distance from the cell's
 * middle, as a softmax over 0 to 10 strides (generalised focal loss). */
#pragma once

#include "base/err.h"
#include "nn/conv.h"

#include <stdint.h>

enum {
	NANODET_SIDE = 416,
	NANODET_CONVS = 34,
	NANODET_CLASSES = 80, /* COCO's */
	NANODET_BINS = 11,
	NANODET_CELLS = 52 * 52 + 26 * 26 + 13 * 13,
	NANODET_OUT = NANODET_CLASSES + 4 * NANODET_BINS,
};

struct nanodet {
	struct conv convs[NANODET_CONVS]; /* in the order of the backbone, its three results as 128 channels,
					     and two of each head, the finest first */
	float *slab;
};

/* Sets the sizes of all convolutions, and allocates their weights, not initialised. 0, or -1 with *e. */
int nanodet_alloc(struct nanodet *n, struct err *e);
void nanodet_free(struct nanodet *n);

/* Floats of scratch for nanodet_forward. */
size_t nanodet_scratch(const struct nanodet *n);

/* in (416,416,3), of nanodet_picture; out (NANODET_CELLS,NANODET_OUT): rows of 52 x 52 cells, then 26 x 26,
 * then 13 x 13; the classes before their logistic function, then the bins of left, top, right and bottom. */
void nanodet_forward(const struct nanodet *n, float *out, float *in, float *scratch);

/* A part of a picture, in pixels. */
struct nanodet_window {
	int left, top, width, height;
};

/* The window of a picture rgb (height,width,3) as the network takes it: stretched, each pixel a mean over
 * what it covers, weighted by a tent; blue, green and red less their means and over their deviations in
 * ImageNet. Returns 0, or -1 with *e where memory is out. */
int nanodet_picture(
	float *in, const uint8_t *rgb, int width, const struct nanodet_window *window, struct err *e);

struct nanodet_box {
	float side[4]; /* left, top, right, bottom, in pixels of the picture, within the window */
	float score;   /* 0 to 1 */
	int label;     /* from 0 to NANODET_CLASSES - 1 */
};

struct nanodet_boxes {
	size_t n, capacity;
	struct nanodet_box *items;
};

/* Adds the boxes of what nanodet_forward made of a window with at least this score. 0, or -1 with *e. */
int nanodet_add(struct nanodet_boxes *to, const float *out, const struct nanodet_window *window, float score,
	struct err *e);

/* Sorts boxes, the surest first, and takes those away that lie on a surer one of their class: intersection
 * over union above `most`. */
void nanodet_thin(struct nanodet_boxes *boxes, double most);

/* The names of the classes: "person", ... */
extern const char *const nanodet_classes[NANODET_CLASSES];
