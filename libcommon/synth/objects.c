#include "synth/objects.h"

#include "geom/vector.h"

#include <math.h>
#include <stddef.h>

static const char *const names[SYNTH_PROPERTIES][SYNTH_COLOURS + 1] = {
	{"ball", "box", "cylinder", "cone", "mug", "bowl", "plate", "book", "bottle"},
	{"red", "green", "blue", "yellow", "white", "black", "orange", "purple", "brown", "pink", "grey",
		"teal"},
	{"small", "medium", "big"},
	{"plain", "shiny", "striped", "speckled"},
};

/* At scale 1. A mug's radius includes its handle. */
static const struct {
	double radius, height;
	struct synth_area foot;
	struct synth_area top; /* what another thing can stand on */
	double top_z;
} measures[SYNTH_SHAPES] = {
	/* A ball touches in a point; a little more keeps it from looking as if it would roll off. */
	[SYNTH_BALL] = {0.38, 0.76, {0.18, 0}, {0, 0}, 0},
	[SYNTH_BOX] = {0.46, 0.55, {0.35, 0.29}, {0.35, 0.29}, 0.55},
	[SYNTH_CYLINDER] = {0.28, 0.80, {0.28, 0}, {0, 0}, 0},
	[SYNTH_CONE] = {0.40, 0.90, {0.40, 0}, {0, 0}, 0},
	[SYNTH_MUG] = {0.56, 0.62, {0.32, 0}, {0, 0}, 0},
	[SYNTH_BOWL] = {0.52, 0.34, {0.20, 0}, {0, 0}, 0},
	[SYNTH_PLATE] = {0.62, 0.11, {0.36, 0}, {0.38, 0}, 0.05},
	[SYNTH_BOOK] = {0.54, 0.17, {0.43, 0.31}, {0.43, 0.31}, 0.17},
	[SYNTH_BOTTLE] = {0.24, 1.16, {0.24, 0}, {0, 0}, 0},
};

static const double size_scales[SYNTH_SIZES] = {0.75, 1.0, 1.3};

void synth_object_measure(struct synth_object *o)
{
	o->scale = size_scales[o->size];
	o->radius = o->scale * measures[o->shape].radius;
	o->height = o->scale * measures[o->shape].height;
}

struct synth_area synth_object_foot(const struct synth_object *o)
{
	struct synth_area a = measures[o->shape].foot;

	return (struct synth_area){o->scale * a.x, o->scale * a.y};
}

struct synth_area synth_object_top(const struct synth_object *o, double *z)
{
	struct synth_area a = measures[o->shape].top;

	*z = o->scale * measures[o->shape].top_z;
	return (struct synth_area){o->scale * a.x, o->scale * a.y};
}

int synth_object_value(const struct synth_object *o, enum synth_property p)
{
	const int values[SYNTH_PROPERTIES] = {(int)o->shape, (int)o->colour, (int)o->size, (int)o->finish};

	return values[p];
}

const char *synth_value_name(enum synth_property p, int value)
{
	return names[p][value];
}

int synth_look_alike(const struct synth_object *a, const struct synth_object *b)
{
	return a->shape == b->shape && a->colour == b->colour;
}

/* What is turned about the vertical: (radius, height) from below. */
static const struct {
	enum synth_shape shape;
	enum synth_tint tint;
	int n;
	double profile[5][2];
} turned[] = {
	{SYNTH_CYLINDER, SYNTH_OWN, 3, {{0.28, 0}, {0.28, 0.80}, {0, 0.80}}},
	{SYNTH_CONE, SYNTH_OWN, 2, {{0.40, 0}, {0, 0.90}}},
	{SYNTH_MUG, SYNTH_OWN, 3, {{0.32, 0}, {0.32, 0.62}, {0.27, 0.62}}},
	{SYNTH_MUG, SYNTH_INNER, 3, {{0.27, 0.62}, {0.27, 0.06}, {0, 0.06}}},
	{SYNTH_BOWL, SYNTH_OWN, 5, {{0.20, 0}, {0.36, 0.08}, {0.47, 0.20}, {0.52, 0.34}, {0.47, 0.34}}},
	{SYNTH_BOWL, SYNTH_INNER, 4, {{0.47, 0.34}, {0.42, 0.21}, {0.31, 0.11}, {0, 0.06}}},
	{SYNTH_PLATE, SYNTH_OWN, 5, {{0.36, 0}, {0.62, 0.09}, {0.60, 0.11}, {0.38, 0.05}, {0, 0.05}}},
	{SYNTH_BOTTLE, SYNTH_OWN, 5, {{0.24, 0}, {0.24, 0.62}, {0.20, 0.76}, {0.10, 0.88}, {0.10, 1.00}}},
	{SYNTH_BOTTLE, SYNTH_CAP, 3, {{0.12, 0.98}, {0.12, 1.16}, {0, 1.16}}},
};

void synth_object_surface(struct synth_surface *s, enum synth_shape shape)
{
	enum { RINGS = 18 };
	static const double origin[3] = {0};
	double ball[RINGS + 1][2], r = measures[SYNTH_BALL].radius;

	*s = (struct synth_surface){0};
	for (size_t i = 0; i < sizeof turned / sizeof *turned; i++)
		if (turned[i].shape == shape)
			synth_surface_turn(s, turned[i].tint, origin, turned[i].n, turned[i].profile);
	if (shape == SYNTH_BALL) {
		for (int i = 0; i <= RINGS; i++) {
			ball[i][0] = r * sin(PI * i / RINGS);
			ball[i][1] = r - r * cos(PI * i / RINGS);
		}
		synth_surface_turn(s, SYNTH_OWN, origin, RINGS + 1, (const double(*)[2])ball);
	} else if (shape == SYNTH_BOX) {
		synth_surface_box(s, SYNTH_OWN, SYNTH_OWN, origin, 0.70, 0.58, 0.55);
	} else if (shape == SYNTH_MUG) {
		synth_surface_half_ring(s, (double[3]){0.32, 0, 0.32}, 0.185, 0.05);
	} else if (shape == SYNTH_BOOK) {
		synth_surface_box(s, SYNTH_OWN, SYNTH_PAGES, origin, 0.86, 0.62, 0.17);
		/* The spine is bound like the cover. */
		s->patches[3].tint = SYNTH_OWN;
	}
}

void synth_object_place(const struct synth_object *o, const double point[3], double world[3])
{
	double c = cos(o->yaw), s = sin(o->yaw), x = point[0], y = point[1];

	world[0] = o->x + o->scale * (c * x - s * y);
	world[1] = o->y + o->scale * (s * x + c * y);
	world[2] = o->z + o->scale * point[2];
}

/* The smallest box around o along x and y axes that are turned by `angle`. */
static struct box box_at(const struct synth_object *o, const struct synth_surface *s, double angle)
{
	const double c = cos(angle), n = sin(angle);
	struct box b = {{o->x, o->y, o->z}, {{c, n, 0}, {-n, c, 0}, {0, 0, 1}}, {0}};
	const double turn = angle - o->yaw; /* from the surface's own axes */
	const double axes[3][3] = {{cos(turn), sin(turn), 0}, {-sin(turn), cos(turn), 0}, {0, 0, 1}};

	for (int k = 0; k < 3; k++) {
		const double back[3] = {-axes[k][0], -axes[k][1], -axes[k][2]};
		double high = o->scale * synth_surface_reach(s, axes[k]);
		double low = -o->scale * synth_surface_reach(s, back);
		b.half[k] = (high - low) / 2;
		for (int d = 0; d < 3; d++)
			b.centre[d] += (high + low) / 2 * b.axes[k][d];
	}
	return b;
}

void synth_object_boxes(const struct synth_object *o, struct box *aligned, struct box *along_sides)
{
	struct synth_surface s;

	synth_object_surface(&s, o->shape);
	*aligned = box_at(o, &s, 0);
	*along_sides = o->shape == SYNTH_BOX || o->shape == SYNTH_BOOK || o->shape == SYNTH_MUG
			       ? box_at(o, &s, o->yaw)
			       : *aligned;
}
