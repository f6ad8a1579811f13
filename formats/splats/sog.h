/* SOG version 2: Gaussians in images. formats/splats/sog.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

/* Whether a file begins as a zip. */
int sog_is(const struct file_map *map);

/* An anysplats_reader of a zip. */
int sog_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e);

/* Reads meta.json and the images beside it. */
int sog_read_meta(
	struct splats *s, double offset[3], struct rows_report *report, const char *meta, struct err *e);

/* The bounds of the logarithms of means + offset, which their codes go by: sign(x) log(1 + |x|). */
void sog_bounds(double low[3], double high[3], const struct splats *s, const double offset[3]);

/* Writes a zip. Means are s->means + offset. "-" is stdout. Returns 0, or -1 with *e set. */
int sog_write(const struct splats *s, const double offset[3], const char *path, struct err *e);
