/* Frames of a scene that moves, a file each, and the times of frames: gs-import. */
#pragma once

#include "base/err.h"
#include "formats/splats/ply.h"
#include "splat/splats.h"

#define FRAMES_NOT_FINITE                                                                                    \
	"Gaussian %zu is not finite, or has no rotation: of a scene that moves none may be left out"

/* 1 where a folder holds frames, several .ply files whose names have numbers, and no trained scene as 3DGS
 * writes it; 0 where not, -1 with *e set. */
int frames_is_folder(const char *path, struct err *e);

/* The .ply files of a folder, by the last number in their names: (n) to free. ERR_FORMAT where the names are
 * not of one sequence, or a number is missing in it. */
int frames_list(const char *folder, char ***paths, size_t *n, struct err *e);

/* times (n): of a file of numbers, "T0:T1" evenly, "Nfps" from 0, or NULL: evenly from 0 to 1. */
int frames_times(double *times, size_t n, const char *how, const char *of, struct err *e);
/* They rise; `path` is for messages. */
int frames_check_times(const double *times, size_t n, const char *path, struct err *e);

/* A frame, with the offset of the first one. ERR_FORMAT where it has not the first one's Gaussians, or not in
 * that order: told by opacities and colours, which stay, and where they tell, by standard deviations. */
int frames_read(struct splats *s, const struct ply_like *first, const double offset[3],
	const char *first_path, const char *path, struct err *e);
