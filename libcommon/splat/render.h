/* The rasteriser: EWA splatting as in 3DGS (Kerbl et al. 2023, section 4; design section 5).
 *
 * A view is projected and sorted once (render_prepare); any number of passes then use it. All passes blend
 * the same weights w_i = a_i T_i, T_i = prod_{k<i} (1-a_k), with a_i = min(0.99, o exp(-q/2)), skipped below
 * 1/255, front to back by camera z, ties by index. A pixel ends before the first Gaussian that would bring T
 * below 1e-4: that one is not blended, so T >= 1e-4 is what is left, and weights and T sum to 1.
 *
 * Gaussians with z <= splats.near are left out. In the Jacobian x/z and y/z are limited to the field of view
 * and 0.3 of its half beyond each edge, which is 1.3 times the half field of view where the principal point
 * is central.
 *
 * Weights agree with double precision to 1e-6; a pixel may differ by a whole Gaussian where a falls within
 * rounding of 1/255, or T of 1e-4. Results do not depend on tile size or number of threads. They are the same
 * on all machines of one instruction set (base/cpu.h) and differ by rounding between them. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

struct render_view; /* projected, culled, tiled and depth-sorted Gaussians of one view */

/* NULL with *e set. The splats must outlive the view for render_colors only. */
struct render_view *render_prepare(const struct splats *s, const struct camera *c, struct err *e);
void render_free(struct render_view *v);
/* Of a local, where its block is left: SCOPED_BY(render_release) struct render_view *v = ... */
void render_release(struct render_view **v);

/* The same for another camera, or other splats, in the memory that the view has: fresh memory costs as much
 * as projecting. 0, or -1 with *e; then the view is good for render_again and render_free only. */
int render_again(struct render_view *v, const struct splats *s, const struct camera *c, struct err *e);

/* Only those tiles where Gaussians with is_wanted[i] (N) may show: values blended there are the same to the
 * bit, and 0 in all others, so that a response that only these Gaussians have above 0 has the same mask. Not
 * for weights, colours or transmittance. NULL wants all. */
struct render_view *render_prepare_where(
	const struct splats *s, const struct camera *c, const uint8_t *is_wanted, struct err *e);
int render_again_where(struct render_view *v, const struct splats *s, const struct camera *c,
	const uint8_t *is_wanted, struct err *e);

/* Bytes that a view of so many Gaussians takes, without its tile lists. */
size_t render_bytes(size_t gaussians);

/* Blend weights, CSR over the P = width*height pixels of the camera. */
struct render_weights {
	int64_t *indptr;      /* (P+1) */
	int32_t *index;	      /* (nnz) front to back */
	float *weight;	      /* (nnz) */
	float *transmittance; /* (P) what is left: sum of weights + transmittance = 1 */
	size_t indptr_room, index_room, weight_room, transmittance_room; /* items the arrays could hold */
};

/* Arrays are allocated here. Returns 0, or -1 with *e set and nothing to free. */
int render_weights(const struct render_view *v, struct render_weights *w, struct err *e);
/* The same in the arrays that *w has from another view, or new ones where zeroed. Freed on failure. */
int render_weights_again(const struct render_view *v, struct render_weights *w, struct err *e);
/* The same without the smallest weights of each pixel (of equal ones the farther), while what is out is at
 * most `tolerance` of its sum, and then without those below `least`. dropped (P), or NULL, gets the sum of
 * what is out, at most 1, which bounds the error of a response: |dM| <= dropped max|m|. */
struct render_limits {
	double tolerance, least;
};
int render_weights_within(const struct render_view *v, const struct render_limits *limits,
	struct render_weights *w, float *dropped, struct err *e);
void render_weights_free(struct render_weights *w);

/* Blends `channels` values per Gaussian: out (channels,P) = sum_i w_i values[c][i], values (channels,N)
 * planar, no background. `transmittance` (P) may be NULL. */
int render_values(const struct render_view *v, const float *values, int channels, float *out,
	float *transmittance, struct err *e);

/* The same for values that are packed once and blended in many views: planes in groups of RENDER_GROUP, the
 * last perhaps of fewer, each group (N,channels of it). One pass blends a group. render_pack packs in place,
 * and fails for want of memory only. */
enum { RENDER_GROUP = 16 };
int render_pack(float *values, size_t n, int channels, struct err *e);
void render_packed(
	const struct render_view *v, const float *values, int channels, float *out, float *transmittance);

/* Colours from spherical harmonics over a background: rgb (P,3) in [0,1] clamped. */
int render_colors(const struct render_view *v, const struct splats *s, const struct camera *c,
	const float background[3], float *rgb, struct err *e);
