/* A scene as a whole, moved: x becomes rotation (scale x) + shift. */
#pragma once

#include "splat/sh.h"
#include "splat/splats.h"

struct move {
	double scale;	/* > 0 */
	double quat[4]; /* w, x, y, z, of any length but 0 */
	double shift[3];
};

/* Moves means, scales, rotations and harmonics. The scene's own frame is the world's less `offset`, which is
 * moved too; where it is 0 it stays so, and the means take the shift. */
void splats_move(struct splats *s, double offset[3], const struct move *m);

/* The matrix that turns harmonics: where colour is sum_k sh[k] Y_k(d), that of the turned scene is
 * sum_j (sum_k turn[j][k] sh[k]) Y_j(d). Bands do not mix. */
void sh_turn(const double rotation[3][3], double turn[SH_MAX][SH_MAX]);
