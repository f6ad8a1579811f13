#include "synth/cameras.h"

#include "base/mem.h"
#include "base/rng.h"
#include "geom/vector.h"
#include "synth/occlusion.h"

#include <math.h>
#include <stdio.h>

void synth_cameras_aim(struct camera *c, const double centre[3], const double target[3], double roll)
{
	double forward[3], right[3], down[3], up[3] = {0, 0, 1}, cosine = cos(roll), sine = sin(roll);

	for (int k = 0; k < 3; k++)
		forward[k] = target[k] - centre[k];
	vector_normalise(forward);
	vector_cross(forward, up, right);
	vector_normalise(right);
	vector_cross(forward, right, down);
	for (int k = 0; k < 3; k++) {
		c->world_to_camera[0][k] = cosine * right[k] + sine * down[k];
		c->world_to_camera[1][k] = cosine * down[k] - sine * right[k];
		c->world_to_camera[2][k] = forward[k];
		c->world_to_camera[3][k] = 0;
	}
	for (int r = 0; r < 3; r++)
		c->world_to_camera[r][3] = -vector_dot(c->world_to_camera[r], centre);
	c->world_to_camera[3][3] = 1;
}

double synth_cameras_distance(const struct synth_table *table, const struct synth_preset *preset)
{
	return preset->distance * fmax(table->half_width, 1.3 * table->half_depth);
}

int synth_cameras_make(
	struct cameras *c, const struct synth_options *o, const struct synth_table *table, struct err *e)
{
	double far = synth_cameras_distance(table, o->preset), reach = far / o->preset->distance;
	int n = o->views, share = n * o->preset->test_views / o->preset->views, tests = share ? share : 1;
	struct rng r;

	*c = (struct cameras){0};
	c->views = mem_zalloc((size_t)n, sizeof *c->views, "cameras", e);
	if (!c->views)
		return -1;
	rng_seed(&r, o->seed, SYNTH_STREAM_CAMERAS);
	for (int i = 0; i < n; i++) {
		struct camera *v = &c->views[c->n++];
		char name[32];
		snprintf(name, sizeof name, "view_%03d", i);
		if (!(v->name = mem_strdup(name, e)))
			return -1;
		v->width = o->width;
		v->height = o->height;
		v->fx = v->fy = 0.95 * fmax(o->width, o->height * 4 / 3.0);
		v->cx = o->width / 2.0;
		v->cy = o->height / 2.0;
		v->split = (i + 1) * tests / n > i * tests / n ? SPLIT_TEST : SPLIT_TRAIN;
		/* Out along the arc and back again. */
		double walked = 2 * (i + 0.5) / n, side = walked < 1 ? walked : 2 - walked;
		double azimuth = (-70 + 140 * side + rng_range(&r, -6, 6)) * PI / 180;
		double elevation = (o->preset->elevations[walked >= 1] + rng_range(&r, -6, 6)) * PI / 180;
		double distance = far * rng_range(&r, 0.9, 1.1);
		double centre[3] = {distance * cos(elevation) * sin(azimuth),
			-distance * cos(elevation) * cos(azimuth), distance * sin(elevation)};
		double target[3] = {0.12 * reach * rng_normal(&r), 0.12 * reach * rng_normal(&r), 0.1};
		synth_cameras_aim(v, centre, target, 0.03 * rng_normal(&r));
	}
	return 0;
}

void synth_cameras_reference(const struct cameras *c, double centre[3], double right[2], double away[2])
{
	double one[3];
	int n = 0;

	centre[0] = centre[1] = centre[2] = 0;
	for (size_t i = 0; i < c->n; i++) {
		if (c->views[i].split != SPLIT_TRAIN)
			continue;
		camera_centre(&c->views[i], one);
		for (int k = 0; k < 3; k++)
			centre[k] += one[k];
		n++;
	}
	double length = hypot(centre[0], centre[1]);
	away[0] = -centre[0] / length;
	away[1] = -centre[1] / length;
	right[0] = away[1];
	right[1] = -away[0];
	for (int k = 0; k < 3; k++)
		centre[k] /= n;
}

enum {
	POOL = 480,   /* places for a camera that are looked at */
	ROUNDS = 3,   /* of exchanging a chosen place for a better one */
	SMALLEST = 6, /* cells; with fewer of them in the image an object is as good as outside it */
};

/* How an object looks from a place. */
enum look { LOOK_CLEAR, LOOK_HALF, LOOK_SLIVER, LOOK_NONE, LOOK_OUTSIDE, LOOKS };

struct place {
	struct camera camera; /* of it only world_to_camera is its own */
	double azimuth;
	unsigned char looks[SYNTH_MAX_OBJECTS];
};

static enum look judge(int visible, int whole)
{
	double share = whole > 0 ? (double)visible / whole : 0;

	return whole < SMALLEST ? LOOK_OUTSIDE
	       : share >= 0.5	? LOOK_CLEAR
	       : share >= 0.15	? LOOK_HALF
	       : share >= 0.02	? LOOK_SLIVER
				: LOOK_NONE;
}

int synth_cameras_check(const struct cameras *c, const struct synth_object *objects, int n, struct err *e)
{
	int visible[SYNTH_MAX_OBJECTS], whole[SYNTH_MAX_OBJECTS], clear[SYNTH_MAX_OBJECTS] = {0}, views = 0;
	SCOPED_BY(synth_occlusion_free) struct synth_occlusion occlusion = {0};

	if (synth_occlusion_make(&occlusion, objects, n, e))
		return -1;
	for (size_t i = 0; i < c->n; i++) {
		if (c->views[i].split != SPLIT_TRAIN)
			continue;
		views++;
		synth_occlusion_look(&occlusion, &c->views[i], visible, whole);
		for (int k = 0; k < n; k++)
			clear[k] += judge(visible[k], whole[k]) == LOOK_CLEAR;
	}
	for (int k = 0; k < n; k++)
		if (3 * clear[k] < views)
			return err_set(
				e, ERR_CHECK, "the %s is hidden in most training views", objects[k].name);
	return 0;
}

/* Near to the table and low, looking at some object. */
static void draw_place(struct place *p, const struct camera *like, const struct synth_options *o,
	const struct synth_object *objects, const struct synth_table *table, struct rng *r)
{
	double distance = synth_cameras_distance(table, o->preset) * rng_range(r, 0.85, 1.05);
	double elevation = rng_range(r, 7, 28) * PI / 180;
	const struct synth_object *at = &objects[rng_below(r, (uint32_t)o->objects)];

	p->azimuth = rng_range(r, -76, 76) * PI / 180;
	p->camera = *like;
	double centre[3] = {distance * cos(elevation) * sin(p->azimuth),
		-distance * cos(elevation) * cos(p->azimuth), distance * sin(elevation) + 0.2};
	double target[3] = {0.3 * at->x, 0.3 * at->y, 0.25};
	synth_cameras_aim(&p->camera, centre, target, 0.03 * rng_normal(r));
}

/* What the places chosen for all views but one come to. */
struct others {
	int views, counts[LOOKS], hidden[SYNTH_MAX_OBJECTS];
};

static void count(struct others *s, const struct place *p, int objects)
{
	s->views++;
	for (int i = 0; i < objects; i++) {
		s->counts[p->looks[i]]++;
		s->hidden[i] += p->looks[i] != LOOK_CLEAR;
	}
}

/* How far the others and p together are from what is wanted. */
static double fault(struct others all, const struct place *p, const struct synth_options *o)
{
	double wanted = o->preset->hidden, sum = 0;

	count(&all, p, o->objects);
	double pairs = (double)all.views * o->objects, most = ceil(1.5 * wanted * all.views);
	/* Not always the same object. */
	for (int i = 0; i < o->objects; i++)
		sum += 0.7 * fmax(0, all.hidden[i] - most);
	int slivers = all.counts[LOOK_SLIVER] + all.counts[LOOK_NONE],
	    hidden = all.counts[LOOK_HALF] + slivers;
	return sum + fabs(hidden - wanted * pairs) + 0.5 * fabs(slivers - 0.25 * wanted * pairs) +
	       fmax(0, all.counts[LOOK_NONE] - 0.01 * pairs) + 1.5 * all.counts[LOOK_OUTSIDE];
}

/* chosen[k] becomes the place that makes all n the best they can be with the others as they are. */
static void choose(const struct place *pool, int *chosen, int k, int n, const struct synth_options *o)
{
	struct others others = {0};
	double least = INFINITY;
	int best = chosen[k];

	for (int j = 0; j < n; j++)
		if (j != k)
			count(&others, &pool[chosen[j]], o->objects);
	for (int i = 0; i < POOL; i++) {
		int is_taken = 0, close = 0;
		for (int j = 0; j < n; j++) {
			double apart = fabs(pool[i].azimuth - pool[chosen[j]].azimuth);
			is_taken |= j != k && chosen[j] == i;
			close += j != k && apart < 0.7 * PI / (4 * n);
		}
		double f = is_taken ? INFINITY : fault(others, &pool[i], o) + close;
		if (f < least) {
			least = f;
			best = i;
		}
	}
	chosen[k] = best;
}

int synth_cameras_hide(struct cameras *c, const struct synth_options *o, const struct synth_object *objects,
	const struct synth_table *table, struct err *e)
{
	int visible[SYNTH_MAX_OBJECTS], whole[SYNTH_MAX_OBJECTS], n = 0;
	SCOPED_BY(synth_occlusion_free) struct synth_occlusion occlusion = {0};
	struct rng r;

	if (!(o->preset->hidden > 0))
		return 0;
	if (synth_occlusion_make(&occlusion, objects, o->objects, e))
		return -1;
	SCOPED struct place *pool = mem_alloc(POOL, sizeof *pool, "camera places", e);
	SCOPED int *chosen = mem_zalloc(c->n, sizeof *chosen, "camera places", e);
	int bad = pool && chosen ? 0 : -1;
	rng_seed(&r, o->seed, SYNTH_STREAM_HIDING);
	for (int i = 0; i < POOL && !bad; i++) {
		draw_place(&pool[i], &c->views[0], o, objects, table, &r);
		synth_occlusion_look(&occlusion, &pool[i].camera, visible, whole);
		for (int k = 0; k < o->objects; k++)
			pool[i].looks[k] = (unsigned char)judge(visible[k], whole[k]);
	}
	for (size_t i = 0; i < c->n; i++)
		n += c->views[i].split == SPLIT_TEST;
	for (int k = 0; k < n && !bad; k++)
		choose(pool, chosen, k, k + 1, o);
	for (int k = 0; k < ROUNDS * n && !bad; k++)
		choose(pool, chosen, k % n, n, o);
	int next = 0;
	for (size_t i = 0; i < c->n && !bad; i++)
		if (c->views[i].split == SPLIT_TEST)
			memcpy(c->views[i].world_to_camera, pool[chosen[next++]].camera.world_to_camera,
				sizeof c->views[i].world_to_camera);
	return bad;
}
