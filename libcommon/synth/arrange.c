#include "synth/presets.h"

#include "base/rng.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

enum {
	STACK_TRIES = 2000, /* of drawing a support and its load at random */
	KIND_TRIES = 100,   /* of drawing kinds among which enough fit on each other */
	PLACE_TRIES = 200,  /* of finding a place for one thing */
};

static void name_objects(struct synth_object *objects, int n)
{
	for (int i = 0; i < n; i++) {
		struct synth_object *o = &objects[i];
		int count = 1;
		for (int j = 0; j < i; j++)
			count += synth_look_alike(&objects[j], o);
		const char *colour = synth_value_name(SYNTH_COLOUR, (int)o->colour);
		const char *shape = synth_value_name(SYNTH_SHAPE, (int)o->shape);
		int end = snprintf(o->name, sizeof o->name, "%s %s", colour, shape);
		if (count > 1)
			snprintf(o->name + end, sizeof o->name - (size_t)end, " %d", count);
		memcpy(o->ref, o->name, sizeof o->ref);
		for (char *p = strchr(o->ref, ' '); p; p = strchr(p, ' '))
			*p = '-';
	}
}

static enum synth_finish draw_finish(struct rng *r)
{
	/* Seven in ten are of one colour all over. */
	static const int lots[SYNTH_FINISHES] = {
		[SYNTH_PLAIN] = 8, [SYNTH_SHINY] = 6, [SYNTH_STRIPED] = 3, [SYNTH_SPECKLED] = 3};

	return (enum synth_finish)rng_draw(r, lots, SYNTH_FINISHES);
}

/* Objects in the making: those of one kind are of one group. */
struct heap {
	struct synth_object *objects;
	int n;
	int groups[SYNTH_MAX_OBJECTS];	   /* the first object of its kind */
	int on[SYNTH_MAX_OBJECTS];	   /* as synth_object.on */
	int loads[SYNTH_MAX_OBJECTS];	   /* what stands on it, or -1 */
	double from[SYNTH_MAX_OBJECTS][2]; /* a load's place on its support, before that is turned */
};

/* A shape and colour that no object before i has, in which shapes do not repeat too often. */
static void draw_kind(struct heap *h, int i, const struct synth_preset *preset, struct rng *r)
{
	struct synth_object *o = &h->objects[i];
	int is_new;

	do {
		int kinds = 0, same_shape = 0;
		o->shape = (enum synth_shape)rng_draw(r, preset->shapes, SYNTH_SHAPES);
		o->colour = (enum synth_colour)rng_below(r, SYNTH_COLOURS);
		is_new = 1;
		for (int j = 0; j < i; j++) {
			if (h->groups[j] != j)
				continue;
			kinds++;
			same_shape += h->objects[j].shape == o->shape;
			is_new &= !synth_look_alike(&h->objects[j], o);
		}
		is_new &= same_shape <= kinds / 3;
	} while (!is_new);
	o->size = (enum synth_size)rng_draw(r, preset->sizes, SYNTH_SIZES);
	o->finish = draw_finish(r);
}

static void draw_kinds(struct heap *h, const struct synth_preset *preset, struct rng *r)
{
	int alike = h->n >= 4 ? (h->n + 1) / 2 : 0;

	memset(h->objects, 0, (size_t)h->n * sizeof *h->objects);
	for (int i = 0; i < h->n;) {
		int left = alike - i, group = 1;
		if (left >= 2)
			group = left == 3 ? 3 : left == 2 || left == 4 ? 2 : 2 + (int)rng_below(r, 2);
		draw_kind(h, i, preset, r);
		h->groups[i] = i;
		for (int k = 1; k < group; k++) {
			h->objects[i + k] = h->objects[i];
			h->groups[i + k] = i;
			if (rng_below(r, 6) == 0)
				h->objects[i + k].finish = draw_finish(r);
		}
		i += group;
	}
}

/* How far the middle of a foot may be from the middle of a top along either axis, where the foot is turned by
 * `turn` against the top: with a little to spare. Negative where it does not fit. */
static void room_on(struct synth_area foot, struct synth_area top, double turn, double room[2])
{
	static const double spare = 0.02;
	double c = fabs(cos(turn)), s = fabs(sin(turn)), extent[2] = {foot.x, foot.x};

	if (foot.y > 0) {
		extent[0] = c * foot.x + s * foot.y;
		extent[1] = s * foot.x + c * foot.y;
	}
	if (top.y > 0) {
		room[0] = top.x - extent[0] - spare;
		room[1] = top.y - extent[1] - spare;
	} else {
		/* The corner of the square of places lies in the disc. */
		double reach = foot.y > 0 ? hypot(foot.x, foot.y) : foot.x;
		room[0] = room[1] = (top.x - reach - spare) * sqrt(0.5);
	}
}

static void resize(struct heap *h, int group, enum synth_size size)
{
	for (int i = 0; i < h->n; i++)
		if (h->groups[i] == group)
			h->objects[i].size = size;
}

/* Puts object i on object k, where that is possible: what carries is not small, what is carried is, and so is
 * everything of its kind. */
static int stack(struct heap *h, int i, int k, const int *fixed, struct rng *r)
{
	struct synth_object *load = &h->objects[i], *support = &h->objects[k];
	int group = h->groups[i], under = h->groups[k];
	struct synth_object small = *load, large = *support;
	double room[2], z;

	if (group == under || h->on[i] >= 0 || h->loads[i] >= 0 || h->on[k] >= 0 || h->loads[k] >= 0)
		return 0;
	small.size = SYNTH_SMALL;
	large.size = !fixed[under] && large.size == SYNTH_SMALL ? SYNTH_MEDIUM : large.size;
	if ((fixed[group] && load->size != SYNTH_SMALL) || large.size == SYNTH_SMALL)
		return 0;
	synth_object_measure(&small);
	synth_object_measure(&large);
	struct synth_area top = synth_object_top(&large, &z);
	/* Things with corners lie about parallel to what has some too. */
	double turn = rng_range(r, -0.15, 0.15);
	room_on(synth_object_foot(&small), top, turn, room);
	/* Enough of what carries is to be seen. */
	if (room[0] < 0 || room[1] < 0 || small.radius > 0.72 * large.radius)
		return 0;
	resize(h, group, SYNTH_SMALL);
	resize(h, under, large.size);
	h->from[i][0] = room[0] * rng_range(r, -1, 1);
	h->from[i][1] = room[1] * rng_range(r, -1, 1);
	load->yaw = synth_object_foot(&small).y > 0 && top.y > 0 ? turn : rng_range(r, -PI, PI);
	h->on[i] = k;
	h->loads[k] = i;
	return 1;
}

/* Returns 1 where `wanted` things found a thing to stand on. */
static int stack_some(struct heap *h, int wanted, struct rng *r)
{
	int fixed[SYNTH_MAX_OBJECTS] = {0}; /* groups whose size must stay */

	for (int i = 0; i < h->n; i++)
		h->on[i] = h->loads[i] = -1;
	for (int tries = 0; tries < STACK_TRIES && wanted; tries++) {
		int i = (int)rng_below(r, (uint32_t)h->n), k = (int)rng_below(r, (uint32_t)h->n);
		if (i == k || !stack(h, i, k, fixed, r))
			continue;
		fixed[h->groups[i]] = fixed[h->groups[k]] = 1;
		wanted--;
	}
	return !wanted;
}

/* How far from the vertical of an object on the table anything of it and of its load is. */
static double reach(const struct heap *h, int i)
{
	int load = h->loads[i];

	if (load < 0)
		return h->objects[i].radius;
	return fmax(
		h->objects[i].radius, hypot(h->from[load][0], h->from[load][1]) + h->objects[load].radius);
}

static int fits(const struct heap *h, int i, double gap)
{
	const struct synth_object *o = h->objects;

	for (int j = 0; j < i; j++)
		if (h->on[j] < 0 && hypot(o[i].x - o[j].x, o[i].y - o[j].y) < reach(h, i) + reach(h, j) + gap)
			return 0;
	return 1;
}

/* Random places on the table; 0 where an object finds none. */
static int place(struct heap *h, const struct synth_table *table, struct rng *r)
{
	for (int i = 0; i < h->n; i++) {
		struct synth_object *o = &h->objects[i];
		if (h->on[i] >= 0)
			continue;
		double w = table->half_width - reach(h, i) - 0.05, d = table->half_depth - reach(h, i) - 0.05;
		int tries = 0;
		do {
			if (tries++ == PLACE_TRIES)
				return 0;
			o->x = rng_range(r, -w, w);
			o->y = rng_range(r, -d, d);
		} while (!fits(h, i, 0.08));
		o->yaw = rng_range(r, -PI, PI);
	}
	return 1;
}

/* Loads go where their supports are by now. */
static void place_loads(struct heap *h)
{
	for (int i = 0; i < h->n; i++) {
		struct synth_object *o = &h->objects[i];
		o->on = h->on[i];
		if (o->on < 0)
			continue;
		const struct synth_object *support = &h->objects[o->on];
		double c = cos(support->yaw), s = sin(support->yaw), *from = h->from[i];
		synth_object_top(support, &o->z);
		o->z += support->z;
		o->x = support->x + c * from[0] - s * from[1];
		o->y = support->y + s * from[0] + c * from[1];
		o->yaw += support->yaw;
	}
}

/* As large as what stands on it needs. */
static struct synth_table fitting_table(const struct heap *h, const struct synth_preset *preset)
{
	double area = 0;

	for (int i = 0; i < h->n; i++)
		if (h->on[i] < 0)
			area += PI * pow(reach(h, i) + 0.04, 2);
	double half_depth = sqrt(area / (4 * preset->filled * preset->aspect));
	return (struct synth_table){fmax(1.6, preset->aspect * half_depth), fmax(1.2, half_depth)};
}

void synth_arrange(struct synth_object *objects, int n, struct synth_table *table,
	const struct synth_preset *preset, uint64_t seed)
{
	int stacked = preset->is_stacked ? (n + 2) / 6 : 0;
	struct heap h = {.objects = objects, .n = n};
	struct rng r;

	rng_seed(&r, seed, SYNTH_STREAM_OBJECTS);
	for (int tries = 0; tries < KIND_TRIES; tries++) {
		draw_kinds(&h, preset, &r);
		if (stack_some(&h, stacked, &r))
			break;
	}
	for (int i = 0; i < n; i++)
		synth_object_measure(&objects[i]);
	*table = fitting_table(&h, preset);
	for (int tries = 1; !place(&h, table, &r); tries++)
		if (tries % 20 == 0) {
			table->half_width *= 1.05;
			table->half_depth *= 1.05;
		}
	place_loads(&h);
	name_objects(objects, n);
}

static const struct synth_preset presets[SYNTH_PRESETS] = {
#include "synth/presets.def"
};

const struct synth_preset *synth_preset(int number)
{
	return number >= 0 && number < SYNTH_PRESETS ? &presets[number] : NULL;
}

uint64_t synth_preset_seed(int number, uint64_t seed, int attempt)
{
	/* Odd constants far from small seeds: the golden ratio's, and one of splitmix64's. */
	return seed + (uint64_t)number * 0x9e3779b97f4a7c15u + (uint64_t)attempt * 0xbf58476d1ce4e5b9u;
}
