#include "synth/objects.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const char *const names[SYNTH_PROPERTIES][SYNTH_COLOURS + 1] = {
	{"ball", "box", "cylinder", "cone", "mug", "bowl", "plate", "book", "bottle"},
	{"red", "green", "blue", "yellow", "white", "black", "orange", "purple", "brown", "pink", "grey",
		"teal"},
	{"small", "medium", "big"},
	{"plain", "shiny", "striped", "speckled"},
};

static const double colours[SYNTH_COLOURS][3] = {{0.80, 0.08, 0.08}, {0.10, 0.55, 0.15}, {0.10, 0.22, 0.80},
	{0.95, 0.85, 0.10}, {0.95, 0.95, 0.93}, {0.07, 0.07, 0.08}, {0.98, 0.50, 0.05}, {0.48, 0.14, 0.62},
	{0.36, 0.18, 0.08}, {0.98, 0.55, 0.70}, {0.48, 0.49, 0.50}, {0.05, 0.58, 0.58}};

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

static void ball_surface(struct synth_surface *s)
{
	enum { RINGS = 18 };
	double profile[RINGS + 1][2], r = measures[SYNTH_BALL].radius;

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

void synth_object_place(const struct synth_object *o, const double point[3], double world[3])
{
	double c = cos(o->yaw), s = sin(o->yaw), x = point[0], y = point[1];

	world[0] = o->x + o->scale * (c * x - s * y);
	world[1] = o->y + o->scale * (s * x + c * y);
	world[2] = o->z + o->scale * point[2];
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

	memcpy(rgb, colours[o->colour], 3 * sizeof(double));
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
