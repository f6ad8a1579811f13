/* Where a sentence is said: what left, right, front and behind are seen from. */
#pragma once

#include "geom/camera.h"

struct viewpoint {
	enum { VIEWPOINT_USUAL, VIEWPOINT_CAMERA, VIEWPOINT_POINT } kind;
	const struct camera *camera; /* of VIEWPOINT_CAMERA: as seen in its picture */
	double point[3]; /* of VIEWPOINT_POINT, in the scene: looking level at the middle of the objects */
	int is_facing;	 /* from there, but looking level at `faced`: "when facing the window" */
	double faced[3];
};

/* axes: the rows right, away and up, of which the last is the scene's up; eye: where they are seen from. The
 * usual viewpoint is the mean of the training cameras' centres (of all, where none is for training), looking
 * level along the mean of their directions. middle: of the objects. What is nearer than `least` to right
 * above or below is no direction to turn to. */
void viewpoint_axes(const struct viewpoint *v, const struct cameras *cameras, const double middle[3],
	double least, double axes[3][3], double eye[3]);

int viewpoint_is_same(const struct viewpoint *a, const struct viewpoint *b);

/* The name of a view, or "x,y,z" in the world that the scene was imported from, whose origin is at -offset.
 * 0, or -1 where it is neither. */
int viewpoint_read(
	struct viewpoint *v, const char *text, const struct cameras *cameras, const double offset[3]);
