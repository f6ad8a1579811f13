/* The things on the table: what each is, and where it stands. World units are about a decimetre and a half; z
 * is up and the table's top is z = 0, its middle the origin. */
#pragma once

#include "geom/box.h"
#include "synth/surface.h"

#include <stdint.h>

enum {
	SYNTH_MIN_OBJECTS = 2,
	SYNTH_MAX_OBJECTS = 64,
	SYNTH_NAME = 32,
};

/* Streams of random numbers, one for each purpose, so that more Gaussians leave the sentences as they are. */
enum synth_stream {
	SYNTH_STREAM_OBJECTS = 1,
	SYNTH_STREAM_CAMERAS,
	SYNTH_STREAM_GAUSSIANS,
	SYNTH_STREAM_TEXTURE,
	SYNTH_STREAM_SENTENCES,
	SYNTH_STREAM_FAULTS,
	SYNTH_STREAM_HIDING,
	SYNTH_STREAM_TEST_ERRORS,
	SYNTH_STREAM_UNSEEN = 512, /* one a kind of sentence */
	SYNTH_STREAM_VIEWS = 1024, /* candidates: one stream a view */
	SYNTH_STREAM_MOVES = 4096, /* what moves, and its sentences */
};

enum synth_shape {
	SYNTH_BALL,
	SYNTH_BOX,
	SYNTH_CYLINDER,
	SYNTH_CONE,
	SYNTH_MUG,
	SYNTH_BOWL,
	SYNTH_PLATE,
	SYNTH_BOOK,
	SYNTH_BOTTLE,
	SYNTH_SHAPES
};
enum synth_colour {
	SYNTH_RED,
	SYNTH_GREEN,
	SYNTH_BLUE,
	SYNTH_YELLOW,
	SYNTH_WHITE,
	SYNTH_BLACK,
	SYNTH_ORANGE,
	SYNTH_PURPLE,
	SYNTH_BROWN,
	SYNTH_PINK,
	SYNTH_GREY,
	SYNTH_TEAL,
	SYNTH_COLOURS
};
enum synth_size { SYNTH_SMALL, SYNTH_MEDIUM, SYNTH_BIG, SYNTH_SIZES };
enum synth_finish { SYNTH_PLAIN, SYNTH_SHINY, SYNTH_STRIPED, SYNTH_SPECKLED, SYNTH_FINISHES };
enum synth_property { SYNTH_SHAPE, SYNTH_COLOUR, SYNTH_SIZE, SYNTH_FINISH, SYNTH_PROPERTIES };

struct synth_object {
	enum synth_shape shape;
	enum synth_colour colour;
	enum synth_size size;
	enum synth_finish finish;
	double x, y, z; /* the middle of its foot */
	int on;		/* the object that it stands on; -1: the table */
	double yaw;	/* turn about the vertical, radians */
	double scale;	/* of the shape's own measures */
	double radius;	/* nothing of it is farther than this from its vertical */
	double height;
	char name[SYNTH_NAME]; /* unique: "red mug", "red mug 2" */
	char ref[SYNTH_NAME];  /* the same for names of sentences: "red-mug", "red-mug-2" */
};

struct synth_table {
	double half_width, half_depth; /* along x and y */
};

/* Sets scale, radius and height, by shape and size. */
void synth_object_measure(struct synth_object *o);

/* A part of a level plane about the object's vertical: half the sides of a rectangle that is turned with the
 * object, or (y = 0) the radius of a disc; x = 0 where there is none. */
struct synth_area {
	double x, y;
};

struct synth_area synth_object_foot(const struct synth_object *o);

/* Where another thing can stand; *z gets how high that is above the object's own foot. */
struct synth_area synth_object_top(const struct synth_object *o, double *z);

/* The surface of an object of scale 1 that stands on the origin, its underside left out. */
void synth_object_surface(struct synth_surface *s, enum synth_shape shape);

/* The point of the world that a point of that surface is. `point` and `world` may be the same. */
void synth_object_place(const struct synth_object *o, const double point[3], double world[3]);

/* What an object is in one respect, as a number of the respective enum; and its name ("red"), NULL from the
 * number of values on. */
int synth_object_value(const struct synth_object *o, enum synth_property p);
const char *synth_value_name(enum synth_property p, int value);

/* 1 where b has a's shape and colour. */
int synth_look_alike(const struct synth_object *a, const struct synth_object *b);

/* The smallest box along the world's axes, and the one that is turned with the object: along its sides, or a
 * mug's handle. What is round all about fits every turn, and has both the same. */
void synth_object_boxes(const struct synth_object *o, struct box *aligned, struct box *along_sides);
