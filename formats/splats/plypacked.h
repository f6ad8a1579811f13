/* PlayCanvas's compressed .ply: Gaussians packed into 16 bytes each, in chunks of 256. formats/splats/ply.md
 * has the bits. */
#pragma once

#include "base/err.h"
#include "formats/splats/plyfile.h"

enum { PLYPACKED_BOUNDS = 18, PLYPACKED_VALUES = 14 };

struct plypacked {
	double *bounds; /* (chunks, PLYPACKED_BOUNDS): least and greatest of each value */
	size_t chunks;
	long slot[4]; /* packed_position, _rotation, _scale, _color of the vertex */
	int rest;     /* number of f_rest: 0, 9, 24, 45 */
	const struct plyfile_element *sh;
	struct plyfile sh_rows; /* a second place in the same file */
	double *row, *sh_row;
};

/* 1 where the file is of this kind. */
int plypacked_is(const struct plyfile *f);

/* Before the rows of `vertex` are read, with f->at at their beginning; `chunks` is where the rows of element
 * chunk begin. Checks the layout and reads the chunks. 0, or -1 with *e; plypacked_close in any case. */
int plypacked_open(struct plypacked *p, const struct plyfile *f, const struct plyfile_element *vertex,
	size_t chunks, struct err *e);
void plypacked_close(struct plypacked *p);

/* The next vertex as a row of the usual layout: x y z, f_dc, opacity, scale, rot, then f_rest. */
int plypacked_row(struct plypacked *p, struct plyfile *f, const struct plyfile_element *vertex, size_t row,
	double *values, struct err *e);
