/* .spz: Niantic's packed Gaussians, versions 2 to 4. formats/splats/spz.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

enum { SPZ_MAGIC = 0x5053474e, SPZ_OLDEST = 2, SPZ_LATEST = 4 };

/* The arrays of a file, in its order. */
enum spz_part { SPZ_MEANS, SPZ_OPACITIES, SPZ_COLORS, SPZ_SCALES, SPZ_QUATS, SPZ_SH, SPZ_PARTS };

/* A file whose arrays are out of their container. */
struct spz {
	const char *name; /* as messages name it */
	int version;
	size_t n;
	int degree;
	int fraction_bits; /* of the 24 of a coordinate */
	int axes;	   /* that point the other way than a .ply's: FLIP_X ... */
	unsigned char *bytes;
	const unsigned char *part[SPZ_PARTS]; /* into bytes */
};

/* Bytes of each Gaussian in a part, and in all. */
size_t spz_width(const struct spz *f, enum spz_part part);
size_t spz_row(const struct spz *f);

/* Lays the parts one after another, from p on. */
void spz_place(struct spz *f, const unsigned char *p);

/* Takes a file that is in memory out of its container (gzip, or zstd from version 4 on). `name` must outlive
 * f. Returns 0, or -1 with *e set; spz_close after either. */
int spz_open(struct spz *f, const char *name, const struct file_map *map, struct err *e);
void spz_close(struct spz *f);

/* Whether a file begins as one. */
int spz_is(const struct file_map *map);

/* An anysplats_reader. */
int spz_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e);

/* Writes version 2 or 3 (gzip) or 4 (zstd). Means are s->means + offset. "-" is stdout. 0, or -1 with *e. */
int spz_write(const struct splats *s, const double offset[3], int version, const char *path, struct err *e);

/* The fraction bits of a coordinate that spz_write chooses; -1 where the farthest has no room. */
int spz_fraction(const struct splats *s, const double offset[3]);
