/* Trained scenes in any file that can be read. formats/anysplats.md. */
#ifndef FORMATS_ANYSPLATS_H
#define FORMATS_ANYSPLATS_H

#include "base/err.h"
#include "formats/gaussian_rows.h"
#include "splat/splats.h"

/* Reads a .ply, .spz or .splat ("-" is stdin): by how the file begins, and .splat, which begins with a
 * Gaussian, by its name. As ply_read. */
int anysplats_read(
	struct splats *s, double offset[3], struct rows_report *report, const char *path, struct err *e);

#endif
