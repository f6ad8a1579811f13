/* A scene folder: splats.safetensors (refer.splats), cameras.json and, where it moves, motion.safetensors
 * (formats/scene/scene.md). */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "formats/scene/motion.h"
#include "geom/camera.h"
#include "splat/render.h"
#include "splat/splats.h"

struct scene {
	char *path; /* the folder that was read, as it was named; else NULL */
	struct splats splats;
	struct fingerprint fingerprint; /* of splats.means; set by the readers */
	struct cameras cameras;
	double offset[3]; /* world = means + offset: what the import subtracted */
	int is_metric;	  /* a unit is a metre; else nobody said what it is */
	/* The splats are those of its first time. Of scene_read; times is 0 where the scene is still. */
	struct motion motion;
};

/* Reads and checks all files. Messages name the file and the tensor or key. */
int scene_read(struct scene *s, const char *dir, struct err *e);
void scene_free(struct scene *s);

/* That a file, as it is named, which has so many Gaussians and this fingerprint, is of the scene that was
 * read. */
int scene_check(const struct scene *s, const char *path, size_t gaussians, const struct fingerprint *of,
	struct err *e);

/* One of the files. scene_read_splats sets splats, fingerprint and offset of a zeroed *s. */
int scene_read_splats(struct scene *s, const char *path, struct err *e);
int scene_read_cameras_file(struct cameras *c, const char *path, struct err *e);
int scene_read_cameras(struct cameras *c, const char *dir, struct err *e);

/* to: the scene's splats at the time of a view; of a still scene as they are. What does not move is the
 * scene's own. ERR_FORMAT where the view has no time, or it is none of the scene's. */
int scene_splats_at(struct splats *to, const struct scene *s, const struct camera *view, struct err *e);
/* The same for what is drawn: a view without a time shows the splats as they are. */
int scene_splats_shown(struct splats *to, const struct scene *s, const struct camera *view, struct err *e);
void scene_splats_release(struct splats *at, const struct scene *s);

/* render_prepare of the splats that a view shows. NULL with *e set. */
struct render_view *scene_prepare(const struct scene *s, const struct camera *view, struct err *e);

/* Moves the scene's own splats to a time, or to that of a view; NULL: they stay. ERR_USAGE where the scene is
 * still. Not while others read them. */
int scene_move(struct scene *s, const double *t, struct err *e);
int scene_move_to_view(struct scene *s, const struct camera *view, struct err *e);

/* Makes dir and writes both files, each appearing whole. `options` goes into the metadata. */
int scene_write(const struct scene *s, const char *dir, const char *options, struct err *e);
