/* Lenses that distort, in COLMAP's camera models, and the pinhole that sees what such a camera does. A ray is
 * (x/z, y/z) in the camera's frame. formats/cameras/colmap.md has the models. */
#pragma once

#include "geom/camera.h"

#include <stddef.h>
#include <stdint.h>

/* COLMAP's model of that number, or name in any letters (not ended by a zero byte); NULL where there is none.
 */
const struct lens_model *lens_model_numbered(uint32_t id);
const struct lens_model *lens_model_named(const char *name, size_t length);
const char *lens_model_name(const struct lens_model *m);

/* How many parameters a model has, and how many of the first are focal lengths. The principal point follows,
 * then what distorts. */
int lens_model_parameters(const struct lens_model *m);
int lens_model_focals(const struct lens_model *m);

/* 1 where the model is no pinhole with these parameters. */
int lens_is_distorted(const struct lens *l);

int lens_is_same(const struct lens *a, const struct lens *b);

/* The pixel in which a ray is seen. Returns 0, or -1 where it is seen in none: the model's formula is
 * followed only where it is one to one. */
int lens_project(const struct lens *l, const double ray[2], double pixel[2]);

/* The ray that a pixel shows, by a closed form or Newton's method. 0, or -1: no ray of a pinhole. */
int lens_unproject(const struct lens *l, const double pixel[2], double ray[2]);

/* Sets size and intrinsics of c to those of the pinhole that `colmap image_undistorter` makes by its own
 * choice: the same focal lengths, and the largest size, within 0.2 to 2 of the photograph's, in which each
 * border pixel shows something of it. */
void lens_pinhole(const struct lens *l, struct camera *c);

/* The same for all cameras that have a lens. */
void cameras_undistort(struct cameras *c);

/* For each pixel of the view c (height,width) that of its photograph, rows x columns, that it shows, or -1;
 * or, where is_back is not 0, for each of the photograph (l->height,l->width) that of the view. */
void lens_map(const struct lens *l, const struct camera *c, int is_back, int rows, int columns, int32_t *map);
