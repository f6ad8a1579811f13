/* A photograph cut into pieces of one look, and these into segments at levels, each coarser than the last.
 *
 * The contrast of a pixel is how steep L*a*b*, smoothed, is there. Pixels from which one goes down to the
 * same lowest one are a piece (watershed; Meyer 1994). Pieces are joined by average linkage of the contrast
 * on their common border. */
#pragma once

#include "base/err.h"

#include <stdint.h>

enum { PIECES_MOST = 1500, PIECES_LEVELS = 6 };

struct pieces {
	int height, width;
	int32_t count;	/* of the finest cut: PIECES_MOST, or fewer where there are no more */
	int32_t *piece; /* (height,width) */
	/* (PIECES_LEVELS,count) the segment of each piece, the coarsest level first; they rise with the
	 * pieces */
	int32_t *segment;
};

/* rgb (height,width,3). Returns 0, or -1 with *e set for want of memory; pieces_free after either. */
int pieces_make(struct pieces *p, const uint8_t *rgb, int height, int width, struct err *e);
void pieces_free(struct pieces *p);
