/* A scene folder from a trained 3DGS .ply and its cameras: gs-import. formats/scene/scene.md,
 * formats/cameras/camerafile.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/import/moving.h"
#include "formats/scene/scene.h"
#include "splat/gaussian_rows.h"

/* The points that a reconstruction has beside its cameras, in their frame: COLMAP's points3D.bin, .txt or
 * .ply, nerfstudio's sparse_pc.ply, 3DGS's input.ply. Only where they lie is read.
 * formats/cameras/camerafile.md. */

/* Those beside a camera file, or in a model's folder, less an offset: *points (n,3); free() it. *n is 0 where
 * there are none, or none that can be read. Returns 0, or -1 with *e set where memory is out. */
int points_read(float **points, size_t *n, const char *cameras, const double offset[3], struct err *e);

/* Whether splats lie where the points of their cameras' reconstruction do: gs-import. */

/* Splats were trained from these points, so that each has the other near in the frame of both, if only those
 * that were not cut away: the larger share of either that has one of the other within a twentieth of the
 * points' extent. On a real desk 0.98, and 0.92 of the inner eighth of its splats; turned by 20 degrees 0.28,
 * at half or twice the size less than 0.1. */
#define POINT_FRAME_LEAST 0.4

/* The points beside the camera file; *share is 1 where these, or splats, are too few to tell. Returns 0, or
 * -1 with *e set. */
int point_frame_find(double *share, const struct scene *s, const char *cameras, struct err *e);

/* Whether a scene looks as its photographs do, through its cameras: gs-import. */

/* Splats and cameras of one frame give renders that look like the photographs. Of a view, small and grey,
 * what is left of render and photograph without their blurred selves is correlated; the middle value over
 * some views counts. gs-import(1) has what was measured. */
#define RESEMBLANCE_LEAST 0.4

struct resemblance {
	size_t views;	   /* that were compared */
	double typical;	   /* the middle correlation, -1 to 1, of photographs that are turned upright */
	size_t turned;	   /* views whose photograph is alike only when it is turned */
	const char *first; /* the first of them, of the scene's names, and its way, clockwise */
	int degrees;
	size_t misshapen; /* views whose photograph has another shape; of the first its name and size */
	const char *odd;
	int height, width;
	size_t unread; /* views whose photograph cannot be read, and why the first cannot */
	struct err why;
};

/* Compares views that are spread over the scene, whose photographs lie relative to the folder. Returns 0, or
 * -1 with *e set. */
int resemblance_find(struct resemblance *r, const struct scene *s, const char *folder,
	const struct report *to, struct err *e);

struct import_options {
	const char *splats;	/* "-" is stdin; a folder of frames: the scene moves */
	const char *motion;	/* .npz of means or displacements: the scene moves; NULL: not so */
	const char *times;	/* of frames, as moving_open takes them; NULL: evenly from 0 to 1 */
	const char *cameras;	/* a file, or a folder that has one; NULL: beside splats */
	const char *images;	/* folder of the photographs; NULL: none */
	const char *test_views; /* NAME,... or every:N; NULL: the camera file's */
	double time;		/* of the views of a scene that moves, where they have none; NAN: not said */
	int is_metric;		/* a unit of the splats is a metre */
	int undistort;		/* take the pinholes of cameras that distort, which are refused else */
};

/* The camera file; free() it. NULL with *e set, ERR_USAGE where none was named or found. */
char *import_find_cameras(const struct import_options *o, struct err *e);

/* Warns where a COLMAP model beside this one, which has n images, has more: 0 and 1 in sparse. 0, or -1 with
 * *e. */
int import_compare_models(const char *cameras, size_t n, const struct report *to, struct err *e);

/* Splits the views: NAME,... or every:N for testing; NULL leaves them as they are. 0, or -1 with *e. */
int import_split(struct cameras *c, const char *test_views, struct err *e);

struct import_found {
	size_t missing; /* views without a photograph */
	struct resemblance resemblance;
	size_t times, moved; /* of a scene that moves: stored times, and Gaussians that ever move */
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
