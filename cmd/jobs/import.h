/* A scene folder from a trained 3DGS .ply and its cameras: gs-import. formats/scene.md,
 * formats/camerafile.md. */
#ifndef CMD_JOBS_IMPORT_H
#define CMD_JOBS_IMPORT_H

#include "base/err.h"
#include "formats/ply.h"
#include "formats/scene.h"

#include <stddef.h>

struct import_options {
	const char *splats;	/* "-" is stdin */
	const char *cameras;	/* a file, or a folder that has one; NULL: beside splats */
	const char *images;	/* folder of the photographs; NULL: none */
	const char *test_views; /* NAME,... or every:N; NULL: the camera file's */
};

/* The camera file; free() it. NULL with *e set, ERR_USAGE where none was named or found. */
char *import_find_cameras(const struct import_options *o, struct err *e);

/* Reads splats and cameras, splits the views and writes the folder. *s and *report are zeroed before and the
 * caller's to free in any case. *missing gets how many views have no photograph. Returns 0, or -1 with *e
 * set. */
int import_scene(struct scene *s, struct ply_report *report, const struct import_options *o,
	const char *cameras, const char *folder, size_t *missing, struct err *e);

#endif
