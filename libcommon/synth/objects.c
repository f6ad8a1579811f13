#include "synth/objects.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

static const char *const shape_names[SYNTH_SHAPES] = {
	"ball", "box", "cylinder", "cone", "mug", "bowl", "plate", "book", "bottle"};

static const struct {
	const char *name;
	double rgb[3];
} colours[SYNTH_COLOURS] = {
	{"red", {0.80, 0.08, 0.08}},
	{"green", {0.10, 0.55, 0.15}},
	{"blue", {0.10, 0.22, 0.80}},
	{"yellow", {0.95, 0.85, 0.10}},
	{"white", {0.95, 0.95, 0.93}},
	{"black", {0.07, 0.07, 0.08}},
	{"orange", {0.98, 0.50, 0.05}},
	{"purple", {0.48, 0.14, 0.62}},
	{"brown", {0.36, 0.18, 0.08}},
	{"pink", {0.98, 0.55, 0.70}},
	{"grey", {0.48, 0.49, 0.50}},
	{"teal", {0.05, 0.58, 0.58}},
};

/* Radius and height at scale 1. A mug's radius includes its handle. */
static const double measures[SYNTH_SHAPES][2] = {
	[SYNTH_BALL] = {0.38, 0.76},
	[SYNTH_BOX] = {0.46, 0.55},
	[SYNTH_CYLINDER] = {0.28, 0.80},
	[SYNTH_CONE] = {0.40, 0.90},
	[SYNTH_MUG] = {0.56, 0.62},
	[SYNTH_BOWL] = {0.52, 0.34},
	[SYNTH_PLATE] = {0.62, 0.11},
	[SYNTH_BOOK] = {0.54, 0.17},
	[SYNTH_BOTTLE] = {0.24, 1.16},
};

static const double size_scales[SYNTH_SIZES] = {0.75, 1.0, 1.3};

const char *synth_shape_name(enum synth_shape s)
{
	return shape_names[s];
}

const char *synth_colour_name(enum synth_colour c)
{
	return colours[c].name;
}

static void ball_surface(struct synth_surface *s)
{
	enum { RINGS = 18 };
	double profile[RINGS + 1][2], r = measures[SYNTH_BALL][0];

	for (int i = 0; i <= RINGS; i++) {
		double turn = PI * i / RINGS;
		profile[i][0] = r * sin(turn);
		profile[i][1] = r - r * cos(turn);
	}
	synth_surface_turn(s, SYNTH_OWN, (double[3]){0}, RINGS + 1, profile);
}

void synth_object_surface(struct synth_surface *s, enum synth_shape shape)
{
	static const double origin[3] = {0};
	static const double cylinder[][2] = {{0.28, 0}, {0.28, 0.80}, {0, 0.80}};
	static const double cone[][2] = {{0.40, 0}, {0, 0.90}};
	static const double mug[][2] = {{0.32, 0}, {0.32, 0.62}, {0.27, 0.62}};
	static const double mug_inside[][2] = {{0.27, 0.62}, {0.27, 0.06}, {0, 0.06}};
	static const double bowl[][2] = {{0.20, 0}, {0.36, 0.08}, {0.47, 0.20}, {0.52, 0.34}, {0.47, 0.34}};
	static const double bowl_inside[][2] = {{0.47, 0.34}, {0.42, 0.21}, {0.31, 0.11}, {0, 0.06}};
	static const double plate[][2] = {{0.36, 0}, {0.62, 0.09}, {0.60, 0.11}, {0.38, 0.05}, {0, 0.05}};
	static const double bottle[][2] = {{0.24, 0}, {0.24, 0.62}, {0.20, 0.76}, {0.10, 0.88}, {0.10, 1.00}};
	static const double cap[][2] = {{0.12, 0.98}, {0.12, 1.16}, {0, 1.16}};

	*s = (struct synth_surface){0};
	switch (shape) {
	case SYNTH_BALL:
		ball_surface(s);
		break;
	case SYNTH_BOX:
		synth_surface_box(s, SYNTH_OWN, SYNTH_OWN, origin, 0.70, 0.58, 0.55);
		break;
	case SYNTH_CYLINDER:
		synth_surface_turn(s, SYNTH_OWN, origin, 3, cylinder);
		break;
	case SYNTH_CONE:
		synth_surface_turn(s, SYNTH_OWN, origin, 2, cone);
		break;
	case SYNTH_MUG:
		synth_surface_turn(s, SYNTH_OWN, origin, 3, mug);
		synth_surface_turn(s, SYNTH_INNER, origin, 3, mug_inside);
		synth_surface_half_ring(s, (double[3]){0.32, 0, 0.32}, 0.185, 0.05);
		break;
	case SYNTH_BOWL:
		synth_surface_turn(s, SYNTH_OWN, origin, 5, bowl);
		synth_surface_turn(s, SYNTH_INNER, origin, 4, bowl_inside);
		break;
	case SYNTH_PLATE:
		synth_surface_turn(s, SYNTH_OWN, origin, 5, plate);
		break;
	case SYNTH_BOOK:
		synth_surface_box(s, SYNTH_OWN, SYNTH_PAGES, origin, 0.86, 0.62, 0.17);
		/* The spine is bound like the cover. */
		s->patches[3].tint = SYNTH_OWN;
		break;
	case SYNTH_BOTTLE:
		synth_surface_turn(s, SYNTH_OWN, origin, 5, bottle);
		synth_surface_turn(s, SYNTH_CAP, origin, 3, cap);
		break;
	case SYNTH_SHAPES:
		break;
	}
}

static void mix(double rgb[3], const double with[3], double share)
{
	for (int k = 0; k < 3; k++)
		rgb[k] += share * (with[k] - rgb[k]);
}

void synth_object_colour(const struct synth_object *o, enum synth_tint tint, const double point[3],
	const struct synth_noise *texture, double rgb[3])
{
	static const double pages[3] = {0.90, 0.87, 0.76}, cap[3] = {0.20, 0.20, 0.22},
			    pale[3] = {0.96, 0.96, 0.94}, dark[3] = {0.25, 0.25, 0.27}, night[3] = {0};
	int is_pale = o->colour == SYNTH_WHITE || o->colour == SYNTH_YELLOW || o->colour == SYNTH_PINK;
	const double *second = is_pale ? dark : pale;

	memcpy(rgb, colours[o->colour].rgb, 3 * sizeof(double));
	if (tint == SYNTH_PAGES)
		memcpy(rgb, pages, sizeof pages);
	else if (tint == SYNTH_CAP)
		memcpy(rgb, cap, sizeof cap);
	else if (tint == SYNTH_INNER)
		mix(rgb, night, 0.35);
	if (tint != SYNTH_OWN)
		return;
	if (o->finish == SYNTH_STRIPED) {
		/* Up an upright thing, across a flat one. */
		double at = o->shape == SYNTH_BOOK || o->shape == SYNTH_PLATE ? point[0] : point[2];
		double phase = at / 0.24 - floor(at / 0.24);
		if (phase > 0.6)
			mix(rgb, second, 0.75);
	} else if (o->finish == SYNTH_SPECKLED) {
		double at =
			synth_noise_at(texture, 13 * point[0] + 9 * point[2], 13 * point[1] - 9 * point[2]);
		if (at > 0.33)
			mix(rgb, second, 0.7);
	}
}

static void name_objects(struct synth_object *objects, int n)
{
	for (int i = 0; i < n; i++) {
		struct synth_object *o = &objects[i];
		int count = 1;
		for (int j = 0; j < i; j++)
			count += objects[j].shape == o->shape && objects[j].colour == o->colour;
		const char *colour = synth_colour_name(o->colour), *shape = synth_shape_name(o->shape);
		if (count == 1) {
			snprintf(o->name, sizeof o->name, "%s %s", colour, shape);
			snprintf(o->ref, sizeof o->ref, "%s-%s", colour, shape);
		} else {
			snprintf(o->name, sizeof o->name, "%s %s %d", colour, shape, count);
			snprintf(o->ref, sizeof o->ref, "%s-%s-%d", colour, shape, count);
		}
	}
}

/* Kinds of things: a twin of an earlier one, or a kind of its own that shares colour or shape with some
 * others. */
static void choose_kinds(struct synth_object *objects, int n, struct rng *r)
{
	int twins = n >= 5 ? n / 4 : 0;

	for (int i = 0; i < n; i++) {
		struct synth_object *o = &objects[i];
		if (i >= n - twins) {
			*o = objects[i - (n - twins)];
			continue;
		}
		int is_new;
		do {
			o->shape = (enum synth_shape)rng_below(r, SYNTH_SHAPES);
			o->colour = (enum synth_colour)rng_below(r, SYNTH_COLOURS);
			is_new = 1;
			int same_shape = 0;
			for (int j = 0; j < i; j++) {
				is_new &= objects[j].shape != o->shape || objects[j].colour != o->colour;
				same_shape += objects[j].shape == o->shape;
			}
			is_new &= same_shape <= i / 4;
		} while (!is_new);
		o->size = (enum synth_size)rng_below(r, SYNTH_SIZES);
		/* Seven in ten are of one colour all over. */
		uint32_t lot = rng_below(r, 20);
		o->finish = lot < 8    ? SYNTH_PLAIN
			    : lot < 14 ? SYNTH_SHINY
			    : lot < 17 ? SYNTH_STRIPED
				       : SYNTH_SPECKLED;
	}
}

static int fits(const struct synth_object *objects, int i, double gap)
{
	for (int j = 0; j < i; j++) {
		double need = objects[i].radius + objects[j].radius + gap;
		if (hypot(objects[i].x - objects[j].x, objects[i].y - objects[j].y) < need)
			return 0;
	}
	return 1;
}

/* Random places, from the start again where one object finds none. */
static int place(struct synth_object *objects, int n, const struct synth_table *table, struct rng *r)
{
	for (int i = 0; i < n; i++) {
		struct synth_object *o = &objects[i];
		double w = table->half_width - o->radius - 0.05, d = table->half_depth - o->radius - 0.05;
		int tries = 0;
		do {
			if (tries++ == 200)
				return 0;
			o->x = rng_range(r, -w, w);
			o->y = rng_range(r, -d, d);
		} while (!fits(objects, i, 0.08));
		o->yaw = rng_range(r, -PI, PI);
	}
	return 1;
}

void synth_objects_make(struct synth_object *objects, int n, struct synth_table *table, uint64_t seed)
{
	struct rng r;

	rng_seed(&r, seed, SYNTH_STREAM_OBJECTS);
	memset(objects, 0, (size_t)n * sizeof *objects);
	choose_kinds(objects, n, &r);
	for (int i = 0; i < n; i++) {
		struct synth_object *o = &objects[i];
		o->on = -1;
		o->scale = size_scales[o->size];
		o->radius = o->scale * measures[o->shape][0];
		o->height = o->scale * measures[o->shape][1];
	}
	*table = (struct synth_table){fmax(1.7, 2.2 * sqrt(n / 8.0)), fmax(1.2, 1.55 * sqrt(n / 8.0))};
	for (int tries = 1; !place(objects, n, table, &r); tries++)
		if (tries % 20 == 0) {
			table->half_width *= 1.05;
			table->half_depth *= 1.05;
		}
	name_objects(objects, n);
}
