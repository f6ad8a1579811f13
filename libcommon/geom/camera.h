/* Pinhole cameras. World and camera frames are COLMAP's: camera x right, y down, z forward. */
#pragma once

#include "base/err.h"

enum camera_split { SPLIT_TRAIN, SPLIT_TEST };

/* The camera of a photograph that is not the pinhole's, in one of COLMAP's models: geom/lens.h. */
struct lens_model;
enum { LENS_PARAMETERS = 16 };
struct lens {
	const struct lens_model *model;	    /* NULL: the photograph is as the pinhole sees it */
	int width, height;		    /* of the photograph */
	double parameters[LENS_PARAMETERS]; /* fx, perhaps fy, cx, cy in its pixels, and what distorts */
};

struct camera {
	char *name;   /* unique in a scene; owned */
	char *image;  /* path of the photograph as the scene's cameras.json has it, or NULL; owned */
	char *source; /* path of the photograph in the file of cameras where `name` lacks its folders, or
			 NULL; owned */
	int width, height;
	double fx, fy, cx, cy;	      /* pixels; the centre of pixel (column i, row j) is (i+0.5, j+0.5) */
	double world_to_camera[4][4]; /* row-major, rigid: x_camera = R x_world + t */
	enum camera_split split;
	int has_time; /* the photograph is of this time, in a scene that moves */
	double time;
	struct lens lens;
};

struct cameras {
	size_t n;
	struct camera *views;
};

void cameras_free(struct cameras *c);

/* The view of that name, or NULL. */
const struct camera *cameras_find(const struct cameras *c, const char *name);

/* Sets chosen[i] (n) to 1 for the views in a comma-separated list, the value of an option. 0, or -1 with *e:
 * ERR_USAGE for a name that is no view's. */
int cameras_mark(const struct cameras *c, const char *list, const char *option, char *chosen, struct err *e);

/* The same camera at another image size; intrinsics scale alike (an off-centre principal point is honoured).
 * name and image still belong to `from`. */
struct camera camera_resize(const struct camera *from, int width, int height);

/* Size at scale s: round(W s) x round(H s), at least 1x1. */
void camera_scaled_size(const struct camera *c, double s, int *width, int *height);

/* The camera at scale s; reduced so that its longer side has at most `side` pixels. */
struct camera camera_scaled(const struct camera *c, double s);
struct camera camera_within(const struct camera *c, int side);

/* At most `most` of the training views, spread evenly over them in their order, or of all views where none is
 * for training; reduced so that the longer side has at most `side` pixels. Returns how many. */
size_t cameras_spread(const struct cameras *c, size_t most, int side, struct camera *chosen);

/* x_camera = R x_world + t. */
void camera_transform(const struct camera *c, const double world[3], double out[3]);

/* The camera's centre in the world, -R^T t. */
void camera_centre(const struct camera *c, double out[3]);

/* 1 where world_to_camera is a rotation and a translation: rows orthonormal to 1e-4, determinant positive,
 * last row 0 0 0 1, everything finite. */
int camera_is_rigid(const struct camera *c);

/* Sets world_to_camera from a rotation (3,3) world to camera, and the camera's centre in the world. */
void camera_set_centre(struct camera *c, double rotation[3][3], const double centre[3]);

/* Moves the world's origin to `offset`, as recentred splats need it: x_world becomes x_world - offset. */
void cameras_shift(struct cameras *c, const double offset[3]);
