#include "synth/synth_scene.h"

#include "base/mem.h"
#include "base/rng.h"
#include "geom/vector.h"
#include "synth/cameras.h"
#include "synth/noise.h"
#include "synth/shading.h"

#include <math.h>

/* With its middle so many deviations inside an edge, the edge is where an opaque Gaussian begins to fade. */
static const double inside = 1.1;

/* In the world as it is. */
static const struct synth_object unmoved = {.scale = 1};

/* What is being filled in: the next Gaussian's number goes up as Gaussians are put. */
struct work {
	struct synth_scene *s;
	struct synth_noise texture;
	struct rng rng;
	size_t next;
};

/* A surface to be covered. */
struct coat {
	int owner;			   /* -1: the table or the room */
	const struct synth_object *object; /* that the surface is of, or unmoved */
	int is_table;
	struct synth_surface surface;
	double gloss;
	double longest; /* more than that a Gaussian is only where there are too few to cover; 0: any length
			 */
};

/* A Gaussian in the making: its extents along and across its place's tangent, and out of the surface. */
struct grain {
	double side[2], thick, opacity;
};

/* The rotation that takes z to n and x as near to `along` as then can be, as a quaternion (w,x,y,z). */
static void frame_quaternion(const double n[3], const double along[3], float q[4])
{
	/* The shortest turn from z to n, after a turn about z. */
	double w = 1 + n[2], x = -n[1], y = n[0], x_axis[3] = {1, 0, 0}, y_axis[3] = {0, -1, 0};

	if (w < 1e-9) {
		w = 0;
		x = 1;
		y = 0;
	} else {
		x_axis[0] = 1 - n[0] * n[0] / w;
		x_axis[1] = y_axis[0] = -n[0] * n[1] / w;
		x_axis[2] = -n[0];
		y_axis[1] = 1 - n[1] * n[1] / w;
		y_axis[2] = -n[1];
	}
	double turn = atan2(vector_dot(along, y_axis), vector_dot(along, x_axis));
	double length = sqrt(w * w + x * x + y * y), c = cos(turn / 2) / length, s = sin(turn / 2) / length;
	q[0] = (float)(w * c);
	q[1] = (float)(x * c + y * s);
	q[2] = (float)(y * c - x * s);
	q[3] = (float)(w * s);
}

static void put(struct work *w, int owner, const double mean[3], const struct grain *g,
	const double normal[3], const double along[3], const double rgb[3], double gloss)
{
	struct splats *p = &w->s->splats;
	size_t i = w->next++;

	for (int k = 0; k < 3; k++)
		p->means[3 * i + (size_t)k] = (float)mean[k];
	p->scales[3 * i] = (float)g->side[0];
	p->scales[3 * i + 1] = (float)g->side[1];
	p->scales[3 * i + 2] = (float)g->thick;
	frame_quaternion(normal, along, p->quats + 4 * i);
	p->opacities[i] = (float)g->opacity;
	synth_harmonics(p->sh + 3 * SYNTH_SH_COEFFICIENTS * i, rgb, normal, gloss);
	w->s->owner[i] = owner;
}

/* Exp of the size of a normal number: how many times larger the largest side is than the next, with a long
 * tail. The median is exp(0.67 spread). */
static double ratio(struct rng *r, double spread)
{
	return exp(spread * fabs(rng_normal(r)));
}

/* Of those that cover: nearly opaque, never so thin that they leave holes. Some on flat ground are large. */
static struct grain covering(double spacing, struct rng *r)
{
	double size = 0.66 * spacing * exp(0.15 * rng_normal(r)), aspect = sqrt(fmin(ratio(r, 0.9), 5));
	double times = rng_below(r, 30) ? 1 : 2.5;
	struct grain g = {.side = {times * (size * aspect), times * (size / aspect)}};

	g.thick = fmin(g.side[0], g.side[1]) / ratio(r, 1.8);
	g.opacity = rng_below(r, 4) ? 1 - 0.09 * pow(rng_uniform(r), 3) : rng_range(r, 0.5, 0.95);
	return g;
}

/* Of the others: what training adds for details, and does not take away again. */
static struct grain detailing(double spacing, struct rng *r)
{
	double u = rng_uniform(r);
	struct grain g = {.side[0] = 0.75 * spacing * exp(0.55 * rng_normal(r))};

	g.side[1] = g.side[0] / ratio(r, 2.1);
	g.thick = g.side[1] / ratio(r, 1.7);
	g.opacity = u < 0.62   ? 0.005 * pow(20, rng_uniform(r))
		    : u < 0.94 ? 0.1 + 0.4 * pow(rng_uniform(r), 2)
			       : rng_range(r, 0.5, 1);
	return g;
}

/* How long something flat may be where the surface bends, so as not to stand off it by more than a trifle. */
static double straight(double bend, double spacing)
{
	return fmax(0.66 * spacing, sqrt(0.003 * bend));
}

/* Nobody has seen what is under an object's foot, so that nothing of it is in a trained scene, and what is
 * close to a foot is small. Moves a level point from under a foot to beside it; returns how far it is then
 * from the nearest. */
static double clear_feet(struct work *w, int owner, double spacing, double point[3])
{
	double nearest = INFINITY, push = fmin(1.5 * spacing, 0.04) * rng_uniform(&w->rng);

	for (int i = 0; i < w->s->object_count && !w->s->is_moving; i++) {
		const struct synth_object *o = &w->s->objects[i];
		if (i == owner || fabs(o->z - point[2]) > 0.02)
			continue;
		double dx = point[0] - o->x, dy = point[1] - o->y, distance = hypot(dx, dy), edge;
		double x = fabs(cos(o->yaw) * dx + sin(o->yaw) * dy),
		       y = fabs(cos(o->yaw) * dy - sin(o->yaw) * dx);
		struct synth_area foot = synth_object_foot(o);
		if (foot.y > 0) /* how much longer the way from the middle is than to the rectangle's edge */
			edge = distance * (1 - 1 / fmax(fmax(x / foot.x, y / foot.y), 0.01));
		else
			edge = distance - foot.x;
		if (edge < 0 && distance > 1e-6) {
			double factor = 1 + (push - edge) / distance;
			point[0] = o->x + factor * dx;
			point[1] = o->y + factor * dy;
			edge = push;
		}
		nearest = fmin(nearest, edge);
	}
	return nearest;
}

static void turn_level(double angle, const double v[3], double out[3])
{
	out[0] = cos(angle) * v[0] - sin(angle) * v[1];
	out[1] = sin(angle) * v[0] + cos(angle) * v[1];
	out[2] = v[2];
}

/* The longest that a Gaussian may be along and across a spot, neither to reach over an edge nor to stand off.
 * `point`, the spot in the world, may move. */
static void limit(struct work *w, const struct coat *c, const struct synth_spot *spot, double spacing,
	double point[3], double most[2])
{
	double scale = c->object->scale, clear = INFINITY;

	if (spot->normal[2] > 0.99)
		clear = fmax(0.4 * spacing, 0.8 * clear_feet(w, c->owner, spacing, point));
	for (int k = 0; k < 2; k++)
		most[k] = fmin(clear,
			fmin(scale * spot->room[k] / inside, straight(scale * spot->bend[k], spacing)));
}

/* Lays one Gaussian on the spot of (a,b). */
static void lay(struct work *w, const struct coat *c, struct grain g, double spacing, double a, double b)
{
	const struct synth_object *o = c->object;
	struct rng *r = &w->rng;
	double point[3], normal[3], tangent[3], aside[3], most[2], mean[3], tilted[3], along[3], rgb[3],
		turn = 0;
	double cap = c->longest > 0 ? fmax(c->longest, 0.66 * spacing) : INFINITY;
	int is_turned = (int)rng_below(r, 2);
	struct synth_spot spot;

	g = (struct grain){{fmin(g.side[is_turned], cap), fmin(g.side[!is_turned], cap)}, g.thick, g.opacity};
	double longest = fmax(g.side[0], g.side[1]);
	synth_surface_spot(
		&c->surface, a, b, inside * fmin(longest, straight(0.3, spacing)) / o->scale, &spot);
	turn_level(o->yaw, spot.normal, normal);
	turn_level(o->yaw, spot.along, tangent);
	vector_cross(normal, tangent, aside);
	synth_object_place(o, spot.point, point);
	limit(w, c, &spot, spacing, point, most);
	if (longest <= fmin(most[0], most[1]))
		turn = rng_range(r, 0, 2 * PI);
	for (int k = 0; k < 2; k++)
		g.side[k] = fmin(g.side[k], most[k]);
	g.thick = fmin(fmin(g.thick, 0.3 * spacing), fmin(g.side[0], g.side[1]));
	synth_albedo(w->s, &w->texture, c->owner, c->is_table, &spot, point, rgb);
	double shade = synth_shade(normal) + 0.02 * rng_normal(r);
	double tilt = 0.07 * fmin(1, spacing / fmax(g.side[0], g.side[1]));
	for (int k = 0; k < 3; k++) {
		rgb[k] = fmin(1, fmax(0, rgb[k] * shade + 0.012 * rng_normal(r)));
		tilted[k] = normal[k] + tilt * rng_normal(r);
		along[k] = cos(turn) * tangent[k] + sin(turn) * aside[k];
		mean[k] = point[k] - g.thick * normal[k];
	}
	vector_normalise(tilted);
	put(w, c->owner, mean, &g, tilted, along, rgb, c->gloss);
}

/* The i-th point of an evenly spread sequence in the unit square (R2, of the plastic number), shaken. */
static void spread(size_t i, struct rng *r, double *a, double *b)
{
	double x = 0.7548776662466927 * (double)(i + 1) + 0.08 * rng_uniform(r) / sqrt((double)(i + 1));
	double y = 0.5698402909980532 * (double)(i + 1);

	*a = x - floor(x);
	*b = y - floor(y);
}

/* n Gaussians: those that cover the surface, evenly spread, and among them the others. */
static void put_coat(struct work *w, const struct coat *c, size_t n)
{
	size_t covers = n - n * 58 / 100;
	double spacing = c->object->scale * sqrt(c->surface.area / (double)covers), a, b;

	for (size_t i = 0; i < covers; i++) {
		spread(i, &w->rng, &a, &b);
		lay(w, c, covering(spacing, &w->rng), spacing, a, b);
	}
	for (size_t i = 0; i < n - covers; i++) {
		a = rng_uniform(&w->rng);
		b = rng_uniform(&w->rng);
		lay(w, c, detailing(spacing, &w->rng), spacing, a, b);
	}
}

static void put_object(struct work *w, int owner, size_t n)
{
	const struct synth_object *o = &w->s->objects[owner];
	struct coat c = {.owner = owner, .object = o, .gloss = o->finish == SYNTH_SHINY ? 0.16 : 0.03};

	synth_object_surface(&c.surface, o->shape);
	put_coat(w, &c, n);
}

/* A slab on square legs. */
static void put_table(struct work *w, size_t n)
{
	static const double thickness = 0.16, leg = 0.16, depth = 2.2;
	const struct synth_table *t = &w->s->table;
	struct coat c = {.owner = -1, .is_table = 1, .object = &unmoved, .gloss = 0.02};

	synth_surface_box(&c.surface, SYNTH_OWN, SYNTH_INNER, (double[3]){0, 0, -thickness},
		2 * t->half_width, 2 * t->half_depth, thickness);
	for (int i = 0; i < 4; i++) {
		double x = (i & 1 ? 1 : -1) * (t->half_width - 0.2),
		       y = (i & 2 ? 1 : -1) * (t->half_depth - 0.2);
		double profile[2][2] = {{leg / 2, -depth}, {leg / 2, -thickness}};
		synth_surface_turn(
			&c.surface, SYNTH_INNER, (double[3]){x, y, 0}, 2, (const double(*)[2])profile);
	}
	put_coat(w, &c, n);
}

static double room_radius(const struct synth_scene *s)
{
	return s->preset->room * fmax(s->table.half_width, 1.3 * s->table.half_depth);
}

/* A round room: floor and wall, far enough for every camera to stand inside. */
static void put_room(struct work *w, size_t n)
{
	double radius = room_radius(w->s), height = 0.8 * radius;
	double profile[3][2] = {{radius, height}, {radius, -2.2}, {0, -2.2}};
	/* The rasteriser's projection, like that of 3DGS, spreads what is large and just beside or below a
	 * camera over the whole image. */
	struct coat c = {.owner = -1, .object = &unmoved, .gloss = 0.01, .longest = 0.08 * radius};

	synth_surface_turn(&c.surface, SYNTH_OWN, (double[3]){0}, 3, (const double(*)[2])profile);
	put_coat(w, &c, n);
}

/* The rest of a stray is at random: thinner by ratios of this spread, and as the wall or of any colour. */
static void put_astray(
	struct work *w, const double mean[3], struct grain g, double spread, double tone, const double *wall)
{
	struct rng *r = &w->rng;
	double along[3], rgb[3];

	g.side[1] = g.side[0] / ratio(r, spread);
	g.thick = g.side[1] / ratio(r, spread);
	double turn = rng_range(r, 0, 2 * PI), rise = rng_range(r, -1, 1), flat = sqrt(1 - rise * rise);
	double normal[3] = {flat * cos(turn), flat * sin(turn), rise};
	for (int k = 0; k < 3; k++)
		along[k] = rng_normal(r);
	for (int k = 0; k < 3; k++)
		rgb[k] = fmin(1, fmax(0, wall ? wall[k] * tone : tone + 0.12 * rng_normal(r)));
	put(w, -1, mean, &g, normal, along, rgb, 0.02);
}

/* A speck or needle in the air, mostly faint. */
static void put_speck(struct work *w, double fine)
{
	const struct synth_table *t = &w->s->table;
	struct rng *r = &w->rng;
	double mean[3] = {t->half_width * rng_range(r, -1.3, 1.3), t->half_depth * rng_range(r, -1.3, 1.3),
		rng_range(r, 0.05, 2.2)};
	struct grain g = {.side[0] = fine * 0.022 * exp(0.5 * rng_normal(r)),
		.opacity = rng_below(r, 6) ? 0.005 * pow(24, rng_uniform(r)) : rng_range(r, 0.1, 0.6)};

	put_astray(w, mean, g, 1.3, rng_range(r, 0.2, 0.9), NULL);
}

/* Something large and soft before the wall, too far from the cameras to reach them. */
static void put_cloud(struct work *w, double fine)
{
	const struct synth_scene *s = w->s;
	struct rng *r = &w->rng;
	double radius = room_radius(s),
	       gap = 0.9 * radius - 1.1 * synth_cameras_distance(&s->table, s->preset);
	double far = radius * rng_range(r, 0.9, 0.97), around = rng_range(r, 0, 2 * PI);
	double mean[3] = {far * cos(around), far * sin(around), rng_range(r, -1.8, 0.6 * radius)};
	struct grain g = {
		.side[0] = fine * gap * rng_range(r, 0.06, 0.25), .opacity = rng_range(r, 0.02, 0.5)};

	put_astray(w, mean, g, 0.4, rng_range(r, 0.9, 1.15), s->preset->wall);
}

/* What training leaves behind. However many there are, they hide about as much. */
static void put_stray(struct work *w, size_t n)
{
	double fine = fmin(1, sqrt(60000.0 / (double)w->s->splats.n));

	for (size_t i = 0; i < n; i++)
		if (i % 8)
			put_speck(w, fine);
		else
			put_cloud(w, fine);
}

/* Of n Gaussians: 2.5% stray, 10% room, 17% table, the rest on the objects in proportion to surface^0.7, so
 * that a small thing is not coarse. */
static void put_all(struct work *w)
{
	struct synth_scene *s = w->s;
	size_t n = s->splats.n, stray = n / 40, room = n / 10, table = n * 17 / 100;
	size_t left = n - stray - room - table;
	double share[SYNTH_MAX_OBJECTS], sum = 0;

	for (int i = 0; i < s->object_count; i++) {
		struct synth_surface surface;
		synth_object_surface(&surface, s->objects[i].shape);
		share[i] = pow(surface.area * s->objects[i].scale * s->objects[i].scale, 0.7);
		sum += share[i];
	}
	for (int i = 0; i < s->object_count; i++) {
		size_t part = i + 1 == s->object_count ? left : (size_t)((double)left * share[i] / sum);
		s->first[i] = w->next;
		put_object(w, i, part);
		left -= part;
		sum -= share[i];
	}
	s->first[s->object_count] = w->next;
	put_table(w, table);
	put_room(w, room);
	put_stray(w, stray);
}

int synth_gaussians_make(struct synth_scene *s, uint64_t seed, struct err *e)
{
	SCOPED struct work *w = mem_zalloc(1, sizeof *w, "scene", e);

	if (!w)
		return -1;
	w->s = s;
	rng_seed(&w->rng, seed, SYNTH_STREAM_TEXTURE);
	synth_noise_make(&w->texture, &w->rng);
	rng_seed(&w->rng, seed, SYNTH_STREAM_GAUSSIANS);
	put_all(w);
	return 0;
}
