/* .splat: Gaussians as web viewers take them, 32 bytes each. formats/splats/splat.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

enum { SPLAT_BYTES = 32 };

/* One Gaussian as the file has it. */
void splat_pack(unsigned char bytes[SPLAT_BYTES], const struct splats *s, size_t i);

/* An anysplats_reader. */
int splat_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e);

/* Writes the Gaussians, those that cover the most first; means are s->means + offset. "-" is stdout. */
int splat_write(const struct splats *s, const double offset[3], const char *path, struct err *e);
