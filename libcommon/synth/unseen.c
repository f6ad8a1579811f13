#include "synth/unseen.h"

#include "base/mem.h"
#include "synth/cameras.h"
#include "synth/occlusion.h"
#include "synth/unseen_build.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TRIES = 4000, FRAME_TRIES = 4, MAX_STANDS = 64 };

/* Of what a camera shows of an object at least so much must be in sight, in cells of synth/occlusion.h and as
 * a share. */
enum { LEAST_CELLS = 12 };
static const double least_seen = 0.4;

/* Where sentences are said: the reference viewpoint, and the test cameras. */
struct stands {
	struct synth_stand reference, views[MAX_STANDS];
	int n, camera[MAX_STANDS]; /* of views */
};

struct maker {
	struct synth_unseen_list *list;
	struct rng rng;
	const struct stands *stands;
	int wanted;
};

static const char *const kind_names[SYNTH_UNSEEN_KINDS] = {"plain", "chatty", "two-hop", "negation",
	"ordinal", "comparative", "several", "function", "view", "absent"};

const char *synth_unseen_kind_name(enum synth_unseen_kind k)
{
	return kind_names[k];
}

void synth_unseen_free(struct synth_unseen_list *list)
{
	free(list->items);
	*list = (struct synth_unseen_list){0};
}

static void camera_axes(const struct camera *c, double centre[3], double right[2], double away[2])
{
	const double(*m)[4] = c->world_to_camera;

	for (int k = 0; k < 3; k++)
		centre[k] = -(m[0][k] * m[0][3] + m[1][k] * m[1][3] + m[2][k] * m[2][3]);
	double length = hypot(m[2][0], m[2][1]);
	away[0] = m[2][0] / length;
	away[1] = m[2][1] / length;
	right[0] = away[1];
	right[1] = -away[0];
}

static void mean_centre(const struct cameras *cameras, double centre[3])
{
	double right[2], away[2], one[3];
	int n = 0;

	centre[0] = centre[1] = centre[2] = 0;
	for (size_t i = 0; i < cameras->n; i++) {
		if (cameras->views[i].split != SPLIT_TRAIN)
			continue;
		camera_axes(&cameras->views[i], one, right, away);
		for (int k = 0; k < 3; k++)
			centre[k] += one[k];
		n++;
	}
	for (int k = 0; k < 3 && n; k++)
		centre[k] /= n;
}

static int make_stands(struct stands *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, struct err *e)
{
	double centre[3], right[2], away[2];
	int visible[SYNTH_MAX_OBJECTS], whole[SYNTH_MAX_OBJECTS];
	struct synth_occlusion occlusion;

	s->n = 0;
	mean_centre(cameras, centre);
	synth_cameras_reference(cameras, right, away);
	synth_stand_camera(&s->reference, objects, n, table, centre, right, away);
	if (synth_occlusion_make(&occlusion, objects, n, e))
		return -1;
	for (size_t i = 0; i < cameras->n && s->n < MAX_STANDS; i++) {
		if (cameras->views[i].split != SPLIT_TEST)
			continue;
		struct synth_stand *v = &s->views[s->n];
		camera_axes(&cameras->views[i], centre, right, away);
		synth_stand_camera(v, objects, n, table, centre, right, away);
		synth_occlusion_look(&occlusion, &cameras->views[i], visible, whole);
		v->visible = 0;
		for (int k = 0; k < n; k++)
			v->visible |=
				(uint64_t)(visible[k] >= LEAST_CELLS && visible[k] >= least_seen * whole[k])
				<< k;
		s->camera[s->n++] = (int)i;
	}
	synth_occlusion_free(&occlusion);
	return 0;
}

/* 1 where the same was said, or, for what is made `afresh`, a sentence of the kind that means the same with
 * the same relation. */
static int is_said(const struct synth_unseen_list *list, const struct synth_unseen *x, int afresh)
{
	for (int i = 0; i < list->n; i++) {
		const struct synth_unseen *y = &list->items[i];
		if (!strcmp(y->text, x->text) && y->view == x->view)
			return 1;
		if (afresh && x->objects && y->kind == x->kind && y->objects == x->objects &&
			!x->clause_count == !y->clause_count &&
			(!x->clause_count || (x->clauses[0].relation == y->clauses[0].relation &&
						     x->clauses[0].degree == y->clauses[0].degree)))
			return 1;
	}
	return 0;
}

/* Numbers the sentence within its kind and adds it; -1 with *e. */
static int add(struct maker *m, const struct synth_unseen *x, struct err *e)
{
	struct synth_unseen_list *l = m->list;
	size_t capacity = (size_t)l->capacity;
	int number = 1;

	if (mem_grow((void **)&l->items, &capacity, (size_t)l->n + 1, sizeof *l->items, "sentences", e))
		return -1;
	l->capacity = (int)capacity;
	for (int i = 0; i < l->n; i++)
		number += l->items[i].kind == x->kind;
	l->items[l->n] = *x;
	snprintf(l->items[l->n].ref, sizeof l->items->ref, "unseen-%s-%d", kind_names[x->kind], number);
	l->n++;
	return 0;
}

/* 1 where the target's words alone say as much as with its first clause. */
static int is_idle(const struct synth_stand *s, const struct synth_unseen *x)
{
	struct synth_unseen bare = *x;
	uint64_t set;

	bare.phrases[0].clause_count = 0;
	return x->phrases[0].clause_count && !synth_unseen_resolve(s, &bare, 0, 0, &set);
}

/* The builds of a kind, of which a random one is tried. */
static enum synth_unseen_build choose_build(enum synth_unseen_kind k, struct rng *r)
{
	static const enum synth_unseen_build builds[SYNTH_UNSEEN_KINDS][4] = {
		[SYNTH_UNSEEN_PLAIN] = {SYNTH_BUILD_PLAIN, SYNTH_BUILD_PLAIN, SYNTH_BUILD_PLAIN,
			SYNTH_BUILD_PLAIN},
		[SYNTH_UNSEEN_CHATTY] = {SYNTH_BUILD_CHATTY, SYNTH_BUILD_CHATTY, SYNTH_BUILD_CHATTY,
			SYNTH_BUILD_CHATTY},
		[SYNTH_UNSEEN_TWO_HOP] = {SYNTH_BUILD_PLAIN, SYNTH_BUILD_PLAIN, SYNTH_BUILD_CHATTY,
			SYNTH_BUILD_CHATTY},
		[SYNTH_UNSEEN_NEGATION] = {SYNTH_BUILD_NOT, SYNTH_BUILD_OTHER, SYNTH_BUILD_NOTHING,
			SYNTH_BUILD_NEITHER},
		[SYNTH_UNSEEN_ORDINAL] = {SYNTH_BUILD_ORDINAL, SYNTH_BUILD_ORDINAL, SYNTH_BUILD_EXTREME,
			SYNTH_BUILD_GROUP},
		[SYNTH_UNSEEN_COMPARATIVE] = {SYNTH_BUILD_MOST, SYNTH_BUILD_PAIR, SYNTH_BUILD_THAN,
			SYNTH_BUILD_MOST},
		[SYNTH_UNSEEN_SEVERAL] = {SYNTH_BUILD_ALL, SYNTH_BUILD_COUNT, SYNTH_BUILD_ALSO,
			SYNTH_BUILD_EXCEPT},
		[SYNTH_UNSEEN_FUNCTION] = {SYNTH_BUILD_FUNCTION, SYNTH_BUILD_FUNCTION, SYNTH_BUILD_FUNCTION,
			SYNTH_BUILD_FUNCTION},
		[SYNTH_UNSEEN_VIEW] = {SYNTH_BUILD_PLAIN, SYNTH_BUILD_EXTREME, SYNTH_BUILD_GROUP,
			SYNTH_BUILD_ORDINAL},
	};

	return builds[k][rng_below(r, 4)];
}

static int write_sentence(struct synth_unseen_draft *d)
{
	for (int i = 0; i < FRAME_TRIES; i++)
		if (!synth_unseen_write(&d->x, &d->fill, d->rng))
			return 0;
	return -1;
}

/* A sentence of the kind about an object of the scene, seen from `stand`; -1 where chance made none. */
static int draft(struct maker *m, enum synth_unseen_kind kind, const struct synth_stand *stand, int object,
	struct synth_unseen_draft *d)
{
	*d = (struct synth_unseen_draft){.stand = stand, .rng = &m->rng};
	int is_absent = kind == SYNTH_UNSEEN_ABSENT;
	enum synth_unseen_build b = is_absent ? SYNTH_BUILD_PLAIN : choose_build(kind, &m->rng);
	int bad = is_absent ? synth_unseen_build_absent(d, object)
			    : synth_unseen_build(d, b, object, kind == SYNTH_UNSEEN_TWO_HOP);

	d->x.kind = kind;
	d->x.view = -1;
	if (bad || synth_unseen_resolve(stand, &d->x, 0, is_absent, &d->x.objects) ||
		is_absent != !d->x.objects || (d->x.objects & ~stand->visible))
		return -1;
	if (!is_absent && is_idle(stand, &d->x) && (kind != SYNTH_UNSEEN_PLAIN || rng_below(&m->rng, 8)))
		return -1;
	return write_sentence(d);
}

static int make_kind(struct maker *m, enum synth_unseen_kind kind, struct err *e)
{
	struct synth_unseen_draft d;
	int n = m->stands->reference.n;

	for (int i = 0, made = 0; made < m->wanted && i < TRIES; i++) {
		/* Every object in turn, so that none is left out. */
		if (draft(m, kind, &m->stands->reference, (made + i / 200) % n, &d))
			continue;
		if (kind <= SYNTH_UNSEEN_CHATTY && !(d.x.objects >> (made + i / 200) % n & 1))
			continue;
		synth_unseen_type(d.x.text, &m->rng);
		if (is_said(m->list, &d.x, i < TRIES / 2))
			continue;
		if (add(m, &d.x, e))
			return -1;
		made++;
	}
	return 0;
}

/* The first view in which the same words plainly mean something else that is to be seen; -1. */
static int other_view(const struct maker *m, const struct synth_unseen *x, uint64_t *objects)
{
	for (int i = 0; i < m->stands->n; i++)
		if (m->stands->camera[i] != x->view &&
			!synth_unseen_resolve(&m->stands->views[i], x, 0, 0, objects) &&
			*objects != x->objects && !(*objects & ~m->stands->views[i].visible))
			return m->stands->camera[i];
	return -1;
}

/* What goes around a sentence said of a picture; nothing around whole sentences. */
static void frame_view(struct synth_unseen_draft *d, const char *inner)
{
	int n = synth_unseen_frame_count(SYNTH_BUILD_VIEW);
	int is_phrase = !strncmp(inner, "the ", 4) && !strchr(inner, '?');

	d->fill = (struct synth_unseen_fill){.inner = inner, .frame = "%Z"};
	if (is_phrase)
		d->fill.frame = synth_unseen_frame(SYNTH_BUILD_VIEW, (int)rng_below(d->rng, (uint32_t)n));
}

/* Sentences in pairs: the same words of two test pictures, with other answers. */
static int make_views(struct maker *m, struct err *e)
{
	const struct stands *s = m->stands;
	struct synth_unseen_draft d;

	for (int i = 0, made = 0; made < m->wanted && i < TRIES && s->n; i++) {
		int at = (int)rng_below(&m->rng, (uint32_t)s->n);
		uint64_t other;
		if (draft(m, SYNTH_UNSEEN_VIEW, &s->views[at], i % s->views[at].n, &d))
			continue;
		d.x.view = s->camera[at];
		int view = other_view(m, &d.x, &other);
		if (view < 0)
			continue;
		struct synth_unseen inner = d.x;
		frame_view(&d, inner.text);
		if (synth_unseen_write(&d.x, &d.fill, &m->rng))
			continue;
		synth_unseen_type(d.x.text, &m->rng);
		if (is_said(m->list, &d.x, 0))
			continue;
		if (add(m, &d.x, e))
			return -1;
		d.x.view = view;
		d.x.objects = other;
		if (add(m, &d.x, e))
			return -1;
		made += 2;
	}
	return 0;
}

int synth_unseen_make(struct synth_unseen_list *list, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, uint64_t seed, struct err *e)
{
	struct stands *stands = mem_zalloc(1, sizeof *stands, "viewpoints", e);
	struct maker m = {.list = list, .stands = stands};
	int bad = !stands || make_stands(stands, objects, n, table, cameras, e) ? -1 : 0;

	*list = (struct synth_unseen_list){0};
	for (int k = 0; k < SYNTH_UNSEEN_KINDS && !bad; k++) {
		/* A stream for each kind: more of one leave the others as they were. */
		rng_seed(&m.rng, seed, (uint64_t)SYNTH_STREAM_UNSEEN + (uint64_t)k);
		m.wanted = k <= SYNTH_UNSEEN_CHATTY ? n : n / 2 + 2;
		bad = k == SYNTH_UNSEEN_VIEW ? make_views(&m, e)
					     : make_kind(&m, (enum synth_unseen_kind)k, e);
	}
	free(stands);
	if (bad)
		synth_unseen_free(list);
	return bad ? -1 : 0;
}
