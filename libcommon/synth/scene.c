#include "synth/scene.h"

#include "base/mem.h"
#include "base/rng.h"
#include "synth/arrange.h"
#include "synth/cameras.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define SH_C0 0.28209479177387814
#define SH_C1 0.4886025119029199

enum { SH_COEFFICIENTS = 4, TRUTH_CHANNELS = 8 };

/* Towards the light, and how much of a colour comes from everywhere. */
static const double light[3] = {-0.45, -0.40, 0.80};
static const double ambient = 0.58;

/* What is being filled in: the next Gaussian's number goes up as Gaussians are put. */
struct work {
	struct synth_scene *s;
	struct synth_noise texture;
	struct rng rng;
	size_t next;
};

/* A frame whose third axis is n, turned at random about it, as a quaternion (w,x,y,z). */
static void frame_quaternion(const double n[3], double turn, float q[4])
{
	/* The shortest turn from z to n, after a turn about z. */
	double w = 1 + n[2], x = -n[1], y = n[0], length;
	double c = cos(turn / 2), s = sin(turn / 2);

	if (w < 1e-9) {
		w = 0;
		x = 1;
		y = 0;
	}
	length = sqrt(w * w + x * x + y * y);
	w /= length;
	x /= length;
	y /= length;
	q[0] = (float)(w * c);
	q[1] = (float)(x * c + y * s);
	q[2] = (float)(y * c - x * s);
	q[3] = (float)(w * s);
}

/* Colour as spherical harmonics: `rgb` on average, brighter by up to `gloss` seen from where the light is
 * mirrored. */
static void set_colour(float *sh, const double rgb[3], const double normal[3], double gloss)
{
	double along = 2 * (light[0] * normal[0] + light[1] * normal[1] + light[2] * normal[2]), mirrored[3];

	for (int k = 0; k < 3; k++)
		mirrored[k] = along * normal[k] - light[k];
	for (int k = 0; k < 3; k++) {
		sh[k] = (float)((rgb[k] - 0.5) / SH_C0);
		/* The direction in the harmonics is from the camera to the Gaussian. */
		sh[3 + k] = (float)(gloss * mirrored[1] / SH_C1);
		sh[6 + k] = (float)(-gloss * mirrored[2] / SH_C1);
		sh[9 + k] = (float)(gloss * mirrored[0] / SH_C1);
	}
}

static void put(struct work *w, int owner, const double mean[3], const double scale[3],
	const double normal[3], double opacity, const double rgb[3], double gloss)
{
	struct splats *p = &w->s->splats;
	size_t i = w->next++;

	for (int k = 0; k < 3; k++) {
		p->means[3 * i + (size_t)k] = (float)mean[k];
		p->scales[3 * i + (size_t)k] = (float)scale[k];
	}
	frame_quaternion(normal, rng_range(&w->rng, 0, 2 * PI), p->quats + 4 * i);
	p->opacities[i] = (float)opacity;
	set_colour(p->sh + 3 * SH_COEFFICIENTS * i, rgb, normal, gloss);
	w->s->owner[i] = owner;
}

/* A flat Gaussian that covers its share of a surface, with a trained scene's small faults. */
static void put_on_surface(struct work *w, int owner, const double point[3], const double normal[3],
	double spacing, const double rgb[3], double gloss)
{
	struct rng *r = &w->rng;
	double mean[3], tilted[3], scale[3], length = 0, lit[3];
	double shade = normal[0] * light[0] + normal[1] * light[1] + normal[2] * light[2];

	shade = ambient + (1 - ambient) * fmax(0, shade) + 0.02 * rng_normal(r);
	for (int k = 0; k < 3; k++) {
		tilted[k] = normal[k] + 0.07 * rng_normal(r);
		length += tilted[k] * tilted[k];
		lit[k] = fmin(1, fmax(0, rgb[k] * shade + 0.012 * rng_normal(r)));
	}
	for (int k = 0; k < 3; k++)
		tilted[k] /= sqrt(length);
	scale[0] = spacing * exp(0.18 * rng_normal(r)) * 0.72;
	scale[1] = spacing * exp(0.18 * rng_normal(r)) * 0.62;
	scale[2] = spacing * 0.08 * exp(0.3 * rng_normal(r));
	for (int k = 0; k < 3; k++)
		mean[k] = point[k] - scale[2] * normal[k];
	put(w, owner, mean, scale, tilted, rng_range(r, 0.6, 0.99), lit, gloss);
}

/* The i-th point of an evenly spread sequence in the unit square (R2, after the plastic number), shaken a
 * little. */
static void spread(size_t i, struct rng *r, double *a, double *b)
{
	double x = 0.7548776662466927 * (double)(i + 1) + 0.08 * rng_uniform(r) / sqrt((double)(i + 1));
	double y = 0.5698402909980532 * (double)(i + 1);

	*a = x - floor(x);
	*b = y - floor(y);
}

/* How much light the objects leave on a point of the table or of `owner`'s top. */
static double shadow(const struct synth_scene *s, int owner, double x, double y, double z)
{
	double left = 1;

	for (int i = 0; i < s->object_count; i++) {
		const struct synth_object *o = &s->objects[i];
		double reach = o->z + 0.5 * o->height - z;
		if (i == owner || reach <= 0)
			continue;
		double dx = x - o->x + light[0] * reach, dy = y - o->y + light[1] * reach;
		double at = hypot(dx, dy) / (0.8 * o->radius + 0.4 * reach);
		left *= 1 - 0.45 * fmax(0, 1 - at * at);
	}
	return left;
}

static void put_object(struct work *w, int owner, size_t n)
{
	const struct synth_object *o = &w->s->objects[owner];
	struct synth_surface surface;
	double c = cos(o->yaw), s = sin(o->yaw);

	synth_object_surface(&surface, o->shape);
	double spacing = o->scale * sqrt(surface.area / (double)n);
	for (size_t i = 0; i < n; i++) {
		double a, b, p[3], q[3], rgb[3];
		spread(i, &w->rng, &a, &b);
		enum synth_tint tint = synth_surface_at(&surface, a, b, p, q);
		synth_object_colour(o, tint, p, &w->texture, rgb);
		double point[3] = {o->x + o->scale * (c * p[0] - s * p[1]),
			o->y + o->scale * (s * p[0] + c * p[1]), o->z + o->scale * p[2]};
		double normal[3] = {c * q[0] - s * q[1], s * q[0] + c * q[1], q[2]};
		if (normal[2] > 0.5) {
			double left = shadow(w->s, owner, point[0], point[1], point[2]);
			for (int k = 0; k < 3; k++)
				rgb[k] *= left;
		}
		put_on_surface(w, owner, point, normal, spacing, rgb, o->finish == SYNTH_SHINY ? 0.16 : 0.03);
	}
}

/* The slab's boards run along x; its legs are square. */
static void put_table(struct work *w, size_t n)
{
	static const double thickness = 0.16, leg = 0.16, depth = 2.2;
	const struct synth_table *t = &w->s->table;
	struct synth_surface surface = {0};

	synth_surface_box(&surface, SYNTH_OWN, SYNTH_INNER, (double[3]){0, 0, -thickness}, 2 * t->half_width,
		2 * t->half_depth, thickness);
	for (int i = 0; i < 4; i++) {
		double x = (i & 1 ? 1 : -1) * (t->half_width - 0.2),
		       y = (i & 2 ? 1 : -1) * (t->half_depth - 0.2);
		double profile[2][2] = {{leg / 2, -depth}, {leg / 2, -thickness}};
		synth_surface_turn(
			&surface, SYNTH_INNER, (double[3]){x, y, 0}, 2, (const double(*)[2])profile);
	}
	double spacing = sqrt(surface.area / (double)n);
	for (size_t i = 0; i < n; i++) {
		double a, b, p[3], normal[3], rgb[3];
		spread(i, &w->rng, &a, &b);
		enum synth_tint tint = synth_surface_at(&surface, a, b, p, normal);
		double board = floor((p[1] + t->half_depth) / w->s->preset->boards);
		double grain = synth_noise_at(&w->texture, 0.6 * p[0] + 17 * board, 9 * p[1]);
		double tone = 1 + 0.13 * grain + 0.05 * synth_noise_at(&w->texture, 7.3 * board, 0.5);
		tone *= tint == SYNTH_OWN ? shadow(w->s, -1, p[0], p[1], 0) : 0.8;
		for (int k = 0; k < 3; k++)
			rgb[k] = w->s->preset->wood[k] * tone;
		put_on_surface(w, -1, p, normal, spacing, rgb, 0.02);
	}
}

/* A round room: floor and wall, far enough for every camera to stand inside. */
static void put_room(struct work *w, size_t n)
{
	const struct synth_preset *preset = w->s->preset;
	const struct synth_table *t = &w->s->table;
	double radius = preset->room * fmax(t->half_width, 1.3 * t->half_depth), height = 0.8 * radius;
	double profile[3][2] = {{radius, height}, {radius, -2.2}, {0, -2.2}};
	struct synth_surface surface = {0};

	synth_surface_turn(&surface, SYNTH_OWN, (double[3]){0}, 3, (const double(*)[2])profile);
	double spacing = sqrt(surface.area / (double)n);
	for (size_t i = 0; i < n; i++) {
		double a, b, p[3], normal[3], rgb[3];
		spread(i, &w->rng, &a, &b);
		synth_surface_at(&surface, a, b, p, normal);
		int is_floor = normal[2] > 0.5;
		double tone = 1 + 0.10 * synth_noise_at(&w->texture, 0.7 * p[0] + 0.9 * p[2], 0.7 * p[1]);
		for (int k = 0; k < 3; k++)
			rgb[k] = (is_floor ? preset->carpet : preset->wall)[k] * tone;
		put_on_surface(w, -1, p, normal, spacing, rgb, 0.01);
	}
}

/* What training leaves behind: faint specks in the air, and a few large soft ones far away. */
static void put_stray(struct work *w, size_t n)
{
	const struct synth_table *t = &w->s->table;
	struct rng *r = &w->rng;

	for (size_t i = 0; i < n; i++) {
		double normal[3] = {0, 0, 1}, rgb[3], tone = rng_range(r, 0.2, 0.9);
		int is_large = i % 8 == 0;
		double size = is_large ? rng_range(r, 0.3, 0.9) : 0.012 * exp(0.6 * rng_normal(r));
		double turn = rng_range(r, 0, 2 * PI), far = 3.1 * fmax(t->half_width, 1.3 * t->half_depth);
		double mean[3] = {t->half_width * rng_range(r, -1.2, 1.2),
			t->half_depth * rng_range(r, -1.2, 1.2), rng_range(r, 0.05, 1.8)};
		if (is_large) {
			mean[0] = far * cos(turn);
			mean[1] = far * sin(turn);
			mean[2] = rng_range(r, -1.8, 2.5);
		}
		double scale[3] = {size * exp(0.3 * rng_normal(r)), size, size * exp(0.3 * rng_normal(r))};
		for (int k = 0; k < 3; k++)
			rgb[k] = fmin(1, fmax(0, tone + 0.12 * rng_normal(r)));
		put(w, -1, mean, scale, normal, is_large ? rng_range(r, 0.1, 0.5) : rng_range(r, 0.05, 0.45),
			rgb, 0.02);
	}
}

/* Of n Gaussians: 1% stray, 14% room, 22% table, the rest on the objects in proportion to surface^0.7, so
 * that a small thing is not coarse. */
static void put_all(struct work *w, size_t n)
{
	struct synth_scene *s = w->s;
	size_t stray = n / 100, room = n * 14 / 100, table = n * 22 / 100, left = n - stray - room - table;
	double share[SYNTH_MAX_OBJECTS], sum = 0;

	for (int i = 0; i < s->object_count; i++) {
		struct synth_surface surface;
		synth_object_surface(&surface, s->objects[i].shape);
		share[i] = pow(surface.area * s->objects[i].scale * s->objects[i].scale, 0.7);
		sum += share[i];
	}
	for (int i = 0; i < s->object_count; i++) {
		size_t part = i + 1 == s->object_count ? left : (size_t)((double)left * share[i] / sum);
		put_object(w, i, part);
		left -= part;
		sum -= share[i];
	}
	put_table(w, table);
	put_room(w, room);
	put_stray(w, stray);
}

int synth_scene_make(struct synth_scene *s, const struct synth_options *o, struct err *e)
{
	struct work *w = mem_zalloc(1, sizeof *w, "scene", e);

	*s = (struct synth_scene){.preset = o->preset, .object_count = o->objects};
	if (!w)
		return -1;
	s->objects = mem_zalloc((size_t)o->objects, sizeof *s->objects, "objects", e);
	s->owner = mem_alloc(o->gaussians, sizeof *s->owner, "owners", e);
	if (!s->objects || !s->owner || splats_alloc(&s->splats, o->gaussians, SH_COEFFICIENTS, e))
		goto fail;
	synth_arrange(s->objects, o->objects, &s->table, o->preset, o->seed);
	if (synth_cameras_make(&s->cameras, o, &s->table, e))
		goto fail;
	w->s = s;
	rng_seed(&w->rng, o->seed, SYNTH_STREAM_TEXTURE);
	synth_noise_make(&w->texture, &w->rng);
	rng_seed(&w->rng, o->seed, SYNTH_STREAM_GAUSSIANS);
	put_all(w, o->gaussians);
	free(w);
	return 0;
fail:
	free(w);
	synth_scene_free(s);
	return -1;
}

void synth_scene_free(struct synth_scene *s)
{
	free(s->objects);
	free(s->owner);
	splats_free(&s->splats);
	cameras_free(&s->cameras);
	*s = (struct synth_scene){0};
}

int synth_scene_truth(const struct synth_scene *s, const struct render_view *view, size_t pixels,
	uint8_t *masks, struct err *e)
{
	/* A few objects a pass bounds the memory at any number of objects. */
	size_t n = s->splats.n;
	float *own = mem_alloc(n, TRUTH_CHANNELS * sizeof *own, "object indicators", e);
	float *share = mem_alloc(pixels, TRUTH_CHANNELS * sizeof *share, "object shares", e);
	int bad = -1;

	if (!own || !share)
		goto done;
	for (int first = 0; first < s->object_count; first += TRUTH_CHANNELS) {
		int channels =
			s->object_count - first < TRUTH_CHANNELS ? s->object_count - first : TRUTH_CHANNELS;
		for (int c = 0; c < channels; c++)
			for (size_t i = 0; i < n; i++)
				own[(size_t)c * n + i] = s->owner[i] == first + c;
		if (render_values(view, own, channels, share, NULL, e))
			goto done;
		uint8_t *to = masks + (size_t)first * pixels;
		for (size_t p = 0; p < (size_t)channels * pixels; p++)
			to[p] = share[p] > 0.5f;
	}
	bad = 0;
done:
	free(own);
	free(share);
	return bad;
}
