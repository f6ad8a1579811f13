/* Calibration of responses. Training tells a sentence's object apart from the others; on a sentence in other
 * words it often keeps the order of the objects but is less sure, so that all responses are below 0 and M > 0
 * gives an empty mask. Lifting all responses of a sentence alike until its best answer is clearly above 0
 * mends that (pipelines/desk.md has the gain). */
#pragma once

#include "base/err.h"
#include "field/rows.h"
#include "geom/camera.h"
#include "splat/splats.h"

#include <stdint.h>

enum {
	CALIBRATE_VIEWS = 8,  /* most views looked at, spread evenly over the training views */
	CALIBRATE_SIDE = 160, /* their longer side in pixels */
};
#define CALIBRATE_SHARE 0.0005 /* of the pixels of these views ... */
#define CALIBRATE_PEAK 2.0     /* ... shall have at least this response: probability 0.88 */

/* Adds to the responses (count,N), as render_pack has them, of the Gaussians with rows what lifts each
 * sentence's best answer to CALIBRATE_PEAK; lifts (count) gets it, 0 where it is there already. A scene
 * without training views is looked at from its other views; without any, nothing is lifted. */
int calibrate(const struct splats *s, const struct cameras *cameras, const struct rows *rows,
	float *responses, size_t count, double *lifts, struct err *e);
