/* The point that an answer points at in a view: where its responses, averaged over a window, are largest. */
#pragma once

#include "base/err.h"

enum { PEAK_MAX_WINDOW = 1024 };

/* The pixel of an image (height,width) with the largest mean of max(image, 0) over window x window pixels,
 * the first one row by row of equal ones: *x is its column, *y its row. Pixel (x,y) has the columns x -
 * window/2 to x - window/2 + window - 1, and the rows alike; beyond the border the image is mirrored without
 * repeating the pixels at it. That is the mean filter of LangSplat's evaluation (OpenCV's filter2D), where
 * the window is 30; LERF has no filter, which is a window of 1. Returns 1, 0 where nothing is above 0, or -1
 * with *e set. */
int peak_find(const float *image, int height, int width, int window, int *x, int *y, struct err *e);

/* to (height,width): the mean around each pixel, of numbers of any sign; `room` (height,width) is scratch. */
void peak_mean(const float *image, int height, int width, int window, double *room, double *to);
