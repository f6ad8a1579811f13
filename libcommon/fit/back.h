/* The backward pass of blending: from the gradient of a view's image to sums for each Gaussian.
 *
 * With u and v of a Gaussian (splat/project.h), a = min(0.99, 2^e), e = log2 o - u^2 - v^2, and D = dL/dC . c
 *its colour's share of a pixel's gradient, the loss changes with e by dL/de = ln 2 (w D - a / (1-a) sum_{k
 *behind} w_k D_k) and not at all where a is at its limit. The sum behind is what is left of dL/dC . C, front
 *to back as in the forward pass, so that both end pixels alike. All that the projection needs are moments of
 *dL/de over pixels in (u, v). */
#pragma once

#include "base/err.h"
#include "splat/blend.h"
#include "splat/project.h"
#include "splat/render.h"

#include <stdint.h>

/* What is summed over pixels, for each Gaussian: g = dL/de / ln 2 and its moments, dL/dc, and w. */
enum {
	BACK_G,
	BACK_U,
	BACK_V,
	BACK_UU,
	BACK_UV,
	BACK_VV,
	BACK_RED,
	BACK_GREEN,
	BACK_BLUE,
	BACK_WEIGHT,
	BACK_SUMS
};

/* A tile's pixels, block by block as in struct blend_tile. */
struct back_tile {
	float d[3][TILE_PIXELS]; /* dL/dC */
	float rest[TILE_PIXELS]; /* of dL/dC . C behind what was blended */
};

/* Where the sums of a chunk are made, of each Gaussian over the pixels at one place of a block. */
struct back_sums {
	float of[BLEND_CHUNK][BACK_SUMS][BLEND_LANES];
};

struct back_kernels {
	/* Sums (n,BACK_SUMS) of a tile that blend_start has made; colors (N,3). Returns how many of the n
	 * were blended before every pixel had ended: the rest are not written. */
	size_t (*tile)(struct blend_tile *t, struct back_tile *b, struct back_sums *sums,
		const struct projected *p, const uint32_t *list, size_t n, const float *colors, float *out);
};
extern const struct back_kernels back_plain, back_avx2, back_avx512;

/* Room that is kept from view to view. Zeroed is empty. */
struct back_room {
	float *parts; /* (entries,BACK_SUMS) */
	size_t *done; /* (tiles) entries of a tile that have parts */
	size_t part_room, done_room;
};
void back_free(struct back_room *r);

/* sums (N,BACK_SUMS), 0 for Gaussians that the view has not. image and gradient are planes (3,P).
 * Returns 0, or -1 with *e set. */
int back_view(const struct render_view *v, const float *colors, const float *image, const float *gradient,
	float *sums, struct back_room *room, struct err *e);
