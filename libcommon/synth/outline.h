/* What a segmenter does to a mask: ragged edges, halves. */
#pragma once

#include "base/err.h"
#include "base/rng.h"
#include "synth/noise.h"

#include <stdint.h>

/* Moves the outline of mask (height,width) in and out at random, in place: the mask is blurred over about 4%
 * of its size and cut again at one half + `shrink` + `rag` times a smooth noise. */
int synth_outline_rag(uint8_t *mask, int height, int width, double rag, double shrink,
	const struct synth_noise *noise, struct rng *r, struct err *e);

/* Keeps the part on one side of a random line that leaves about `share` of the pixels. */
void synth_outline_cut(uint8_t *mask, int height, int width, double share, struct rng *r);

size_t synth_outline_area(const uint8_t *mask, size_t pixels);
