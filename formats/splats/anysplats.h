/* Trained scenes in any file that can be read. formats/splats/anysplats.md. */
#pragma once

#include "base/err.h"
#include "formats/splats/ply.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

/* What reads each format: a file that is in memory, whose map it may take over. *s and *report are zeroed
 * before; after a failure both may have something. `name` is for messages. */
typedef int anysplats_reader(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e);

/* Reads a .ply, .spz, SOG, .glb or .splat ("-" is stdin): by how the file begins; .splat, which begins with a
 * Gaussian, and SOG's meta.json by their names. Activations are applied (scales exp, opacity sigmoid), means
 * are minus `offset`, which is chosen here by the rule in ply.md (0 for scenes near the origin) and returned.
 * Quaternions keep their length unless it is extreme (ply.md). `report` may be NULL. Returns 0, or -1 with *e
 * set, *s zeroed and report->dropped NULL. */
int anysplats_read(
	struct splats *s, double offset[3], struct rows_report *report, const char *path, struct err *e);

/* The same of a file that is likely like another: ply_read_like. */
int anysplats_read_like(struct splats *s, double offset[3], struct rows_report *report, const char *path,
	const struct ply_like *like, struct err *e);

/* Whether a file is SOG's meta.json, by its name. */
int anysplats_is_meta(const char *path);

/* What can be written. */
enum anysplats_format {
	ANYSPLATS_PLY,
	ANYSPLATS_SPLAT,
	ANYSPLATS_SPZ,
	ANYSPLATS_GLB,
	ANYSPLATS_SOG,
	ANYSPLATS_FORMATS
};

/* The format that a name ends with; -1 where it is none. */
int anysplats_format_of(const char *path);

enum { ANYSPLATS_SPZ_VERSION = 3 }; /* where none is asked for */

/* Writes means + offset; spz_version is 2 to 4. "-" is stdout. Returns 0, or -1 with *e set. */
int anysplats_write(const struct splats *s, const double offset[3], enum anysplats_format format,
	int spz_version, const char *path, struct err *e);

/* What of the Gaussians a format loses that shows: 1 and *text, 0, or -1 with *e set for want of memory. */
enum { ANYSPLATS_LOSS = 400 };
int anysplats_loss(const struct splats *s, const double offset[3], enum anysplats_format format,
	char text[ANYSPLATS_LOSS], struct err *e);
