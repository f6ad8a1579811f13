/* The rasteriser beside its twin (render_twin.h), and hard scenes to compare them on. What is short of memory
 * aborts. */
#ifndef RENDER_COMPARE_H
#define RENDER_COMPARE_H

#include "base/cpu.h"
#include "render_twin.h"

#include <stddef.h>
#include <stdint.h>

/* What a comparison with the twin found. */
struct render_report {
	long pixels, cuts; /* cuts: pixels whose list of Gaussians differs */
	double weight;	   /* the largest difference of a weight, in pixels of equal lists */
	double cut_margin; /* the largest margin of a pixel whose list differs: how far from a cut it was */
	double sum;	   /* the largest |sum of weights + transmittance - 1| */
	double nnz;
};

/* Every stride-th pixel of the view, rendered at the given level, against the twin. Without pixels where it
 * could not be rendered. */
struct render_report render_compare(
	const struct splats *s, const struct camera *c, enum cpu_level level, size_t stride);

struct camera camera_at_origin(int width, int height, double focal);

struct splats make_splats(size_t n);
void set_splat(struct splats *s, size_t i, const double mean[3], const double scale[3], double opacity);

/* n Gaussians scattered before a camera at the origin; scales are size times e^(spread normal). */
struct splats random_splats(uint64_t seed, size_t n, double size, double spread);

/* Aspect 1e6 at every angle, near and far, some through the camera plane's neighbourhood. */
struct splats needle_splats(void);

/* Scales from 0 to 1e30. */
struct splats odd_scale_splats(void);

/* Depths that differ in the last bits only, over a range that the sort's keys cannot resolve; tilts the
 * camera. */
struct splats close_splats(struct camera *c);

/* n faint Gaussians behind each other, each over the whole view. */
struct splats layer_splats(size_t n);

#endif
