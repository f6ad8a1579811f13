/* COLMAP sparse models: cameras and images, and points, binary or text. formats/cameras/colmap.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

#include <stdint.h>

/* What may be read of a model's folder. */
#define COLMAP_PARTS "cameras.bin|cameras.txt|images.bin|images.txt"

/* 1 where dir holds cameras and images, each as .bin or .txt. */
int colmap_is_model(const char *dir);

/* Reads the model in dir (the binary pair where it is there). Views are checked, named and sorted by
 * views_finish; `image` is the model's image name, all are SPLIT_TRAIN. A camera that distorts has its lens,
 * and the photograph's size and intrinsics: cameras_undistort makes it a pinhole. 0, or -1 with *e and *c
 * zeroed. */
int colmap_read(struct cameras *c, const char *dir, struct err *e);

/* Makes dir and writes cameras.txt (PINHOLE; views with the same intrinsics share a camera), images.txt
 * (named by the file name of `image`, or `name` where that is NULL) and an empty points3D.txt. */
int colmap_write_text(const struct cameras *c, const char *dir, struct err *e);

/* The points of a model. */
struct colmap_points {
	size_t n;
	double *places;	 /* (n,3) world units */
	uint8_t *colors; /* (n,3) */
};

/* points3D.bin of the folder, or points3D.txt; none where there is neither. Returns 0, or -1 with *e set and
 * *p zeroed. */
int colmap_points_read(struct colmap_points *p, const char *dir, struct err *e);
void colmap_points_free(struct colmap_points *p);
