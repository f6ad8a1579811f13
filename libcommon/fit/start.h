/* The Gaussians that training begins with. */
#pragma once

#include "base/rng.h"
#include "fit/parameters.h"
#include "geom/camera.h"

#include <stdint.h>

/* 1.1 times the farthest camera's distance from the mean of all: what 3DGS measures positions by. Where that
 * is nothing, as with one camera, a tenth of how far the points' middle is (points (n,3)). */
double start_extent(const struct camera *const *cameras, size_t n, const float *points, size_t points_n);

/* The mean distance of the points from the mean of the cameras: the scene's own unit, 1 where that is
 * nothing.
 */
double start_size(const struct camera *const *cameras, size_t n, const float *points, size_t points_n);

/* One at each point (n,3), as large as its three neighbours are near, of its colour (n,3). Where there is
 * room for fewer, some are left out, evenly. Returns 0, or -1 with *e set. */
int start_at_points(
	struct fit_gaussians *g, const float *points, const uint8_t *colors, size_t n, struct err *e);

/* n points for a scene that has none: in the cameras' box, made three times as large, and grey. */
void start_points(const struct camera *const *cameras, size_t cameras_n, double *points, uint8_t *colors,
	size_t n, struct rng *rng);

/* How many Gaussians a scene of so many points may have where nobody says: points are many where there is
 * much to see. */
size_t start_number(size_t points);
