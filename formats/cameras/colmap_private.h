/* What the readers of COLMAP's two forms share: colmap.c has the binary one and the folder, colmap_text.c the
 * other. formats/cameras/colmap.md. */
#pragma once

#include "formats/cameras/colmap.h"
#include "geom/lens.h"

#include <stddef.h>
#include <stdint.h>

struct colmap_entry {
	uint32_t id;
	struct camera camera; /* size, intrinsics and lens only */
};

struct colmap_entries {
	size_t n, capacity;
	struct colmap_entry *items;
};

/* Where the model distorts, the pinhole is of its focal lengths and principal point until lens_pinhole finds
 * it. This and what follows: 0, or -1 with *e. */
int colmap_set_camera(struct colmap_entry *c, const struct lens_model *m, double width, double height,
	const double *params, const char *path, struct err *e);
int colmap_add_entry(
	struct colmap_entries *all, const struct colmap_entry *c, const char *path, struct err *e);

/* Adds a view: pose is qw qx qy qz tx ty tz, world to camera. */
int colmap_add_view(struct cameras *c, size_t *capacity, const struct colmap_entries *all,
	const double pose[7], uint32_t camera, const char *image, const char *path, struct err *e);

int colmap_read_cameras_text(struct colmap_entries *all, const char *path, struct err *e);
int colmap_read_images_text(
	struct cameras *c, const struct colmap_entries *all, const char *path, struct err *e);

int colmap_add_point(struct colmap_points *p, size_t *room, const double place[3], const double color[3],
	const char *path, struct err *e);
int colmap_read_points_text(struct colmap_points *p, const char *path, struct err *e);
