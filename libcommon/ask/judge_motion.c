#include "ask/judge_motion.h"

#include "ask/constants.h"
#include "base/mem.h"

#include <math.h>

int motion_meaning_make(struct motion_meaning *m, const struct tracks *t, struct err *e)
{
	m->moving.tracks = t;
	m->when = mem_alloc(t->n, sizeof *m->when, "motion", e);
	m->own = mem_alloc(t->n, 2 * sizeof *m->own, "motion", e);
	m->happens = mem_alloc(t->n, sizeof *m->happens, "motion", e);
	m->fits = mem_alloc(t->n, 2 * sizeof *m->fits, "motion", e);
	return m->when && m->own && m->happens && m->fits ? 0 : -1;
}

void motion_meaning_free(struct motion_meaning *m)
{
	mem_free_all(m->when, m->own, m->happens, m->fits);
}

void motion_meaning_begin(struct motion_meaning *m)
{
	m->said.n = 0;
	m->gone = MOTION_NONE;
	for (size_t o = 0; o < m->moving.tracks->n; o++)
		m->when[o] = (struct motions_span){0, m->moving.tracks->times - 1};
}

/* The phrase's fit takes in how far a motion is so: fits (O). */
static void take(struct meaning *m, int phrase, enum motion_kind kind, const double *fits)
{
	double *value = meaning_add_part(m, phrase, MEANING_MOTION, (int)kind), *there = there_of(m, phrase);

	for (size_t o = 0; o < objects_of(m); o++) {
		value[o] = MOTION_UNLIKE + (1 - MOTION_UNLIKE) * fits[o];
		there[o] *= fits[o];
	}
	meaning_take_part(m);
}

/* Two motions: while both are, or, one after the other, from the first to the last. */
static struct motions_span both(struct motions_span x, struct motions_span y)
{
	const struct motions_span in = {x.a > y.a ? x.a : y.a, x.b < y.b ? x.b : y.b};

	return in.a < in.b ? in : (struct motions_span){x.a < y.a ? x.a : y.a, x.b > y.b ? x.b : y.b};
}

static void judge_event(
	struct meaning *m, struct motion_meaning *to, const struct motion_event *v, int phrase)
{
	const size_t n = objects_of(m);
	const double *of = v->about >= 0 ? fit_of(m, v->about) : NULL;
	const double known = of ? largest(there_of(m, v->about), n) : 1;
	const long about = of ? (long)best_of(of, n) : -1;

	for (size_t o = 0; o < n; o++) {
		struct motions_span in =
			phrase ? (struct motions_span){0, to->moving.tracks->times - 1} : to->when[o];
		to->fits[o] = motions_judge(&to->moving, v->kind, o, about, &in);
		to->own[o] = in;
		if (v->negated)
			to->fits[o] = 1 - to->fits[o];
		else
			to->fits[o] *= known;
	}
	take(m, phrase, v->kind, to->fits);
}

void judge_motion(struct meaning *m, int phrase)
{
	struct motion_meaning *to = m->motion;
	const size_t n = objects_of(m);
	int first = 1;

	if (!to)
		return;
	if (!phrase && to->gone != MOTION_NONE)
		take(m, phrase, to->gone, to->happens);
	struct motions_span *when = to->own + n;
	for (size_t o = 0; o < n; o++)
		when[o] = phrase ? (struct motions_span){0, to->moving.tracks->times - 1} : to->when[o];
	for (int k = 0; k < to->said.n; k++) {
		const struct motion_event *v = &to->said.events[k];
		if (v->phrase != phrase)
			continue;
		if (v->kind < MOTION_FASTEST) {
			judge_event(m, to, v, phrase);
			for (size_t o = 0; o < n && !v->negated && v->kind != MOTION_STILL; o++)
				when[o] = first ? to->own[o] : both(when[o], to->own[o]);
			first &= v->negated || v->kind == MOTION_STILL;
			continue;
		}
		double *as = to->fits + n;
		for (size_t o = 0; o < n; o++) {
			as[o] = fit_of(m, phrase)[o] / fmax(largest(fit_of(m, phrase), n), 1e-12);
			if (first) /* "the fastest": of what moves */
				motions_judge(&to->moving, MOTION_MOVES, o, -1, &when[o]);
		}
		first = 0;
		motions_rank(&to->moving, v->kind, as, when, to->fits);
		take(m, phrase, v->kind, to->fits);
	}
	for (size_t o = 0; o < n && !phrase; o++)
		to->when[o] = when[o];
}
