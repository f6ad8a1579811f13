/* 3DGS .ply scenes. formats/splats/ply.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

#include <stdint.h>

/* The same Gaussians from another file, in memory, and as read. */
struct ply_like {
	struct file_map map;
	const struct splats *splats; /* NULL: there is none */
};

/* An anysplats_reader (binary of either byte order, or ascii; or PlayCanvas's packed form). The same to the
 * byte, but quicker where the file is like the other up to its rows, and rows differ in their means and
 * rotations. like may be NULL. */
int ply_read_like(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, const struct ply_like *like, struct err *e);

/* Writes the usual 3DGS layout (x y z nx ny nz f_dc f_rest opacity scale rot), binary little-endian, with
 * activations undone. x y z are float, or double where offset is not 0. "-" is stdout. */
int ply_write(const struct splats *s, const double offset[3], const char *path, struct err *e);

/* The same with a last property, int label, of each Gaussian: labels (N). */
int ply_write_labelled(const struct splats *s, const double offset[3], const int32_t *labels,
	const char *path, struct err *e);
