#include "synth/moves.h"

#include "base/mem.h"
#include "base/rng.h"
#include "geom/rotation.h"
#include "geom/vector.h"

#include <math.h>
#include <string.h>

enum {
	TRIES = 300,
	STEPS = 2 /* that are looked at between stored times */,
	LEAST = 4 /* times of a move */
};

static const double gap = 0.06, shortest = 0.5;

/* What may be done with a thing. */
enum plot { PUSH, ROLL, PUSH_TWICE, CARRY, DROP, LIFT, SWAP, PASS, PLOTS };

double synth_moves_time(int times, int time)
{
	return times > 1 ? (double)time / (times - 1) : 0;
}

/* How much of a move is done, of the share of its time. */
static double done(enum synth_move_kind kind, double u)
{
	return kind == SYNTH_FALLS ? u * u : kind == SYNTH_ROLLS ? u * (2 - u) : u * u * (3 - 2 * u);
}

void synth_moves_at(const struct synth_moves *m, int i, double time, double by[3], double *rolled)
{
	const struct synth_way *w = &m->ways[i];

	by[0] = by[1] = by[2] = *rolled = 0;
	for (int k = 0; k < w->n; k++) {
		const struct synth_move *v = &w->moves[k];
		const double u = fmin(1, fmax(0, (time - v->first) / (v->last - v->first)));
		const double share = done(v->kind, u), length = hypot(v->by[0], v->by[1]);
		const double side = length > 0 ? v->aside * sin(PI * share) / length : 0;
		for (int d = 0; d < 3; d++)
			by[d] += share * v->by[d];
		by[0] += side * v->by[1];
		by[1] -= side * v->by[0];
		*rolled += v->kind == SYNTH_ROLLS ? share * length : 0;
	}
}

/* Whether objects i and j would touch at a time; their places by then: a, b. */
static int touches(const struct synth_object *o, int i, int j, const double a[3], const double b[3])
{
	const double za = o[i].z + a[2], zb = o[j].z + b[2];

	return hypot(o[i].x + a[0] - o[j].x - b[0], o[i].y + a[1] - o[j].y - b[1]) <
		       o[i].radius + o[j].radius + gap &&
	       za < zb + o[j].height + gap && zb < za + o[i].height + gap;
}

/* 1 where object i stays on the table and clear of all others. */
static int is_clear(const struct synth_moves *m, int i)
{
	const struct synth_scene *s = m->scene;
	const struct synth_object *o = s->objects;
	double a[3], b[3], rolled;

	for (int t = 0; t <= STEPS * (m->times - 1); t++) {
		synth_moves_at(m, i, (double)t / STEPS, a, &rolled);
		if (fabs(o[i].x + a[0]) > s->table.half_width - o[i].radius ||
			fabs(o[i].y + a[1]) > s->table.half_depth - o[i].radius)
			return 0;
		for (int j = 0; j < s->object_count; j++) {
			synth_moves_at(m, j, (double)t / STEPS, b, &rolled);
			if (j != i && touches(o, i, j, a, b))
				return 0;
		}
	}
	return 1;
}

static struct synth_move *add(struct synth_way *w, enum synth_move_kind kind, int first, int last)
{
	w->moves[w->n] = (struct synth_move){.kind = kind, .first = first, .last = last};
	return &w->moves[w->n++];
}

/* A way along the table: anywhere, or towards another thing or away from it. */
static void draw_way(const struct synth_scene *s, int i, double by[3], struct rng *r)
{
	const struct synth_object *o = s->objects, *a = &o[rng_below(r, (uint32_t)s->object_count)];
	const double length = rng_range(r, 0.9, 2.8), angle = rng_range(r, -PI, PI);

	const double x = a->x - o[i].x, y = a->y - o[i].y, apart = hypot(x, y);
	const double share = (rng_below(r, 2) ? fmin(length, 0.8 * apart) : -length) / apart;

	by[0] = length * cos(angle);
	by[1] = length * sin(angle);
	if (rng_below(r, 2) && a != &o[i]) {
		by[0] = share * x;
		by[1] = share * y;
	}
}

/* Behind or in front of another, as the front of the table sees it. */
static void pass(const struct synth_scene *s, int i, double by[3], struct rng *r)
{
	const struct synth_object *o = s->objects, *a = &o[rng_below(r, (uint32_t)s->object_count)];

	by[0] = (a->x - o[i].x) * rng_range(r, 1.5, 2.2);
	by[1] = rng_range(r, -0.3, 0.3);
}

/* One try; `lasts`: stored times of a move. */
static void try_plot(struct synth_moves *m, int i, enum plot plot, struct rng *r)
{
	struct synth_way *w = &m->ways[i];
	const struct synth_object *o = m->scene->objects;
	const int end = m->times - 1, lasts = LEAST + end / 12 + (int)rng_below(r, (uint32_t)(end / 4 + 1)),
		  late = end - lasts;
	const int is_edge =
		(int)rng_below(r, 5); /* one in five moves from the first time on, one in five to the last */
	const int half = (lasts + 1) / 2,
		  first = is_edge == 0 ? 0
			  : is_edge == 1 && plot < PUSH_TWICE
				  ? late
				  : (int)rng_below(r, (uint32_t)(late > 0 ? late : 1));
	const double height = rng_range(r, 1.0, 1.8);
	struct synth_move *v;

	*w = (struct synth_way){.partner = -1};
	if (plot == PUSH || plot == ROLL || plot == PASS) {
		v = add(w, plot == ROLL ? SYNTH_ROLLS : SYNTH_SLIDES, first, first + lasts);
		plot == PASS ? pass(m->scene, i, v->by, r) : draw_way(m->scene, i, v->by, r);
	} else if (plot == PUSH_TWICE) {
		v = add(w, SYNTH_SLIDES, first, first + half);
		draw_way(m->scene, i, v->by, r);
		for (int d = 0; d < 2; d++)
			v->by[d] /= 2;
		*add(w, SYNTH_SLIDES, 0, 0) = (struct synth_move){SYNTH_SLIDES, first + half + LEAST + 2,
			first + 2 * half + LEAST + 2, {v->by[0], v->by[1], 0}, 0};
	} else if (plot == SWAP) {
		const int j = (int)rng_below(r, (uint32_t)m->scene->object_count);
		struct synth_way *other = &m->ways[j];
		if (j == i || other->n || o[j].on >= 0)
			return;
		v = add(w, SYNTH_SLIDES, first, first + lasts);
		v->by[0] = o[j].x - o[i].x;
		v->by[1] = o[j].y - o[i].y;
		v->aside = (o[i].radius + o[j].radius) * 0.6 + gap;
		*other = *w;
		other->moves[0].by[0] = -v->by[0];
		other->moves[0].by[1] = -v->by[1];
		w->partner = j;
		other->partner = i;
	} else {
		add(w, SYNTH_RISES, first, first + half)->by[2] = height;
		if (plot == CARRY) {
			draw_way(m->scene, i,
				add(w, SYNTH_CARRIED, first + half - 1, first + 2 * half + 1)->by, r);
			add(w, SYNTH_LOWERED, first + 2 * half, first + 3 * half)->by[2] = -height;
		} else if (plot == DROP) {
			const int falls = first + half + LEAST + (int)rng_below(r, LEAST);
			add(w, SYNTH_FALLS, falls, falls + (half > LEAST ? LEAST + 1 : LEAST))->by[2] =
				-height;
		}
	}
}

static int is_fit(const struct synth_moves *m, int i)
{
	const struct synth_way *w = &m->ways[i];

	for (int k = 0; k < w->n; k++)
		if (vector_length(w->moves[k].by) < shortest)
			return 0;
	return w->n && w->moves[w->n - 1].last < m->times && is_clear(m, i) &&
	       (w->partner < 0 || is_clear(m, w->partner));
}

/* What has no way after all tries stays. */
static void draw_one(struct synth_moves *m, int i, enum plot plot, struct rng *r)
{
	for (int tries = 0; tries < TRIES; tries++) {
		try_plot(m, i, tries < TRIES / 2 ? plot : tries % 2 ? CARRY : PUSH, r);
		if (is_fit(m, i))
			return;
		if (m->ways[i].partner >= 0)
			m->ways[m->ways[i].partner] = (struct synth_way){.partner = -1};
		m->ways[i] = (struct synth_way){.partner = -1};
	}
}

int synth_moves_draw(
	struct synth_moves *m, struct synth_scene *scene, int times, uint64_t seed, struct err *e)
{
	const struct synth_object *o = scene->objects;
	uint32_t order[SYNTH_MAX_OBJECTS], plots[PLOTS], n = 0, at = 0;
	SCOPED char *all = mem_alloc(scene->splats.n, 1, "splats", e);
	struct rng r;

	*m = (struct synth_moves){.times = times, .scene = scene};
	if (!all)
		return -1;
	memset(all, 1, scene->splats.n);
	if (splats_keep(&m->first, &scene->splats, all, e))
		return -1;
	rng_seed(&r, seed, SYNTH_STREAM_MOVES);
	for (int i = 0; i < scene->object_count; i++) {
		int is_free = o[i].on < 0;
		for (int j = 0; j < scene->object_count; j++)
			is_free &= o[j].on != i;
		m->ways[i].partner = -1;
		if (is_free)
			order[n++] = (uint32_t)i;
	}
	for (uint32_t k = 0; k < PLOTS; k++)
		plots[k] = k;
	rng_shuffle(&r, order, n);
	rng_shuffle(&r, plots, PLOTS);
	for (uint32_t k = 0; k < n - n * 2 / 7 && times > 4 * LEAST; k++) {
		const int i = (int)order[k], is_ball = o[i].shape == SYNTH_BALL;
		if (m->ways[i].n)
			continue;
		while (plots[at % PLOTS] == ROLL)
			at++;
		draw_one(m, i, is_ball && rng_below(&r, 3) ? ROLL : (enum plot)plots[at++ % PLOTS], &r);
	}
	return 0;
}

void synth_moves_free(struct synth_moves *m)
{
	splats_free(&m->first);
	*m = (struct synth_moves){0};
}

/* Turns about the middle of a ball, as it has rolled. */
static void roll(const struct synth_object *o, const struct synth_way *w, double rolled, double m[3][3])
{
	const double *by = w->moves[0].by, length = hypot(by[0], by[1]), half = rolled / o->radius / 2;

	rotation_of_quat(
		(double[4]){cos(half), -sin(half) * by[1] / length, sin(half) * by[0] / length, 0}, m);
}

void synth_moves_set(const struct synth_moves *m, int time)
{
	const struct splats *first = &m->first;
	struct splats *to = &m->scene->splats;

	for (int i = 0; i < m->scene->object_count; i++) {
		const struct synth_object *o = &m->scene->objects[i];
		const double centre[3] = {o->x, o->y, o->z + o->radius};
		double by[3], rolled, turn[3][3], own[3][3], both[3][3], q[4];
		synth_moves_at(m, i, time, by, &rolled);
		if (rolled > 0)
			roll(o, &m->ways[i], rolled, turn);
		for (size_t k = m->scene->first[i]; k < m->scene->first[i + 1]; k++) {
			const float *x = first->means + 3 * k, *from = first->quats + 4 * k;
			memcpy(to->quats + 4 * k, from, 4 * sizeof *from);
			double d[3] = {x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
			for (int r = 0; r < 3; r++)
				to->means[3 * k + (size_t)r] =
					(float)((rolled > 0 ? centre[r] + vector_dot(turn[r], d)
							    : (double)x[r]) +
						by[r]);
			if (!(rolled > 0))
				continue;
			rotation_of_quat((double[4]){from[0], from[1], from[2], from[3]}, own);
			for (int r = 0; r < 3; r++)
				for (int c = 0; c < 3; c++)
					both[r][c] = turn[r][0] * own[0][c] + turn[r][1] * own[1][c] +
						     turn[r][2] * own[2][c];
			rotation_to_quat(both, q);
			for (int c = 0; c < 4; c++)
				to->quats[4 * k + (size_t)c] = (float)q[c];
		}
	}
}
