/* A scene folder from a trained 3DGS .ply and its cameras: gs-import. formats/scene/scene.md,
 * formats/cameras/camerafile.md. */
#ifndef CMD_IMPORT_IMPORT_H
#define CMD_IMPORT_IMPORT_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/import/point_frame.h"
#include "cmd/import/resemblance.h"
#include "formats/splats/gaussian_rows.h"
#include "formats/scene/scene.h"

#include <stddef.h>

struct import_options {
	const char *splats;	/* "-" is stdin */
	const char *cameras;	/* a file, or a folder that has one; NULL: beside splats */
	const char *images;	/* folder of the photographs; NULL: none */
	const char *test_views; /* NAME,... or every:N; NULL: the camera file's */
	int undistort;		/* take the pinholes of cameras that distort, which are refused else */
};

/* The camera file; free() it. NULL with *e set, ERR_USAGE where none was named or found. */
char *import_find_cameras(const struct import_options *o, struct err *e);

/* Splits the views: NAME,... or every:N for testing; NULL leaves them as they are. Returns 0, or -1 with *e.
 */
int import_split(struct cameras *c, const char *test_views, struct err *e);

struct import_found {
	size_t missing; /* views without a photograph */
	struct resemblance resemblance;
	double near; /* POINT_FRAME_LEAST and more, where splats and the cameras' points have one frame */
};

/* The splats in a folder: SOG's meta.json, or point_cloud/iteration_N/point_cloud.ply of the last N that 3DGS
 * wrote; a file is itself. free() it. NULL with *e set. */
char *import_find_splats(const char *path, struct err *e);

/* Reads splats and cameras, splits the views, compares the scene with its photographs where there are any,
 * and writes the folder. *s and *report are zeroed before and the caller's to free in any case. Returns 0, or
 * -1 with *e set. */
int import_scene(struct scene *s, struct rows_report *report, const struct import_options *o,
	const char *cameras, const char *folder, struct import_found *found, const struct report *to,
	struct err *e);

#endif
